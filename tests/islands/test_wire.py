"""Letters: packets as bytes, and sockets that carry them."""

from __future__ import annotations

import math
import threading
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from islands.mail import Bell, Letterbox
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


def connected() -> tuple[Letterbox, Letterbox]:
    one, other = Letterbox(), Letterbox()
    one.connect({1: other.address}, 10.0)
    other.connect({0: one.address}, 10.0)
    return one, other


def received(box: Letterbox, count: int, meanwhile: Letterbox | None = None) -> list[bytes]:
    """Wait for so many letters, while another one looks in as its host would."""
    got: list[bytes] = []
    while len(got) < count:
        if not box.wait(0.01 if meanwhile else 10.0) and meanwhile is None:
            break
        got += box.letters()
        if meanwhile is not None:
            meanwhile.letters()
    return got


def test_letters_of_any_length_arrive_whole_and_in_order_and_leave_no_path() -> None:
    one, other = connected()
    assert (Path(one.address).parent.stat().st_mode & 0o777) == 0o700
    letters = [b"", *(bytes([65 + size]) * 10**size for size in range(8)), b"last"]
    for letter in letters:
        one.send(1, letter)
    assert one.owing  # ten million bytes have no room in any socket
    assert received(other, len(letters), meanwhile=one) == letters
    assert not one.owing
    other.send(0, b"answer")
    assert received(one, 1) == [b"answer"]
    assert not Path(one.address).parent.exists()
    assert not Path(other.address).parent.exists()
    one.close()
    other.close()


def test_two_that_write_to_each_other_at_once_wait_for_nobody() -> None:
    one, other = connected()
    long = b"x" * 5_000_000
    one.send(1, long)
    other.send(0, long)
    got: dict[Letterbox, list[bytes]] = {one: [], other: []}
    for _ in range(1000):
        for box, come in got.items():
            come += box.letters()
    assert list(got.values()) == [[long], [long]]
    one.close()
    other.close()


def test_a_bell_that_is_rung_wakes_whoever_waits() -> None:
    one, other = connected()
    assert one.letters() == []
    other.letters()
    assert not one.wait(0.01)
    threading.Timer(0.05, one.ring).start()
    assert one.wait(10.0)
    assert not one.wait(0.0)
    bell = Bell()
    bell.ring()
    assert (bell.wait(10.0), bell.wait(0.0), bell.letters(), bell.owing) == (True, False, [], False)
    one.close()
    one.ring()
    other.close()


def test_a_letter_to_one_that_is_gone_is_lost_in_silence(tmp_path) -> None:
    one, other = connected()
    other.close()
    one.letters()
    # None of them raises, and none waits for anybody.
    assert [one.send(1, b"x" * 1_000_000) for _ in range(3)] == [None] * 3
    assert not one.owing
    one.close()
    box = Letterbox(str(tmp_path / "box"))
    with pytest.raises(FileNotFoundError):
        box.connect({1: str(tmp_path / "nobody")}, 10.0)
    box.close()
