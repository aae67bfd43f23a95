"""Being asked to stop: Ctrl-C, SIGTERM, and the hang-up of a terminal that was closed."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable
from types import FrameType, TracebackType
from typing import Any, Final, Self, final

HEARD: Final = tuple(
    signal.Signals[name] for name in ("SIGINT", "SIGTERM", "SIGHUP") if name in signal.Signals.__members__
)


@final
class Signals:
    """Lets the first signal ask for a clean stop, and the second break off with ``KeyboardInterrupt``.

    A context manager, which gives the former handlers back; outside the main thread it hears nothing.

    Parameters
    ----------
    interrupt
        Is called at the first signal, in the signal's handler.

    Attributes
    ----------
    stop
        Set once a stop was asked for.
    """

    def __init__(self, interrupt: Callable[[], None]) -> None:
        self.stop = threading.Event()
        self._interrupt = interrupt
        self._closing = False
        self._before: dict[signal.Signals, Any] = {}

    def __enter__(self) -> Self:
        self.listen()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def listen(self) -> None:
        """Set the handlers; to be called again after what sets some of its own, as Ray does for SIGTERM."""
        if threading.current_thread() is not threading.main_thread():
            return
        for number in HEARD:
            # Under nohup a hang-up is not to be heard.
            if number.name == "SIGHUP" and signal.getsignal(number) is signal.SIG_IGN:
                continue
            before = signal.signal(number, self._asked)
            self._before.setdefault(number, before)

    def close(self) -> None:
        """Hear no more: closing takes a second or two, and broken off it would leave Ray's processes."""
        self._closing = True

    def _asked(self, number: int, frame: FrameType | None) -> None:
        del number, frame
        if self._closing:
            return
        if self.stop.is_set():
            raise KeyboardInterrupt
        self.stop.set()
        self._interrupt()
