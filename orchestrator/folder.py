"""The run's folder: made whole or not at all, and its manifest."""

from __future__ import annotations

import contextlib
import errno
import io
import json
import os
import platform
import secrets
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, Final

from genome.errors import InputError
from genome.files import write_whole
from genome.settings import near
from genome.yaml import parse_yaml
from islands.kinds.protocol import Keep
from islands.kinds.registry import resolve_kind
from islands.schemas import VERSION
from orchestrator.channels import ChannelSettings
from orchestrator.loading import Loaded
from orchestrator.plan import make_plan
from orchestrator.topology.registry import kept

MANIFEST: Final = "manifest.json"
EXPERIMENT: Final = "experiment.yaml"
DEFAULT_RUNS: Final = Path("runs")
LONGEST_NAME: Final = 100
"""Characters of a run's name, as of an experiment's: the run's folder holds the experiment under its own name."""
TAKEN: Final = (errno.EEXIST, errno.ENOTEMPTY, errno.ENOTDIR)
"""What a folder's move fails with where something stands already."""
PACKAGES: Final = ("atoll", "numpy", "numba", "deap", "pyarrow", "ray", "trimesh")


@dataclass(frozen=True, slots=True)
class RunFolder:
    """A run's folder that exists."""

    path: Path

    @property
    def log(self) -> Path:
        """Where the tables' folders are."""
        return self.path / "log"

    @property
    def name(self) -> str:
        """The run's name."""
        return self.path.name

    @property
    def experiment(self) -> Path:
        """The experiment as resolved."""
        return self.path / EXPERIMENT

    def manifest(self) -> dict[str, Any]:
        """Read the manifest.

        Raises
        ------
        InputError
            When it is no JSON object.
        """
        path = self.path / MANIFEST
        try:
            found = json.loads(path.read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise InputError(str(path), "a run's manifest", f"a file that cannot be read ({error})") from None
        if not isinstance(found, dict):
            raise InputError(str(path), "a run's manifest, a JSON object", type(found).__name__)
        return found

    def update(self, **changes: Any) -> None:  # noqa: ANN401 - plain JSON values
        """Change keys of the manifest, atomically."""
        _write_manifest(self.path, {**self.manifest(), **changes})


def open_run(path: str) -> RunFolder:
    """Give the run in this folder, or of this name under ``runs``.

    Raises
    ------
    InputError
        When it is no run's folder.
    """
    for folder in (Path(path), DEFAULT_RUNS / path):
        if (folder / MANIFEST).is_file():
            return RunFolder(folder.resolve())
    if not Path(path).exists():
        known = [entry.parent.name for entry in sorted(DEFAULT_RUNS.glob(f"*/{MANIFEST}"))]
        remedy = near(Path(path).name, known) if known else "see 'atoll run --help'"
        raise InputError(path, "a run's folder", "nothing by that name", remedy)
    raise InputError(path, "a run's folder", f"one without {MANIFEST}", "give the folder that 'atoll run' printed")


def choose_path(runs_dir: Path, name: str, *, explicit: bool) -> Path:
    """Give the path of a new run.

    A name that was asked for must be free; a name by default gets a number when it is taken.

    Raises
    ------
    InputError
        When a name that was asked for is taken, or is too long.
    """
    if explicit and len(name) > LONGEST_NAME:
        raise InputError("--name", f"at most {LONGEST_NAME} characters", str(len(name)), "choose a shorter name")
    path, number = runs_dir / name, 1
    # Links that lead nowhere count as taken, too: a folder cannot be moved to their place.
    while os.path.lexists(path):
        if explicit:
            raise InputError(f"--name {name}", "a name that is free", f"{path}, which exists", "choose another name")
        number += 1
        mark = f"-{number}"
        path = runs_dir / f"{name[: LONGEST_NAME - len(mark)]}{mark}"
    return path


def create(
    runs_dir: Path, name: str, loaded: Loaded, started: datetime, facts: Mapping[str, Any], *, explicit: bool
) -> RunFolder:
    """Make a run's folder, with the experiment and every file that it names.

    It is built beside its place and moved there when it is complete. The move claims the name: of runs that start
    together one has it, and the others get the next numbers.

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
    is_new = not runs_dir.exists()
    try:
        runs_dir.mkdir(parents=True, exist_ok=True)
        try:
            while True:
                path = choose_path(runs_dir, name, explicit=explicit)
                if _made(path, loaded, started, facts):
                    return RunFolder(path.resolve())
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
        data = {**_with_files_kept(loaded, draft), "name": path.name}
        (draft / EXPERIMENT).write_text(_as_yaml(data), encoding="utf-8")
        _write_manifest(draft, _first_manifest(path.name, loaded, started, facts))
        draft.rename(path)
    except BaseException as error:
        shutil.rmtree(draft, ignore_errors=True)
        if isinstance(error, OSError) and error.errno in TAKEN and os.path.lexists(path):
            return False
        raise
    return True


def remove(folder: RunFolder) -> None:
    """Remove a run that never began."""
    shutil.rmtree(folder.path, ignore_errors=True)


def _with_files_kept(loaded: Loaded, draft: Path) -> dict[str, Any]:
    """Copy what the islands name into the folder; give the experiment's data with the copies in their place."""
    taken: dict[str, bytes] = {}

    def keep(folder: str, name: str, content: bytes) -> str:
        stem, _, suffix = name.partition(".")
        place, number = f"{folder}/{name}", 2
        while taken.get(place, content) != content:
            place, number = f"{folder}/{stem}-{number}.{suffix}", number + 1
        if place not in taken:
            taken[place] = content
            (draft / folder).mkdir(parents=True, exist_ok=True)
            (draft / place).write_bytes(content)
        return place

    islands = dict(loaded.experiment.islands)
    for spec in {spec.group: spec for spec in make_plan(loaded).islands}.values():
        kind = resolve_kind(spec.kind, spec.where("kind"))
        genome, growth = kind.keep_files(spec, keep)
        changes = {"genome": dict(genome), "growth": dict(growth)}
        islands[spec.group] = islands[spec.group].model_copy(update=changes)
    channels = [
        _with_graph_kept(channel, loaded.base, keep, f"{loaded.source}: channels.{number}.topology")
        for number, channel in enumerate(loaded.experiment.channels)
    ]
    experiment = loaded.experiment.model_copy(update={"islands": islands, "channels": channels})
    return replace(loaded, experiment=experiment).data()


def _with_graph_kept(channel: ChannelSettings, base: Path, keep: Keep, where: str) -> ChannelSettings:
    """Keep the file that a channel's topology reads."""
    if not channel.parameters:
        return channel
    parameters = kept(channel.topology_name, channel.parameters, base, keep, where)
    return channel.model_copy(update={"topology": {"name": channel.topology_name, **parameters}})


def _as_yaml(data: Mapping[str, Any]) -> str:
    from ruamel.yaml import YAML

    writer = YAML(typ="safe", pure=True)
    writer.default_flow_style = False
    writer.sort_base_mapping_type_on_output = False  # type: ignore[assignment]
    writer.width = 10_000
    stream = io.StringIO()
    writer.dump(dict(data), stream)
    text = stream.getvalue()
    if parse_yaml(text, EXPERIMENT).data != data:
        raise AssertionError(f"the resolved experiment does not read back as it was written:\n{text}")
    return text


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


def _write_manifest(folder: Path, manifest: Mapping[str, Any]) -> None:
    write_whole(folder / MANIFEST, (json.dumps(manifest, indent=2, allow_nan=False) + "\n").encode())
