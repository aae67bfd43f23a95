"""A stand-in for the store of a run's folder, on a local disk alone, until the real one is merged."""

from __future__ import annotations

import contextlib
import os
import secrets
import shutil
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class Store:
    """A folder."""

    place: str

    @classmethod
    def open(cls, place: str | Path) -> Store:
        """Give the store at a place."""
        return cls(str(Path(place).absolute()))

    @property
    def local(self) -> Path | None:
        """The folder."""
        return Path(self.place)

    def at(self, *parts: str) -> Store:
        """Give a folder below."""
        return Store(str(Path(self.place).joinpath(*parts)))

    def read(self, name: str) -> bytes:
        """Give a file's content."""
        return Path(self.place, name).read_bytes()

    def write(self, name: str, content: bytes) -> None:
        """Write a file whole or not at all."""
        path = Path(self.place, name)
        path.parent.mkdir(parents=True, exist_ok=True)
        draft = path.with_name(f".{path.name}.{secrets.token_hex(4)}.tmp")
        with draft.open("wb") as file:
            file.write(content)
            os.fsync(file.fileno())
        draft.replace(path)

    def exists(self, name: str) -> bool:
        """Tell whether there is a file."""
        return Path(self.place, name).is_file()

    def size(self, name: str) -> int:
        """Give a file's size."""
        return Path(self.place, name).stat().st_size

    def names(self, folder: str = "") -> list[str]:
        """Give the files right below a folder."""
        path = Path(self.place, folder)
        if not path.is_dir():
            return []
        return sorted(one.name for one in path.iterdir() if one.is_file() and not one.name.startswith("."))

    def folders(self, folder: str = "") -> list[str]:
        """Give the folders right below a folder."""
        path = Path(self.place, folder)
        if not path.is_dir():
            return []
        return sorted(one.name for one in path.iterdir() if one.is_dir() and not one.name.startswith("."))

    def remove(self, name: str) -> None:
        """Remove a file."""
        with contextlib.suppress(FileNotFoundError):
            Path(self.place, name).unlink()

    def remove_tree(self, folder: str = "") -> None:
        """Remove a folder."""
        shutil.rmtree(Path(self.place, folder), ignore_errors=True)
