"""Removing what a run does not go on from: log files beyond a checkpoint, later checkpoints, and old ones.

A checkpoint is unmade in the opposite order of its making, the file that makes it whole first, so that at no moment one
seems whole that is not. Each function can be broken off and called again.
"""

from __future__ import annotations

import re
from typing import Final

from genome.errors import InputError
from islands.checkpoint import FOLDER, stem
from islands.store import Store, StoreError
from orchestrator.checkpoints import Checkpoint, epochs_of, read, run_events

SUFFIX: Final = ".parquet"
RUN: Final = "events/run-"
DRAFT: Final = re.compile(r"\..+\.tmp")
"""What whoever was killed while writing a file leaves beside its place."""


def roll_back(store: Store, checkpoint: Checkpoint | None, *, keep_run_events: bool = False) -> tuple[str, ...]:
    """Bring a run's folder back to a checkpoint, or to the start for ``None``.

    Checkpoints after it go first, drafts of others too: the log files that they list will be no more. Nobody may write
    to the folder meanwhile. See :func:`cut_log`.
    """
    last = -1 if checkpoint is None else checkpoint.epoch
    for epoch in _all_epochs(store):
        if epoch > last:
            _unmake(store, epoch)
    for name in (*store.names("", hidden=True), *(f"{FOLDER}/{name}" for name in store.names(FOLDER, hidden=True))):
        if DRAFT.fullmatch(name.rpartition("/")[2]):
            store.remove(name)
    return cut_log(store, checkpoint, keep_run_events=keep_run_events)


def cut_log(store: Store, checkpoint: Checkpoint | None, *, keep_run_events: bool = False) -> tuple[str, ...]:
    """Remove the log files that do not belong to a checkpoint, and drafts.

    Parameters
    ----------
    store
        The run's folder.
    checkpoint
        To which the log is cut; all files go for ``None``.
    keep_run_events
        Keep events of the whole run that were told after it: that somebody stopped the run, or that a host died, did
        happen. Whoever writes more of them has to go on counting after them.

    Returns
    -------
    The names of the files removed, in the ``log`` folder, in order.
    """
    log = store.at("log")
    kept: set[str] = set()
    if checkpoint is not None:
        kept.update(name for name, *_ in checkpoint.log)
        kept.update(run_events(number) for number in range(checkpoint.events))
    removed = []
    for table in log.folders():
        for name in (f"{table}/{file}" for file in log.names(table)):
            spared = name in kept or (keep_run_events and name.startswith(RUN))
            if name.endswith(SUFFIX) and not spared:
                log.remove(name)
                removed.append(name)
    log.remove_tree(".tmp")
    return tuple(removed)


def prune(store: Store, keep: int) -> tuple[int, ...]:
    """Remove all but the newest whole checkpoints, and what is left of those that were never made whole.

    A checkpoint counts as whole when its file can be read and its parts have their sizes. Nothing newer than the newest
    whole one is touched: hosts may be writing it.

    Parameters
    ----------
    store
        The run's folder.
    keep
        How many stay, at least 1.

    Returns
    -------
    The epochs of which something was removed, ascending.
    """
    if keep < 1:
        raise ValueError(f"at least one checkpoint has to be kept, got {keep}")
    whole: list[int] = []
    for epoch in epochs_of(store):
        if len(whole) < keep and _seems_whole(store, epoch):
            whole.append(epoch)
    if not whole:
        return ()
    removed = [epoch for epoch in _all_epochs(store) if epoch < whole[0] and epoch not in whole]
    for epoch in removed:
        _unmake(store, epoch)
    return tuple(removed)


def _all_epochs(store: Store) -> list[int]:
    """Give the epochs of which there is any trace of a checkpoint, ascending."""
    folders = [name[1:] for name in store.folders(FOLDER) if name[:1] == "e" and name[1:].isdecimal()]
    return sorted({*epochs_of(store), *map(int, folders)})


def _unmake(store: Store, epoch: int) -> None:
    store.remove(f"{stem(epoch)}.json")
    store.remove_tree(stem(epoch))


def _seems_whole(store: Store, epoch: int) -> bool:
    try:
        return all(store.size(part.file) == part.bytes for part in read(store, epoch).parts)
    except StoreError:
        raise
    except (InputError, FileNotFoundError):
        return False
