"""Letters: packets as bytes, and sockets that carry them."""

from __future__ import annotations

import math
import socket
import threading
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from islands.mail import Letterbox, Line
from islands.migration.channel import Migrant, Packet
from islands.wire import opened, sealed

FLOATS = st.floats(allow_nan=False)
MIGRANTS = st.builds(
    Migrant,
    st.integers(0, 2**62),
    st.text(),
    st.none() | FLOATS,
    st.lists(st.tuples(st.text(), FLOATS), max_size=3).map(tuple),
    st.text(),
)
NUMBER = st.integers(0, 2**31)
PACKETS = st.builds(
    Packet, NUMBER, NUMBER, NUMBER, NUMBER, st.text(), st.lists(MIGRANTS, max_size=3).map(tuple)
)  # fmt: skip


@given(st.lists(PACKETS, max_size=5))
def test_what_is_opened_is_what_was_sealed(packets) -> None:
    assert sorted(opened(sealed(packets)), key=repr) == sorted(packets, key=repr)


def test_a_broadcast_is_written_once_and_bits_are_kept() -> None:
    migrants = (Migrant(2**50 + 1, "\udcff" + "x" * 1000, -0.0, (("a", 5e-324), ("b", math.inf)), ""),)
    packets = [Packet(0, 1, target, 3, "key", migrants) for target in range(9)]
    letter = sealed(packets)
    assert len(letter) < 1500
    found = opened(letter)
    assert list(found) == packets
    assert math.copysign(1, found[0].migrants[0].fitness) == -1
    assert all(type(packet) is Packet and type(packet.migrants[0]) is Migrant for packet in found)


def test_letters_of_any_length_arrive_whole_and_in_order_and_leave_no_path() -> None:
    got: list[bytes] = []
    here = threading.Event()

    def take(letter: bytes) -> None:
        got.append(letter)
        if len(got) == 8:
            here.set()

    box = Letterbox(take)
    assert (Path(box.address).parent.stat().st_mode & 0o777) == 0o700
    lines = [Line(box.address, 10.0) for _ in range(2)]
    box.expect(2)
    letters = [bytes([65 + size]) * 10**size for size in range(7)]
    for letter in letters:
        lines[0].send(letter)
    lines[1].send(b"")
    assert here.wait(10)
    assert [letter for letter in got if letter] == letters
    assert not Path(box.address).parent.exists()
    for line in lines:
        line.close()
    box._thread.join(10)
    assert not box._thread.is_alive()


def test_a_letter_to_one_that_is_gone_is_lost_in_silence(tmp_path) -> None:
    listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    listener.bind(str(tmp_path / "mail"))
    listener.listen()
    line = Line(str(tmp_path / "mail"), 10.0)
    listener.close()
    # None of them raises, and none waits for anybody.
    assert [line.send(b"x" * 100_000) for _ in range(3)] == [None] * 3
    line.close()
    with pytest.raises(ConnectionRefusedError):
        Line(str(tmp_path / "mail"), 10.0)
