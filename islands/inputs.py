"""The files that a run's experiment names, kept beside it: where the run is in a bucket, brought to this machine."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from islands.store import Store

if TYPE_CHECKING:
    from islands.orders import HostPlan

MADE: Final = ("checkpoints", "forms", "log")
"""The folders of a run that it makes itself; the others hold what the experiment names."""


def bring_inputs(store: Store, into: Path) -> None:
    """Copy a run's experiment and the files that it names into a folder of this machine."""
    wanted = ["", *(folder for folder in store.folders() if folder not in MADE)]
    for folder in wanted:
        (into / folder).mkdir(parents=True, exist_ok=True)
        for name in store.names(folder, hidden=True):
            (into / folder / name).write_bytes(store.at(folder).read(name))


@contextmanager
def inputs_here(plan: HostPlan) -> Iterator[HostPlan]:
    """Give a host's plan with its islands' files at hand, for as long as the islands are being made."""
    store = Store.open(plan.folder)
    if store.local is not None:
        yield plan
        return
    here = tempfile.mkdtemp(prefix="atoll-")
    try:
        bring_inputs(store, Path(here))
        islands = tuple(replace(spec, base=here) for spec in plan.islands)
        foreign = tuple(replace(spec, base=here) for spec in plan.foreign)
        yield replace(plan, islands=islands, foreign=foreign)
    finally:
        shutil.rmtree(here, ignore_errors=True)
