"""A wire to a server that can be cut and mended: a store that cannot be reached, and is back later."""

from __future__ import annotations

import contextlib
import socket
import threading


class Proxy:
    """Carries bytes between a port of this machine and the server's, until it is cut."""

    def __init__(self, endpoint: str) -> None:
        host, _, port = endpoint.removeprefix("http://").rpartition(":")
        self._server = (host, int(port))
        self._socket = socket.create_server(("127.0.0.1", 0))
        self.port = self._socket.getsockname()[1]
        self._pairs: list[socket.socket] = []
        self._begin()

    @property
    def endpoint(self) -> str:
        return f"http://127.0.0.1:{self.port}"

    def _begin(self) -> None:
        self._is_open = True
        threading.Thread(target=self._accept, args=(self._socket,), daemon=True).start()

    def _accept(self, listening: socket.socket) -> None:
        with contextlib.suppress(OSError):
            while self._is_open:
                ours, _ = listening.accept()
                theirs = socket.create_connection(self._server)
                self._pairs += [ours, theirs]
                for one, other in ((ours, theirs), (theirs, ours)):
                    threading.Thread(target=_carry, args=(one, other), daemon=True).start()

    def cut(self) -> None:
        """Nothing listens any more, and what was connected is not."""
        self._is_open = False
        for one in (self._socket, *self._pairs):
            with contextlib.suppress(OSError):
                one.shutdown(socket.SHUT_RDWR)
            one.close()
        self._pairs = []

    def mend(self) -> None:
        """Listen again, where it did."""
        self._socket = socket.create_server(("127.0.0.1", self.port))
        self._begin()


def _carry(source: socket.socket, target: socket.socket) -> None:
    with contextlib.suppress(OSError):
        while content := source.recv(1 << 16):
            target.sendall(content)
    with contextlib.suppress(OSError):
        target.shutdown(socket.SHUT_WR)
