"""The store: where a run's folder stands, on a local disk or in any file system of :mod:`pyarrow.fs`.

A cluster's machines share no disk, so every file of a run is read and written through this door. What comes from
outside is a place, a path or a URI; what goes to another machine is :attr:`Store.place`, which holds no secret.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from pathlib import Path
from typing import TYPE_CHECKING, Any

from genome.errors import InputError

if TYPE_CHECKING:
    from typing import Self


class StoreError(InputError):
    """A store that cannot be reached, read or written: what a name means there is another matter."""


class Store(ABC):
    """A folder somewhere, and what is below it.

    Names are relative to the folder and may hold slashes. The folder itself need not exist: writing makes it.
    ``str()`` of a store is its place as it was asked for.

    Attributes
    ----------
    place
        What opens it again, also on another machine: a URI, or an absolute local path.
    local
        The folder, where it is on a local disk.
    """

    place: str
    local: Path | None

    @staticmethod
    def open(place: Anywhere) -> Store:
        """Open a folder by its local path or URI; nothing is read or made yet. A store that is open stays as it is.

        Raises
        ------
        InputError
            When the URI is none that can be opened, or has a password in it.
        StoreError
            When what it takes to open it cannot be reached.
        """
        if isinstance(place, Store):
            return place
        from islands.stores.places import is_uri, local_path

        text = str(place)
        if is_uri(text):
            path = local_path(text)
            if path is None:
                from islands.stores.remote import open_remote

                return open_remote(text)
        else:
            path = Path(place)
        from islands.stores.disk import DiskStore

        return DiskStore(path)

    @property
    @abstractmethod
    def name(self) -> str:
        """The folder's own name."""

    @abstractmethod
    def at(self, *parts: str) -> Self:
        """Give a folder below."""

    @abstractmethod
    def check(self) -> None:
        """Ask whether the store can be reached.

        Raises
        ------
        StoreError
            When it cannot, or the bucket is not there.
        """

    @abstractmethod
    def read(self, name: str) -> bytes:
        """Read a file.

        Raises
        ------
        FileNotFoundError
            When there is none.
        StoreError
            When the store gives no answer.
        """

    @abstractmethod
    def write(self, name: str, content: bytes, staging: str = "") -> None:
        """Write a file whole or not at all, in the place of one that may be there; make the folders that it needs.

        Parameters
        ----------
        name, content
            The file.
        staging
            On a local disk, the folder of this store in which the draft stands until it is whole; without, it stands
            beside its place under a hidden name.

        Raises
        ------
        StoreError
            When it cannot be written. What was there before is there still.
        """

    @abstractmethod
    def exists(self, name: str) -> bool:
        """Tell whether there is a file of this name."""

    @abstractmethod
    def size(self, name: str) -> int:
        """Give a file's length in bytes; :class:`FileNotFoundError` when there is none."""

    @abstractmethod
    def names(self, folder: str = "", *, hidden: bool = False) -> list[str]:
        """Give the names of the files right below a folder, sorted; none when there is no folder.

        Those that begin with a dot are left out, unless ``hidden``.
        """

    @abstractmethod
    def folders(self, folder: str = "") -> list[str]:
        """Give the names of the folders right below a folder, without hidden ones, as :meth:`names`."""

    @abstractmethod
    def sizes(self, folder: str = "") -> dict[str, int]:
        """Give the files right below a folder as :meth:`names`, each with its length in bytes, at one request."""

    @abstractmethod
    def remove(self, name: str) -> None:
        """Remove a file, if it is there."""

    @abstractmethod
    def remove_tree(self, folder: str = "") -> None:
        """Remove a folder and all that is below it, if it is there."""

    @abstractmethod
    def arrow(self) -> tuple[Any, str]:
        """Give Arrow's file system, and the folder's path in it."""


Anywhere = Store | Path | str
"""A store, or a place that opens one."""
