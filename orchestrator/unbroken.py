"""Output that nobody may be reading any more."""

from __future__ import annotations

import contextlib
import errno
import io
import os
from typing import Final, TextIO, final

GONE: Final = (errno.EPIPE, errno.EIO)
"""What writing fails with where a pipe's reader is gone, and where a terminal is."""


@final
class Unbroken(io.TextIOBase):
    """A text stream that goes on silently once its reader is gone: a pipe that was closed, a terminal that hung up.

    Parameters
    ----------
    stream
        Where the text goes.
    """

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    @property
    def encoding(self) -> str:  # type: ignore[override] # a plain attribute there
        """The stream's encoding."""
        return self._stream.encoding

    @property
    def errors(self) -> str | None:  # type: ignore[override] # a plain attribute there
        """What the stream does with characters that it cannot encode."""
        return self._stream.errors

    def fileno(self) -> int:
        """Give the stream's descriptor."""
        return self._stream.fileno()

    def isatty(self) -> bool:
        """Tell whether the stream is a terminal."""
        return self._stream.isatty()

    def writable(self) -> bool:
        """Tell that it can be written to."""
        return True

    def write(self, text: str) -> int:
        """Write, if anyone reads."""
        try:
            return self._stream.write(text)
        except OSError as error:
            self._give_up(error)
            return len(text)

    def flush(self) -> None:
        """Flush, if anyone reads."""
        try:
            self._stream.flush()
        except OSError as error:
            self._give_up(error)

    def close(self) -> None:
        """Leave the stream open: it is another's."""

    def _give_up(self, error: OSError) -> None:
        """Lead the descriptor nowhere, so that what waits in buffers can be flushed at the program's end."""
        if error.errno not in GONE:
            raise error
        with contextlib.suppress(OSError):
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, self._stream.fileno())
            os.close(nowhere)
