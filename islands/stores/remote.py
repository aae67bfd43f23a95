"""A store in any file system of Arrow's that is no local disk."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Final, final

from genome.errors import InputError
from genome.mishaps import one_line
from islands.store import Store
from islands.stores.places import Place, joined, parse_place
from islands.stores.s3 import open_s3
from islands.stores.troubles import told

PATIENCE_S: Final = "10"
"""Seconds for which requests to Google are tried again."""


def open_remote(uri: str) -> RemoteStore:
    """Open what a URI names.

    Raises
    ------
    InputError
        When Arrow knows no such place.
    StoreError
        When it cannot be reached.
    """
    place = parse_place(uri)
    shown = place.whole()
    if place.scheme == "s3":
        files, root, full = open_s3(place)
        return RemoteStore(files, root, full, shown)
    from pyarrow import ArrowException
    from pyarrow.fs import FileSystem

    asked = place.whole()
    if place.scheme in ("gs", "gcs") and "retry_limit_seconds" not in place.options:
        asked += f"{'&' if place.options else '?'}retry_limit_seconds={PATIENCE_S}"
    try:
        files, root = FileSystem.from_uri(asked)
    except (ArrowException, OSError, ImportError, ValueError) as error:
        expected = "a place that Arrow can open: a path, or s3://, gs://, abfs://, hdfs://"
        raise InputError(place.bare(), expected, one_line(str(error))[:300]) from None
    return RemoteStore(files, root.rstrip("/"), place, shown)


@final
class RemoteStore(Store):
    """A folder of a file system of Arrow's.

    Parameters
    ----------
    files, root
        The file system, and the folder's path in it.
    place
        What opens it again.
    shown
        The URI as it was asked for.
    """

    local = None

    def __init__(self, files: Any, root: str, place: Place, shown: str) -> None:  # noqa: ANN401 - Arrow has no types
        self._files = files
        self._root = root
        self._place = place
        self._shown = shown
        self.place = place.whole()

    def __str__(self) -> str:
        return self._shown

    @property
    def name(self) -> str:
        """The folder's own name."""
        return self._root.rpartition("/")[2]

    def at(self, *parts: str) -> RemoteStore:
        """Give a folder below."""
        shown = parse_place(self._shown).below(*parts).whole()
        return RemoteStore(self._files, joined_below(self._root, *parts), self._place.below(*parts), shown)

    def check(self) -> None:
        """Ask whether the store can be reached and the bucket is there."""
        from pyarrow.fs import FileType

        bucket = self._root.strip("/").partition("/")[0]
        with self._asking("", "a store that can be reached"):
            found = self._files.get_file_info(bucket)
        if self._place.scheme in ("s3", "gs", "gcs") and found.type == FileType.NotFound:
            raise told(str(self), "", OSError("AWS Error NO_SUCH_BUCKET during HeadBucket operation"))

    def read(self, name: str) -> bytes:
        """Read a file."""
        with self._asking(name, "a file that can be read"), self._files.open_input_file(self._path(name)) as stream:
            return bytes(stream.read())

    def write(self, name: str, content: bytes, staging: str = "") -> None:
        """Write a file by one request, or by several that count from the last on."""
        del staging
        path = self._path(name)
        with self._asking(name, "a file that can be written"):
            if self._place.scheme not in ("s3", "gs", "gcs"):  # where folders are things
                self._files.create_dir(path.rpartition("/")[0])
            with self._files.open_output_stream(path) as stream:
                stream.write(content)

    def exists(self, name: str) -> bool:
        """Tell whether there is a file of this name."""
        return bool(self._info(name).is_file)

    def size(self, name: str) -> int:
        """Give a file's length in bytes."""
        info = self._info(name)
        if not info.is_file:
            raise self._nothing(name)
        return int(info.size)

    def names(self, folder: str = "", *, hidden: bool = False) -> list[str]:
        """Give the names of the files right below a folder."""
        return sorted(info.base_name for info in self._entries(folder, hidden=hidden) if info.is_file)

    def folders(self, folder: str = "") -> list[str]:
        """Give the names of the folders right below a folder."""
        return sorted(info.base_name for info in self._entries(folder) if not info.is_file)

    def sizes(self, folder: str = "") -> dict[str, int]:
        """Give the files right below a folder, with their lengths."""
        return dict(sorted((info.base_name, int(info.size)) for info in self._entries(folder) if info.is_file))

    def remove(self, name: str) -> None:
        """Remove a file, if it is there."""
        try:
            with self._asking(name, "a file that can be removed"):
                self._files.delete_file(self._path(name))
        except FileNotFoundError:
            pass

    def remove_tree(self, folder: str = "") -> None:
        """Remove a folder and all that is below it, if it is there."""
        try:
            with self._asking(folder, "a folder that can be removed"):
                self._files.delete_dir(self._path(folder))
        except FileNotFoundError:
            pass

    def arrow(self) -> tuple[Any, str]:
        """Give Arrow's file system, and the folder's path in it."""
        return self._files, self._root

    def _path(self, name: str) -> str:
        return joined_below(self._root, name)

    def _info(self, name: str) -> Any:  # noqa: ANN401 - Arrow has no types
        with self._asking(name, "a store that can be reached"):
            return self._files.get_file_info(self._path(name))

    def _entries(self, folder: str, *, hidden: bool = False) -> list[Any]:
        from pyarrow.fs import FileSelector

        with self._asking(folder, "a folder that can be read"):
            found = self._files.get_file_info(FileSelector(self._path(folder), allow_not_found=True))
        return [info for info in found if hidden or not info.base_name.startswith(".")]

    def _nothing(self, name: str) -> FileNotFoundError:
        return FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), str(self.at(name)))

    @contextmanager
    def _asking(self, name: str, expected: str) -> Iterator[None]:
        """Turn Arrow's errors into those of a store."""
        from pyarrow import ArrowException

        try:
            yield
        except FileNotFoundError:
            raise self._nothing(name) from None
        except (OSError, ArrowException) as error:
            raise told(str(self.at(name)), expected, error) from None


def joined_below(root: str, *parts: str) -> str:
    """Join names below a path that may begin with a slash."""
    below = joined(*parts)
    return f"{root}/{below}" if below else root
