"""Letters between hosts on one machine: Unix sockets, which are ten times as quick as a call from actor to actor.

A letterbox listens under a path in a folder that only this user can enter, until all its peers have connected; then the
path goes. It has no thread of its own: one that reads would wait for the interpreter's lock for as long as the host
computes, and then take it away from the host. The host looks in between two steps, which costs microseconds. Letters
that a peer's socket has no room for stay here and go out as the host looks in again.
"""

from __future__ import annotations

import contextlib
import selectors
import shutil
import socket
import struct
import tempfile
import threading
from collections.abc import Mapping
from pathlib import Path
from typing import Final, Protocol, final

HEAD: Final = struct.Struct("!Q")
"""Before each letter stands its length."""

CHUNK: Final = 1 << 18
BUFFER: Final = 1 << 22
"""Bytes of a socket's buffer that are asked for; the system gives what it allows."""

CAN_LISTEN: Final = hasattr(socket, "AF_UNIX")


class Porch(Protocol):
    """Where a host waits for letters.

    Attributes
    ----------
    owing
        Whether letters have still to go out.
    """

    @property
    def owing(self) -> bool:
        """See above."""
        ...

    def letters(self) -> list[bytes]:
        """Give the letters that have come, and send what has still to go out, without waiting."""
        ...

    def wait(self, seconds: float) -> bool:
        """Wait until something has come or gone out, or the bell was rung; ``False`` when nothing did."""
        ...

    def ring(self) -> None:
        """Wake whoever waits; from any thread."""
        ...


@final
class Bell:
    """A porch to which no letters come: only the bell is rung."""

    owing: Final = False

    def __init__(self) -> None:
        self._rung = threading.Event()

    def letters(self) -> list[bytes]:
        """Give none."""
        return []

    def wait(self, seconds: float) -> bool:
        """Wait for the bell."""
        heard = self._rung.wait(seconds)
        self._rung.clear()
        return heard

    def ring(self) -> None:
        """Ring it."""
        self._rung.set()


@final
class _Line:
    """A connection to a peer: what has still to go out."""

    __slots__ = ("door", "owed")

    def __init__(self, door: socket.socket) -> None:
        self.door = door
        self.owed = bytearray()


@final
class Letterbox:
    """Where a host's letters come in and go out; all but :meth:`ring` is for the host's own thread.

    Parameters
    ----------
    folder
        Where it is to stand, a folder that is not there yet, in one that only this user can enter; empty for any.
    """

    def __init__(self, folder: str = "") -> None:
        self._folder = Path(folder or tempfile.mkdtemp(prefix="atoll-"))
        self._folder.mkdir(mode=0o700, exist_ok=True)
        self._listener = _stream()
        self.address: Final = str(self._folder / "mail")
        self._listener.bind(self.address)
        self._listener.listen(1024)
        self._doors = selectors.DefaultSelector()
        self._doors.register(self._listener, selectors.EVENT_READ)
        self._bell, self._rope = socket.socketpair()
        for end in (self._bell, self._rope):
            end.settimeout(0.0)
        self._doors.register(self._bell, selectors.EVENT_READ)
        self._expected = 0
        self._drafts: dict[socket.socket, bytearray] = {}
        self._lines: dict[int, _Line] = {}
        self._come: list[bytes] = []

    def connect(self, peers: Mapping[int, str], seconds: float) -> None:
        """Open lines to peers' letterboxes, and expect one from each of them; with none the letterbox is taken down.

        Raises
        ------
        OSError
            When a peer does not listen.
        """
        self._expected = len(peers)
        if not peers:
            self._take_down()
        for host, address in peers.items():
            door = _stream()
            door.settimeout(seconds)
            try:
                door.connect(address)
            except OSError:
                door.close()
                raise
            door.settimeout(0.0)
            self._lines[host] = _Line(door)

    def reaches(self, host: int) -> bool:
        """Tell whether there is a line to this peer."""
        return host in self._lines

    def send(self, host: int, letter: bytes) -> None:
        """Send a letter, now or as soon as there is room for it.

        One to a peer that is gone is lost, which the driver will hear of from elsewhere.
        """
        line = self._lines[host]
        whole = HEAD.pack(len(letter)) + letter
        if line.owed:
            line.owed += whole
            return
        gone = self._put(line, memoryview(whole))
        if gone < len(whole):
            line.owed += whole[gone:]
            self._doors.register(line.door, selectors.EVENT_WRITE, line)

    @property
    def owing(self) -> bool:
        """Whether letters have still to go out."""
        return any(line.owed for line in self._lines.values())

    def letters(self) -> list[bytes]:
        """Give the letters that have come, and send what has still to go out, without waiting."""
        while self._turn(0):
            pass
        come, self._come = self._come, []
        return come

    def wait(self, seconds: float) -> bool:
        """Wait until something has come or gone out, or the bell was rung; ``False`` when nothing did."""
        return self._turn(seconds)

    def ring(self) -> None:
        """Wake whoever waits; from any thread."""
        with contextlib.suppress(OSError):  # one that is full has been rung, one that is closed needs no ringing
            self._rope.send(b"!")

    def close(self) -> None:
        """Hang up."""
        if self._listener.fileno() >= 0:
            self._take_down()
        for door in (*self._drafts, *(line.door for line in self._lines.values()), self._bell, self._rope):
            door.close()
        self._drafts, self._lines = {}, {}
        self._doors.close()

    def _turn(self, seconds: float) -> bool:
        """Do once what the sockets are ready for; tell whether there was anything."""
        ready = self._doors.select(seconds)
        for key, _ in ready:
            door = key.fileobj
            assert isinstance(door, socket.socket)
            if key.data is not None:
                self._put_more(key.data)
            elif door is self._listener:
                self._let_in()
            elif door is self._bell:
                with contextlib.suppress(BlockingIOError):
                    door.recv(CHUNK)
            else:
                self._read_from(door)
        return bool(ready)

    def _take_down(self) -> None:
        self._doors.unregister(self._listener)
        self._listener.close()
        shutil.rmtree(self._folder, ignore_errors=True)

    def _let_in(self) -> None:
        door, _ = self._listener.accept()
        door.settimeout(0.0)
        self._drafts[door] = bytearray()
        self._doors.register(door, selectors.EVENT_READ)
        self._expected -= 1
        if self._expected == 0:
            self._take_down()

    def _read_from(self, door: socket.socket) -> None:
        try:
            chunk = door.recv(CHUNK)
        except BlockingIOError:
            return
        except OSError:
            chunk = b""
        if not chunk:  # the peer is gone, which is the driver's business
            self._doors.unregister(door)
            door.close()
            del self._drafts[door]
            return
        draft = self._drafts[door]
        draft += chunk
        while len(draft) >= HEAD.size:
            (length,) = HEAD.unpack_from(draft)
            if len(draft) < HEAD.size + length:
                return
            self._come.append(bytes(draft[HEAD.size : HEAD.size + length]))
            del draft[: HEAD.size + length]

    def _put(self, line: _Line, view: memoryview) -> int:
        """Give how many bytes went out; all of them to a peer that is gone."""
        try:
            return line.door.send(view)
        except BlockingIOError:
            return 0
        except OSError:
            return len(view)

    def _put_more(self, line: _Line) -> None:
        with memoryview(line.owed) as view:
            gone = self._put(line, view)
        del line.owed[:gone]
        if not line.owed:
            self._doors.unregister(line.door)


def _stream() -> socket.socket:
    made = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    made.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, BUFFER)
    return made
