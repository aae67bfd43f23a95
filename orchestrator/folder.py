"""The run's folder: made whole or not at all, and its manifest."""

from __future__ import annotations

import contextlib
import errno
import json
import os
import platform
import secrets
import shutil
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, Final

from genome.errors import InputError
from genome.settings import near
from islands.schemas import VERSION
from islands.store import Anywhere, Store, StoreError
from islands.stores.places import is_uri
from orchestrator.at_hand import Inputs, folder_for_now
from orchestrator.claims import claimed
from orchestrator.keeping import EXPERIMENT, as_yaml, with_files_kept
from orchestrator.loading import Loaded

MANIFEST: Final = "manifest.json"
LOG: Final = "log"
"""The folder of the tables' folders."""
DEFAULT_RUNS: Final = Path("runs")
LONGEST_NAME: Final = 100
"""Characters of a run's name, as of an experiment's: the run's folder holds the experiment under its own name."""
TAKEN: Final = (errno.EEXIST, errno.ENOTEMPTY, errno.ENOTDIR)
"""What a folder's move fails with where something stands already."""
PACKAGES: Final = ("atoll", "numpy", "numba", "deap", "pyarrow", "ray", "trimesh")


Runs = Path | Store
"""Where run folders stand: a folder of this machine as it was written, or another store."""


@dataclass(frozen=True, slots=True)
class RunFolder:
    """A run's folder that exists, in any store.

    Attributes
    ----------
    store
        The folder.
    inputs
        Brings what is read by path.
    """

    store: Store
    inputs: Inputs

    @property
    def path(self) -> Path:
        """The folder on the local disk where it stands."""
        return on_disk(self.store)

    @property
    def log(self) -> Store:
        """Where the tables' folders are."""
        return self.store.at(LOG)

    @property
    def name(self) -> str:
        """The run's name."""
        return self.store.name

    @property
    def experiment(self) -> Path:
        """The experiment as resolved, at hand on this machine with the files that it names beside it."""
        return self.inputs.here() / EXPERIMENT

    @property
    def source(self) -> str:
        """The experiment's own place, for messages."""
        return str(self.store.at(EXPERIMENT))

    def manifest(self) -> dict[str, Any]:
        """Read the manifest.

        Raises
        ------
        InputError
            When it is no JSON object.
        """
        place = str(self.store.at(MANIFEST))
        try:
            found = json.loads(self.store.read(MANIFEST).decode())
        except (OSError, ValueError) as error:
            if isinstance(error, StoreError):
                raise
            raise InputError(place, "a run's manifest", f"a file that cannot be read ({error})") from None
        if not isinstance(found, dict):
            raise InputError(place, "a run's manifest, a JSON object", type(found).__name__)
        return found

    def refresh(self) -> None:
        """Forget what was brought to this machine: the experiment has changed."""
        self.inputs.forget()

    def update(self, **changes: Any) -> None:  # noqa: ANN401 - plain JSON values
        """Change keys of the manifest, atomically."""
        self.store.write(MANIFEST, _as_json({**self.manifest(), **changes}))


def on_disk(store: Store) -> Path:
    """Give a store's folder on a local disk, for what is only asked where it is there."""
    if store.local is None:
        raise RuntimeError(f"{store} is not on a local disk")
    return store.local


def open_run(path: str) -> RunFolder:
    """Give the run in this folder, at this place, or of this name under ``runs``.

    Raises
    ------
    InputError
        When it is no run's folder.
    """
    found = _opened(path, MANIFEST)
    if found is not None:
        return found
    if not is_uri(path) and not Path(path).exists():
        known = [entry.parent.name for entry in sorted(DEFAULT_RUNS.glob(f"*/{MANIFEST}"))]
        remedy = near(Path(path).name, known) if known else "see 'atoll run --help'"
        raise InputError(path, "a run's folder", "nothing by that name", remedy)
    raise InputError(path, "a run's folder", f"one without {MANIFEST}", "give the place that 'atoll run' printed")


def open_remains(path: str) -> RunFolder:
    """Give a run to those who only read it, as :func:`open_run`: one that has lost its manifest is taken, too.

    Raises
    ------
    InputError
        When neither a manifest nor a log is there.
    """
    try:
        return open_run(path)
    except StoreError:
        raise
    except InputError:
        found = _opened(path, LOG)
        if found is None:
            raise
        return found


def _opened(path: str, holding: str) -> RunFolder | None:
    """Give the run at a place where a folder holds what is named."""
    if is_uri(path):
        store = Store.open(path)
        if store.exists(holding) or holding in store.folders():
            return _run_in(store)
        store.check()
        return None
    places = (Path(path), DEFAULT_RUNS / path)
    return next((_run_in(folder.resolve()) for folder in places if (folder / holding).exists()), None)


def _run_in(place: Anywhere, inputs: Path | None = None) -> RunFolder:
    store = Store.open(place)
    return RunFolder(store, Inputs(store, inputs or store.local))


def choose_name(runs: Runs, name: str, *, explicit: bool) -> str:
    """Give the name of a new run.

    A name that was asked for must be free; a name by default gets a number when it is taken.

    Raises
    ------
    InputError
        When a name that was asked for is taken, or is too long.
    """
    if isinstance(runs, Path):
        return choose_path(runs, name, explicit=explicit).name
    folders = runs.folders()
    return _free(name, folders.__contains__, lambda chosen: str(runs.at(chosen)), explicit=explicit)


def choose_path(runs_dir: Path, name: str, *, explicit: bool) -> Path:
    """Give the path of a new run.

    A name that was asked for must be free; a name by default gets a number when it is taken.

    Raises
    ------
    InputError
        When a name that was asked for is taken, or is too long.
    """
    # Links that lead nowhere count as taken, too: a folder cannot be moved to their place.
    taken = lambda chosen: os.path.lexists(runs_dir / chosen)  # noqa: E731
    return runs_dir / _free(name, taken, lambda chosen: str(runs_dir / chosen), explicit=explicit)


def _free(name: str, taken: Callable[[str], bool], place: Callable[[str], str], *, explicit: bool) -> str:
    if explicit and len(name) > LONGEST_NAME:
        raise InputError("--name", f"at most {LONGEST_NAME} characters", str(len(name)), "choose a shorter name")
    chosen, number = name, 1
    while taken(chosen):
        if explicit:
            got = f"{place(chosen)}, which exists"
            raise InputError(f"--name {name}", "a name that is free", got, "choose another name")
        number += 1
        mark = f"-{number}"
        chosen = f"{name[: LONGEST_NAME - len(mark)]}{mark}"
    return chosen


def create(
    runs_dir: Runs, name: str, loaded: Loaded, started: datetime, facts: Mapping[str, Any], *, explicit: bool
) -> RunFolder:
    """Make a run's folder, with the experiment and every file that it names.

    On a disk it is built beside its place and moved there when it is complete. The move claims the name: of runs that
    start together one has it, and the others get the next numbers. In another store, where nothing can be moved, the
    name is claimed first (:mod:`orchestrator.claims`), and the manifest is written last.

    Parameters
    ----------
    runs_dir
        Where run folders stand; made if need be.
    name, explicit
        The run's name, and whether it was asked for.
    loaded
        The experiment; its name becomes the folder's.
    started
        When the run started, in UTC.
    facts
        Further keys of the manifest.

    Raises
    ------
    InputError
        When the folder cannot be made, or the name is taken.
    """
    if isinstance(runs_dir, Store):
        return _created_far(runs_dir, name, loaded, started, facts, explicit=explicit)
    is_new = not runs_dir.exists()
    try:
        runs_dir.mkdir(parents=True, exist_ok=True)
        try:
            while True:
                path = choose_path(runs_dir, name, explicit=explicit)
                if _made(path, loaded, started, facts):
                    return _run_in(path.resolve())
        except BaseException:
            if is_new:
                with contextlib.suppress(OSError):  # another run may stand in it by now
                    runs_dir.rmdir()
            raise
    except OSError as error:
        got = f"{runs_dir} ({error.strerror or error})"
        raise InputError("--runs-dir", "a folder that a run can be written to", got) from None


def _made(path: Path, loaded: Loaded, started: datetime, facts: Mapping[str, Any]) -> bool:
    """Make the folder; ``False`` when another run has come to this place meanwhile."""
    # Not by the process's id: on a shared disk two machines may have the same.
    draft = path.parent / f".{path.name}.{secrets.token_hex(4)}.partial"
    draft.mkdir()
    try:
        _fill(draft, path.name, loaded, started, facts)
        draft.rename(path)
    except BaseException as error:
        shutil.rmtree(draft, ignore_errors=True)
        if isinstance(error, OSError) and error.errno in TAKEN and os.path.lexists(path):
            return False
        raise
    return True


def _created_far(
    runs: Store, name: str, loaded: Loaded, started: datetime, facts: Mapping[str, Any], *, explicit: bool
) -> RunFolder:
    """Make a run's folder in a store that is no disk; it is filled on this machine first."""
    runs.check()
    with claimed(runs, lambda: choose_name(runs, name, explicit=explicit), MANIFEST) as chosen:
        store, draft = runs.at(chosen), folder_for_now()
        _fill(draft, chosen, loaded, started, facts)
        files = sorted(path for path in draft.rglob("*") if path.is_file())
        try:
            for path in sorted(files, key=lambda path: path.name == MANIFEST):
                store.write(path.relative_to(draft).as_posix(), path.read_bytes())
        except BaseException:
            with contextlib.suppress(StoreError):
                store.remove_tree()
            raise
    return _run_in(store, draft)


def _fill(draft: Path, name: str, loaded: Loaded, started: datetime, facts: Mapping[str, Any]) -> None:
    """Write what a run's folder holds at first."""
    data = {**with_files_kept(loaded, draft), "name": name}
    (draft / EXPERIMENT).write_text(as_yaml(data), encoding="utf-8")
    Store.open(draft).write(MANIFEST, _as_json(_first_manifest(name, loaded, started, facts)))


def remove(folder: RunFolder) -> None:
    """Remove a run that never began, as far as that can be done."""
    with contextlib.suppress(StoreError):
        folder.store.remove_tree()


def _first_manifest(name: str, loaded: Loaded, started: datetime, facts: Mapping[str, Any]) -> dict[str, Any]:
    return {
        "run": name,
        "status": "running",
        "seed": loaded.experiment.seed,
        "schema": VERSION,
        "versions": versions(PACKAGES),
        "started": started.isoformat(timespec="seconds"),
        "ended": None,
        "machine": platform.node(),
        "process": os.getpid(),
        **facts,
    }


def versions(packages: Sequence[str]) -> dict[str, str]:
    """Give the versions of Python and of those packages that are installed."""
    found = {"python": platform.python_version()}
    for package in packages:
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            continue
    return found


def _as_json(manifest: Mapping[str, Any]) -> bytes:
    return (json.dumps(manifest, indent=2, allow_nan=False) + "\n").encode()
