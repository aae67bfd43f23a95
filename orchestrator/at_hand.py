"""What a run's experiment names, at hand on this machine: read by path, wherever the run stands."""

from __future__ import annotations

import atexit
import shutil
import tempfile
from pathlib import Path
from typing import final

from islands.inputs import bring_inputs
from islands.store import Store


def folder_for_now() -> Path:
    """Make a folder that goes when this process ends."""
    path = Path(tempfile.mkdtemp(prefix="atoll-"))
    atexit.register(shutil.rmtree, path, ignore_errors=True)
    return path


@final
class Inputs:
    """Brings a run's experiment and the files that it names, when they are first asked for.

    Parameters
    ----------
    store
        The run's folder.
    here
        The folder that has them already; ``None`` for none.
    """

    def __init__(self, store: Store, here: Path | None) -> None:
        self._store = store
        self._here = here

    def forget(self) -> None:
        """Bring them again when they are next asked for, where they stand elsewhere."""
        if self._store.local is None:
            self._here = None

    def here(self) -> Path:
        """Give the folder that has them.

        Raises
        ------
        StoreError
            When they cannot be brought.
        """
        if self._here is None:
            path = folder_for_now()
            bring_inputs(self._store, path)
            self._here = path
        return self._here
