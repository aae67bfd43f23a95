"""Going on with a run: what may be different from now on, and what it needs for that."""

from __future__ import annotations

from collections.abc import Sequence

from genome.errors import InputError
from orchestrator.backends.protocol import Backend
from orchestrator.drive import Outcome
from orchestrator.folder import RunFolder
from orchestrator.lease import is_driven
from orchestrator.loading import Loaded, load_experiment
from orchestrator.overrides import parse_override
from orchestrator.past import FREE
from orchestrator.progress import Progress
from orchestrator.run import resume_experiment


def resumable(folder: RunFolder, overrides: Sequence[str]) -> Loaded:
    """Give the experiment that a run goes on with.

    Raises
    ------
    InputError
        When a setting may not change, nothing is left to do, or another process drives the run.
    """
    for override in overrides:
        key = parse_override(override)[0][0]
        if key not in FREE:
            got = f"'{key}', which the run has been bred with"
            raise InputError(f"--set {override}", f"a setting of {', '.join(FREE)}", got, "start a new run with it")
    name = folder.manifest().get("run")
    if name != folder.name:
        got = f"'{folder.name}'"
        remedy = "its log and checkpoints have that name: give the folder its name back"
        raise InputError(str(folder.store), f"the folder of the run '{name}' under its own name", got, remedy)
    if is_driven(folder.store):
        got = "one that another process drives"
        raise InputError(str(folder.store), "a run that nobody drives", got, "wait for it, or steer it")
    # The run's own length gives way to the one that is asked for, whichever key names it.
    longer = any(parse_override(one)[0][0] in ("generations", "epochs") for one in overrides)
    loaded = load_experiment(folder.experiment, overrides, without=("epochs",) if longer else ())
    done = load_experiment(folder.experiment).experiment.length
    if folder.manifest().get("status") == "finished" and loaded.experiment.length == done:
        got = f"one that has finished its {done} epochs"
        raise InputError(str(folder.store), "a run with something left to do", got, "--set generations=N, more of them")
    return loaded


def resume(folder: RunFolder, loaded: Loaded, backend: Backend, progress: Progress) -> Outcome:
    """Go on with a run; see :func:`orchestrator.run.resume_experiment`."""
    return resume_experiment(folder, loaded, backend, progress)
