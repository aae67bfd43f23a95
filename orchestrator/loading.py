"""From an experiment file to a resolved experiment: overrides, defaults, kinds, and every check that needs no run."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from evaluators.plugins import guarded
from genome.errors import InputError
from genome.settings import Path as KeyPath
from genome.settings import describe, validated
from genome.yaml import load_yaml
from islands.kinds.registry import resolve_kind
from orchestrator.channels import completed
from orchestrator.experiment import Experiment, IslandDefaults, IslandSettings, Scale
from orchestrator.idle import idle
from orchestrator.members import lonely
from orchestrator.overrides import apply_overrides, parse_override

LineOf = Callable[[KeyPath], int | None]


@dataclass(frozen=True, slots=True)
class Loaded:
    """A resolved experiment: defaults merged, kind settings validated and written out, species named.

    Attributes
    ----------
    experiment
        ``epochs`` is set; ``generations``, ``defaults`` and ``scale`` are not.
    source
        The file's name, for messages.
    base
        The folder that file names in it are relative to.
    notes
        What the person who wrote it should know.
    locate
        Gives an error about a key with the line where the key stands.
    """

    experiment: Experiment
    source: str
    base: Path
    notes: tuple[str, ...] = ()
    locate: Callable[[InputError], InputError] = lambda error: error

    def data(self) -> dict[str, Any]:
        """Give the experiment as plain data, every default written out."""
        return self.experiment.model_dump(mode="json", by_alias=True, exclude_none=True)


def load_experiment(path: Path, overrides: Sequence[str] = (), without: Sequence[str] = ()) -> Loaded:
    """Read and resolve an experiment.

    Parameters
    ----------
    path
        The YAML file.
    overrides
        ``key.path=value``, as ``--set`` takes them.
    without
        Keys of the file that give way to them.

    Raises
    ------
    InputError
        For the first thing that is wrong.
    """
    document = load_yaml(path)
    source = document.source
    data = document.data
    if not isinstance(data, Mapping):
        raise InputError(source, "an experiment: keys and values", describe(data))

    def locate(error: InputError) -> InputError:
        return located(of_brief(error, source, data), source, document.line_of, overrides)

    try:
        kept = {key: value for key, value in data.items() if key not in without}
        changed = apply_overrides(kept, overrides)
        changed.setdefault("name", re.sub(r"[^A-Za-z0-9_-]+", "-", path.name.split(".")[0]).strip("-_") or "run")
        experiment = resolved(changed, source)
        notes = (*lonely(experiment, source), *idle(experiment, source))
        return Loaded(experiment, source, path.resolve().parent, notes, locate)
    except InputError as error:
        raise locate(error) from None


def of_brief(error: InputError, source: str, data: Mapping[str, Any]) -> InputError:
    """Give an error about islands or channels that a brief wrote as one about the brief; any other as it is."""
    section, _, rest = error.where.removeprefix(f"{source}: ").partition(".")
    given = data.get(section)
    name = rest.partition(".")[0]
    if "brief" not in data or section not in ("islands", "channels") or (isinstance(given, Mapping) and name in given):
        return error
    if section == "channels" and isinstance(given, list) and given:
        return error  # its own channels stand behind those of the brief: whose it is cannot be told by its number
    got = f"{error.got} (in what the brief becomes: {section}.{rest})"
    return InputError(f"{source}: brief", error.expected, got, error.remedy)


def located(error: InputError, source: str, line_of: LineOf, overrides: Sequence[str] = ()) -> InputError:
    """Give the error with the line of the key that it names, or with the ``--set`` that gave it."""
    head, separator, keys = error.where.partition(f"{source}: ")
    if head or not separator:
        return error
    for override in overrides:
        given = ".".join(parse_override(override)[0])
        if keys == given or keys.startswith(f"{given}."):
            return InputError(f"--set {keys}", error.expected, error.got, error.remedy)
    path: KeyPath = tuple(int(part) if part.isdecimal() else part for part in keys.split("."))
    line = line_of(path)
    where = f"{source}:{line}: {keys}" if line else error.where
    return InputError(where, error.expected, error.got, error.remedy)


def resolved(data: dict[str, Any], source: str) -> Experiment:
    """Resolve an experiment's data: what :func:`load_experiment` does once they are read.

    Raises
    ------
    InputError
        For the first thing that is wrong.
    """
    if "brief" in data:
        # Imported where it is used: criteria of plans bring the compiler with them.
        from orchestrator.briefs import expanded

        data = expanded(data, source)
    defaults = data.pop("defaults", None)
    if defaults is not None:
        validated(IslandDefaults, defaults, source, ("defaults",))
        islands = data.get("islands")
        if isinstance(islands, Mapping):
            data["islands"] = {name: _merged(defaults, island) for name, island in islands.items()}
    experiment = validated(Experiment, data, source)
    scaled = {name: _scaled(island, experiment.scale or Scale()) for name, island in experiment.islands.items()}
    islands = {name: _with_kind(name, island, source) for name, island in scaled.items()}
    channels = [
        completed(channel, f"{source}: channels.{number}", experiment.epoch)
        for number, channel in enumerate(experiment.channels)
    ]
    changes = {"islands": islands, "channels": channels, "epochs": experiment.length}
    changes |= {"generations": None, "defaults": None, "scale": None}
    return experiment.model_copy(update=changes)


def _scaled(island: IslandSettings, scale: Scale) -> IslandSettings:
    """Multiply how many islands of a group there are, and their members."""
    return island.model_copy(
        update={"count": island.count * scale.islands, "population": island.population * scale.demes}
    )


def _merged(defaults: Mapping[str, Any], island: object) -> object:
    """Merge defaults into an island: its own keys win, and within a section its own keys win again."""
    if not isinstance(island, Mapping):
        return island
    merged = {**defaults, **island}
    for key, value in defaults.items():
        if isinstance(value, Mapping) and isinstance(island.get(key), Mapping):
            merged[key] = {**value, **island[key]}
    return merged


def _with_kind(name: str, island: IslandSettings, source: str) -> IslandSettings:
    """Validate an island's genome and growth by its kind, write out their defaults, and name its species."""
    where = f"{source}: islands.{name}.kind"
    with guarded(where, "an island kind", describe(island.kind)):
        kind = resolve_kind(island.kind, where)
        genome = validated(kind.genome, island.genome, source, ("islands", name, "genome")).model_dump(mode="json")
        growth = validated(kind.growth, island.growth, source, ("islands", name, "growth")).model_dump(mode="json")
    kept = island.algorithm.name == "generational" and island.algorithm.elitism == "keep"
    if kept and island.algorithm.elite >= island.population:
        where = f"{source}: islands.{name}.algorithm.elite"
        raise InputError(where, f"less than the population of {island.population}", str(island.algorithm.elite))
    parents = island.algorithm.parents
    if parents is not None and parents > island.population:
        where = f"{source}: islands.{name}.algorithm.parents"
        raise InputError(where, f"at most the population of {island.population}", str(parents))
    species = island.species
    if species is None:
        meaning = json.dumps(genome, sort_keys=True, allow_nan=False)
        species = f"{kind.name}-{hashlib.sha256(meaning.encode()).hexdigest()[:8]}"
    return island.model_copy(update={"genome": genome, "growth": growth, "species": species})
