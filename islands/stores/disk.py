"""A store on a local disk, or on one that looks like it."""

from __future__ import annotations

import contextlib
import errno
import os
import secrets
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final, final

from islands.store import Store, StoreError

NONE: Final = (errno.ENOENT, errno.ENOTDIR, errno.EISDIR)
"""What reading a file fails with where there is none."""


@final
class DiskStore(Store):
    """A folder on a disk.

    Parameters
    ----------
    path
        The folder.
    """

    def __init__(self, path: Path) -> None:
        self._path = path.absolute()
        self.local = self._path
        self.place = str(self._path)

    def __str__(self) -> str:
        return self.place

    @property
    def name(self) -> str:
        """The folder's own name."""
        return self._path.name

    def at(self, *parts: str) -> DiskStore:
        """Give a folder below."""
        return DiskStore(self._path.joinpath(*parts))

    def check(self) -> None:
        """Do nothing: what is wrong with a folder shows when it is used."""

    def read(self, name: str) -> bytes:
        """Read a file."""
        path = self._path / name
        try:
            return path.read_bytes()
        except OSError as error:
            raise _unread(path, error) from None

    def write(self, name: str, content: bytes, staging: str = "") -> None:
        """Write a draft, wait until the disk has it, and move it to its place."""
        target = self._path / name
        if staging:
            draft = self._path / staging / name.replace("/", "-")
        else:
            # Not by the process's id: on a shared disk two machines may have the same.
            draft = target.with_name(f".{target.name}.{secrets.token_hex(4)}.tmp")
        try:
            draft.parent.mkdir(parents=True, exist_ok=True)
            target.parent.mkdir(parents=True, exist_ok=True)
            with draft.open("wb") as stream:
                stream.write(content)
                stream.flush()
                os.fsync(stream.fileno())
            draft.replace(target)
        except BaseException as error:
            with contextlib.suppress(OSError):
                draft.unlink()
            if isinstance(error, OSError):
                raise _unwritten(target, error) from None
            raise

    def exists(self, name: str) -> bool:
        """Tell whether there is a file of this name."""
        return (self._path / name).is_file()

    def size(self, name: str) -> int:
        """Give a file's length in bytes."""
        path = self._path / name
        try:
            return path.stat().st_size
        except OSError as error:
            raise _unread(path, error) from None

    def names(self, folder: str = "", *, hidden: bool = False) -> list[str]:
        """Give the names of the files right below a folder."""
        return sorted(entry.name for entry in self._entries(folder, hidden=hidden) if entry.is_file())

    def folders(self, folder: str = "") -> list[str]:
        """Give the names of the folders right below a folder."""
        return sorted(entry.name for entry in self._entries(folder) if entry.is_dir())

    def _entries(self, folder: str, *, hidden: bool = False) -> Iterator[os.DirEntry[str]]:
        path = self._path / folder
        try:
            with os.scandir(path) as entries:
                yield from (entry for entry in entries if hidden or not entry.name.startswith("."))
        except OSError as error:
            if error.errno not in NONE:
                raise _unread(path, error) from None

    def sizes(self, folder: str = "") -> dict[str, int]:
        """Give the files right below a folder, with their lengths."""
        found = [(entry.name, entry.stat().st_size) for entry in self._entries(folder) if entry.is_file()]
        return dict(sorted(found))

    def remove(self, name: str) -> None:
        """Remove a file, if it is there."""
        path = self._path / name
        try:
            path.unlink()
        except OSError as error:
            if error.errno not in NONE:
                raise _unwritten(path, error) from None

    def remove_tree(self, folder: str = "") -> None:
        """Remove a folder and all that is below it, if it is there."""
        path = self._path / folder
        try:
            shutil.rmtree(path)
        except OSError as error:
            if error.errno not in NONE:
                raise _unwritten(path, error) from None

    def arrow(self) -> tuple[Any, str]:
        """Give Arrow's file system, and the folder's path in it."""
        from pyarrow.fs import LocalFileSystem

        return LocalFileSystem(), self.place


def _unread(path: Path, error: OSError) -> Exception:
    if error.errno in NONE:
        return FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), str(path))
    return StoreError(str(path), "a file or folder that can be read", _reason(error), "check the folder")


def _unwritten(path: Path, error: OSError) -> StoreError:
    full = error.errno in (errno.ENOSPC, errno.EDQUOT)
    remedy = "make room on the disk" if full else "check the folder"
    return StoreError(str(path), "a file that can be written", _reason(error), remedy)


def _reason(error: OSError) -> str:
    return (error.strerror or str(error)).lower()
