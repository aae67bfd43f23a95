"""A run from beginning to end: checks, folder, the loop of events and instructions, and the verdict."""

from __future__ import annotations

import contextlib
import os
import platform
import time
from collections.abc import Callable, Iterator
from datetime import UTC, datetime
from functools import partial

from evaluators.plugins import guarded
from genome.errors import InputError
from genome.settings import describe
from islands.kinds.registry import resolve_kind
from islands.kinds.trade import check_biology
from islands.migration.channel import Channel
from islands.store import StoreError
from orchestrator.backends.protocol import Backend, RunFailedError
from orchestrator.checkpoints import newest
from orchestrator.cutting import roll_back
from orchestrator.drive import Drive, Outcome
from orchestrator.folder import MANIFEST, RunFolder, Runs, choose_name, create, remove
from orchestrator.keeping import EXPERIMENT, as_yaml
from orchestrator.lease import Lease
from orchestrator.loading import Loaded
from orchestrator.past import refuse_changed
from orchestrator.plan import Plan, make_plan
from orchestrator.progress import Progress
from orchestrator.signals import Signals
from orchestrator.steering.journal import FILE as COMMANDS
from orchestrator.steering.journal import read_commands


def seconds_of(plan: Plan) -> dict[str, float]:
    """Build the biology of each group of islands once, as hosts will; give what one evaluation may take in seconds.

    Raises
    ------
    InputError
        For whatever is wrong with their settings and the files that these name, and for a kind that cannot make use of
        what channels bring.
    """
    groups = {spec.group: spec for spec in plan.islands}
    channels = _channels_into(plan)
    seconds = {}
    for name, spec in groups.items():
        with guarded(spec.where("kind"), "an island kind that can be built", describe(spec.kind)):
            biology = resolve_kind(spec.kind, spec.where("kind")).build(spec, time.perf_counter)
            check_biology(biology, spec, channels.get(name, ()))
            seconds[name] = float(biology.seconds)
    return seconds


def _channels_into(plan: Plan) -> dict[str, list[Channel]]:
    """Give for each group of islands the channels of other kinds than migrants that reach one of it, by number."""
    found: dict[str, set[Channel]] = {}
    ends = [(edge.target, edge.channel) for edge in plan.edges]
    ends += [(number, redrawn.channel) for redrawn in plan.redrawn for number, _ in redrawn.members]
    for number, channel in ends:
        if channel.kind != "migrants":
            found.setdefault(plan.islands[number].group, set()).add(channel)
    return {group: sorted(channels, key=lambda channel: channel.number) for group, channels in found.items()}


def prepare(loaded: Loaded) -> tuple[Plan, dict[str, float]]:
    """Make the plan and check all that can be checked before a host stands; give the plan and ``seconds_of`` it.

    Raises
    ------
    InputError
        For the first thing that is wrong, with its line in the file.
    """
    try:
        plan = make_plan(loaded)
        return plan, seconds_of(plan)
    except InputError as error:
        raise loaded.locate(error) from None


def make_backend(loaded: Loaded, address: str | None) -> Backend:
    """Give the backend that an experiment asks for.

    Raises
    ------
    InputError
        When the machine has too few CPUs for its hosts, the address has no form that a driver can take, or one is given
        to the in-process backend.
    """
    from orchestrator.backends.cluster import check_address, hosts_for, machine_cpus
    from orchestrator.backends.inline import InlineBackend
    from orchestrator.backends.ray import RayBackend

    experiment = loaded.experiment
    islands = sum(settings.count for settings in experiment.islands.values())
    if experiment.backend == "inline":
        if address is not None:
            raise InputError("--address", "no address with backend: inline", f"'{address}'", "set backend: ray")
        return InlineBackend()
    if address is not None:
        check_address(address)
    else:
        try:
            hosts_for(experiment.hosts, islands, machine_cpus())
        except InputError as error:
            where = f"{loaded.source}: hosts"
            raise loaded.locate(InputError(where, error.expected, error.got, error.remedy)) from None
    return RayBackend(experiment.hosts, islands, address)


def run_experiment(
    loaded: Loaded,
    backend: Backend,
    runs_dir: Runs,
    name: str | None,
    progress: Progress,
    replay: RunFolder | None = None,
) -> Outcome:
    """Run an experiment.

    Parameters
    ----------
    loaded
        The resolved experiment, checked.
    backend
        Where the hosts are to be.
    runs_dir
        Where run folders stand.
    name
        The run's name, if one was asked for.
    progress
        Is told how it goes.
    replay
        The run that this one is to repeat, if any.

    Raises
    ------
    InputError, RunFailedError
        When it cannot start; there is no folder then.
    KeyboardInterrupt
        On a second Ctrl-C, and on a first one before the run has a folder.
    """
    started, clock = datetime.now(UTC), time.perf_counter()
    plan, seconds = prepare(loaded)
    explicit, name = name is not None, name or loaded.experiment.name
    choose_name(runs_dir, name, explicit=explicit)
    with driving(backend, progress) as (hosts, signals):
        facts = {"backend": loaded.experiment.backend, "hosts": hosts, "islands": len(plan.islands)}
        folder = create(runs_dir, name, loaded, started, facts, explicit=explicit)
        if replay is not None and replay.store.exists(COMMANDS):
            folder.store.write(COMMANDS, replay.store.read(COMMANDS))
        make = partial(Drive, folder, backend, hosts, seconds, progress, clock, replay=replay)
        return driven(folder, signals, make, fresh=True)


def resume_experiment(folder: RunFolder, loaded: Loaded, backend: Backend, progress: Progress) -> Outcome:
    """Go on with a run from its last checkpoint, or from its start when it has none.

    Parameters
    ----------
    folder
        The run.
    loaded
        Its experiment, with what is to be different from now on.
    backend
        Where the hosts are to be.
    progress
        Is told how it goes.

    Raises
    ------
    InputError
        When another process drives the run, or its checkpoint is not of this experiment.
    RunFailedError
        When it cannot start; the run is as it was.
    """
    clock = time.perf_counter()
    _, seconds = prepare(loaded)
    with driving(backend, progress) as (hosts, signals):
        make = partial(_going_on, folder, loaded, backend, hosts, seconds, progress, clock)
        return driven(folder, signals, make, fresh=False)


def _going_on(
    folder: RunFolder,
    loaded: Loaded,
    backend: Backend,
    hosts: int,
    seconds: dict[str, float],
    progress: Progress,
    clock: float,
    lease: Lease,
) -> Drive:
    """Cut a run back to its last checkpoint, and give the drive that goes on from there."""
    experiment = loaded.experiment
    found, doubts = newest(folder.store, folder.name, experiment.seed)
    epoch = -1 if found is None else found.epoch
    # Before anything is cut: a history that cannot be read, or is another, leaves the run as it was.
    commands = read_commands(folder.store)
    if found is not None:
        refuse_changed(found, folder, loaded, commands)
    if epoch > experiment.length:
        got = f"{experiment.length}, and a checkpoint of epoch {epoch}"
        raise InputError("--set epochs", "at least as many epochs as the run has", got, "ask for more")
    for doubt in doubts:
        progress.note(f"passed over: {doubt}")
    progress.note(f"going on after epoch {epoch}" if found is not None else "no checkpoint: beginning anew")
    roll_back(folder.store, found, keep_run_events=True)
    folder.store.write(EXPERIMENT, as_yaml({**loaded.data(), "name": folder.name}).encode())
    folder.refresh()
    facts = {"backend": experiment.backend, "hosts": hosts, "machine": platform.node(), "process": os.getpid()}
    folder.update(status="running", ended=None, error="", **facts)
    return Drive(folder, backend, hosts, seconds, progress, clock, lease, None, found)


@contextlib.contextmanager
def driving(backend: Backend, progress: Progress) -> Iterator[tuple[int, Signals]]:
    """Open a backend, and close it in the end; give how many hosts there will be, and who hears of signals."""
    with Signals(backend.interrupt) as signals:
        try:
            yield _opened(backend, signals), signals
        finally:
            signals.close()
            progress.close()
            backend.close()


def driven(folder: RunFolder, signals: Signals, make: Callable[[Lease], Drive], *, fresh: bool) -> Outcome:
    """Drive a run to its end, and say in its manifest how it ended, whatever happens."""
    drive: Drive | None = None
    lease = Lease(folder.store)
    try:
        drive = make(lease)
        return drive.to_the_end(signals.stop)
    except BaseException as error:
        signals.close()
        if fresh and isinstance(error, RunFailedError) and drive is not None and not drive.is_begun:
            remove(folder)
        elif drive is not None or fresh:
            with contextlib.suppress(StoreError):  # what the run died of may be its store
                _conclude_badly(folder, drive, error)
        if isinstance(error, StoreError):
            raise RunFailedError(f"{error}; go on then with: atoll resume {folder.store}") from None
        raise
    finally:
        with contextlib.suppress(StoreError):
            lease.release()


def _opened(backend: Backend, signals: Signals) -> int:
    """Open the backend; a run that was asked to stop meanwhile does not begin."""
    try:
        hosts = backend.open()
    except RunFailedError:
        # A Ctrl-C in a terminal reaches helpers of the backend too, whose failure is then no news.
        if signals.stop.is_set():
            raise KeyboardInterrupt from None
        raise
    signals.listen()
    if signals.stop.is_set():
        raise KeyboardInterrupt
    return hosts


def _conclude_badly(folder: RunFolder, drive: Drive | None, error: BaseException) -> None:
    """Close the manifest of a run that was broken off hard, with what the driver knows."""
    if not folder.store.exists(MANIFEST) or folder.manifest().get("status") not in ("running", "paused"):
        return
    if isinstance(error, KeyboardInterrupt):
        status, reason = "stopped", "broken off by a second Ctrl-C: what the hosts had not written yet is lost"
    else:
        status, reason = "failed", f"{type(error).__name__}: {error}"
    facts = drive.facts() if drive is not None else {}
    folder.update(status=status, ended=datetime.now(UTC).isoformat(timespec="seconds"), error=reason, **facts)
