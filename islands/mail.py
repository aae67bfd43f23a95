"""Letters between hosts on one machine: Unix sockets, which are ten times as quick as a call from actor to actor.

A letterbox listens under a path in a folder that only this user can enter, until all its peers have connected; then the
path goes. One thread reads what comes, however busy the host is, so that nobody who sends waits for long.
"""

from __future__ import annotations

import selectors
import shutil
import socket
import struct
import tempfile
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Final, final

HEAD: Final = struct.Struct("!Q")
"""Before each letter stands its length."""

CHUNK: Final = 1 << 18

CAN_LISTEN: Final = hasattr(socket, "AF_UNIX")


@final
class Letterbox:
    """Where a host's letters come in.

    Parameters
    ----------
    take
        Is given each letter, on the letterbox's own thread.
    folder
        Where it is to stand, a folder that is not there yet, in one that only this user can enter; empty for any.
    """

    def __init__(self, take: Callable[[bytes], None], folder: str = "") -> None:
        self._take = take
        self._folder = Path(folder or tempfile.mkdtemp(prefix="atoll-"))
        self._folder.mkdir(mode=0o700, exist_ok=True)
        self._listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self.address: Final = str(self._folder / "mail")
        self._listener.bind(self.address)
        self._listener.listen(1024)
        self._doors = selectors.DefaultSelector()
        self._doors.register(self._listener, selectors.EVENT_READ)
        self._drafts: dict[socket.socket, bytearray] = {}
        self._thread: threading.Thread | None = None

    def expect(self, peers: int) -> None:
        """Begin to read, from so many peers; with none the letterbox is taken down."""
        if not peers:
            self._take_down()
            self._doors.close()
            return
        self._thread = threading.Thread(target=self._read, args=(peers,), daemon=True, name="letterbox")
        self._thread.start()

    def _take_down(self) -> None:
        self._doors.unregister(self._listener)
        self._listener.close()
        shutil.rmtree(self._folder, ignore_errors=True)

    def _read(self, peers: int) -> None:
        accepted = 0
        while accepted < peers or self._drafts:
            for key, _ in self._doors.select():
                if key.fileobj is self._listener:
                    door, _ = self._listener.accept()
                    self._drafts[door] = bytearray()
                    self._doors.register(door, selectors.EVENT_READ)
                    accepted += 1
                    if accepted == peers:
                        self._take_down()
                elif isinstance(key.fileobj, socket.socket):
                    self._read_from(key.fileobj)
        self._doors.close()

    def _read_from(self, door: socket.socket) -> None:
        try:
            chunk = door.recv(CHUNK)
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
            letter = bytes(draft[HEAD.size : HEAD.size + length])
            del draft[: HEAD.size + length]
            self._take(letter)


@final
class Line:
    """The way to a peer's letterbox.

    Parameters
    ----------
    address
        Where it listens.
    patience
        Seconds that a letter may take to go out.
    """

    def __init__(self, address: str, patience: float) -> None:
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self._socket.settimeout(patience)
        try:
            self._socket.connect(address)
        except OSError:
            self._socket.close()
            raise

    def send(self, letter: bytes) -> None:
        """Send a letter; one to a peer that is gone is lost, which the driver will hear of from elsewhere.

        Raises
        ------
        TimeoutError
            When the peer takes nothing.
        """
        try:
            self._socket.sendall(HEAD.pack(len(letter)) + letter)
        except TimeoutError:
            raise
        except OSError:
            return

    def close(self) -> None:
        """Hang up."""
        self._socket.close()
