"""Running a whole run again, as it went."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from genome.errors import InputError
from orchestrator.drive import Outcome
from orchestrator.folder import LONGEST_NAME, RunFolder, Runs
from orchestrator.loading import load_experiment
from orchestrator.progress import Progress
from orchestrator.query import ask
from orchestrator.run import make_backend, run_experiment

OVER = ("finished", "stopped")
MARK = "-replay"


def replay(
    folder: RunFolder, runs_dir: Runs, name: str | None, overrides: Sequence[str], progress: Progress
) -> Outcome:
    """Run a run again, up to the epoch at which its log ends.

    Parameters
    ----------
    folder
        The run; finished, or stopped.
    runs_dir, name
        Where the new run's folder stands, and its name if one was asked for.
    overrides
        Settings that may differ.
    progress
        Is told how it goes.

    Raises
    ------
    InputError
        When the run is not over, was broken off, or nothing of it is in the log.
    """
    status = folder.manifest().get("status")
    if status not in OVER:
        raise InputError(str(folder.store), "a run that finished or was stopped", f"one that is {status}")
    ((through,),) = ask(folder.log, "select max(epoch) from generations").rows
    if through is None:
        raise InputError(str(folder.store), "a run with an epoch in its log", "one that was stopped before")
    loaded = load_experiment(folder.experiment, (*overrides, f"epochs={int(through)}"))
    chosen = name or f"{folder.name[: LONGEST_NAME - len(MARK)]}{MARK}"
    renamed = loaded.experiment.model_copy(update={"name": chosen})
    loaded = replace(loaded, experiment=renamed)
    return run_experiment(loaded, make_backend(loaded, None), runs_dir, name, progress, folder)
