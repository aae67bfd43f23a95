"""Writing files whole or not at all."""

from __future__ import annotations

import contextlib
import errno
import os
from collections.abc import Mapping
from pathlib import Path

from genome.errors import InputError


def write_whole(path: Path, content: bytes) -> None:
    """Write a file beside its place and move it there, so that nobody ever sees half of it.

    Raises
    ------
    InputError
        When the file cannot be written.
    """
    write_together({path: content})


def write_together(files: Mapping[Path, bytes]) -> None:
    """Write several files beside their places, and move them there when all are written.

    Raises
    ------
    InputError
        When one cannot be written; then none is.
    """
    waiting: dict[Path, Path] = {}
    path = Path()
    try:
        for path, content in files.items():
            if path.is_dir():  # nothing can be moved there, and by then others would have been
                raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
            waiting[path] = _draft(path)
            waiting[path].write_bytes(content)
        for path, draft in waiting.items():
            if draft != path:
                draft.replace(path)
    except OSError as error:
        for place, draft in waiting.items():
            if draft != place:
                with contextlib.suppress(OSError):
                    draft.unlink()
        reason = error.strerror or str(error)
        raise InputError(str(path), "a file that can be written", reason.lower(), "check the folder") from None


def _draft(path: Path) -> Path:
    """Give the place where a file stands until it is whole; a device or a pipe is written to, not replaced."""
    if path.exists() and not path.is_file():
        return path
    return path.with_name(f".{path.name}.{os.getpid()}.tmp")
