"""Checking a request against a run as it is: what comes of it is what the run's history and its islands are given."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any, Final

from evaluators.plugins import guarded
from genome.errors import InputError
from genome.mishaps import let_pass, told
from genome.settings import describe, near
from islands.individual import home_of
from islands.interventions import goals, rates, strengths
from islands.interventions.strengths import STRENGTH
from islands.kinds.protocol import Biology
from islands.kinds.registry import resolve_kind
from islands.scoring import scored
from islands.spec import IslandSpec
from islands.strengths import has_strengths, loaded
from orchestrator.overrides import apply_overrides
from orchestrator.steering.command import ISLANDS, RUN, Request
from orchestrator.steering.restructuring import living_names, restructured
from orchestrator.steering.shapes import shaped
from orchestrator.steering.structure import Structure

Arguments = Mapping[str, Any]


def checked(request: Request, structure: Structure, epoch: int, *, trial: bool = False) -> Request:
    """Check a request, and write out what it leaves open.

    Parameters
    ----------
    request
        As :func:`orchestrator.steering.language.read` gives it, or as this function gave it before.
    structure
        Of the run.
    epoch
        At whose start it would take effect.
    trial
        Also read and score what is to be inserted: for whoever steers; it takes as long as a scoring takes.

    Raises
    ------
    InputError
        When it cannot be meant: an island, a criterion or a channel that is not there, a value out of its bounds, a
        genotype that cannot be read.
    """
    shaped(request)
    if request.verb in RUN:
        return request
    if request.verb in ISLANDS:
        return Request(request.verb, _for_islands(request, structure, epoch, trial=trial))
    arguments = dict(request.arguments)
    if request.verb == "add-island" and "settings" not in arguments:
        arguments = _settled(arguments, structure, epoch)
    if request.verb == "remove-island":
        arguments["islands"] = living_names(arguments["islands"], structure, epoch, "steer remove-island")
    restructured(structure, request.verb, arguments, epoch)
    return Request(request.verb, arguments)


# -- for islands -------------------------------------------------------------------------------------------------------


def _for_islands(request: Request, structure: Structure, epoch: int, *, trial: bool) -> dict[str, Any]:
    verb, arguments = request.verb, dict(request.arguments)
    given = arguments.pop("islands", [])
    living = structure.living(epoch)
    specs: Sequence[IslandSpec] = living
    if given:
        names = frozenset(living_names(given, structure, epoch, f"steer {verb}"))
        specs = [spec for spec in living if spec.name in names]
    elif verb in ("weight", "target"):
        # Those whose goals have other criteria are not meant.
        specs = [spec for spec in living if set(arguments["values"]) <= set(spec.fitness)]
        if not specs:
            raise _no_such_goals(verb, arguments["values"], living)
    elif verb == STRENGTH:
        # Islands of other kinds are not meant; where there is no island of bodies the check of any says so.
        specs = [spec for spec in living if has_strengths(spec.growth)] or living
    if "id" in arguments:
        _refuse_stranger(verb, arguments["id"], structure)
    groups: dict[str, IslandSpec] = {}
    for spec in specs:
        groups.setdefault(spec.group, spec)
    for spec in groups.values():
        _CHECKS.get(verb, _nothing)(spec, verb, arguments, trial)
    if given or len(specs) < len(living):
        arguments["islands"] = [spec.name for spec in specs]
    return arguments


def _no_such_goals(verb: str, values: Mapping[str, float], living: Sequence[IslandSpec]) -> InputError:
    known = sorted({name for spec in living for name in spec.fitness})
    unknown = [name for name in values if name not in known]
    if not unknown:
        got = f"{' and '.join(values)}, which are goals of different islands"
        return InputError(f"steer {verb}", "criteria of one island", got, "give a command for each")
    return InputError(
        f"steer {verb}", "a criterion that an island has a goal for", f"'{unknown[0]}'", near(unknown[0], known)
    )


def _refuse_stranger(verb: str, identity: int, structure: Structure) -> None:
    number = home_of(identity)
    if number >= len(structure.islands()):
        got = f"{identity}, which would be of an island number {number}"
        raise InputError(f"steer {verb}", "the id of an individual of the run", got)


def _goals(spec: IslandSpec, verb: str, arguments: Arguments, trial: bool) -> None:
    del trial
    changed = goals.changed(verb, spec.fitness, arguments["values"], f"steer {verb} on {spec.group}")
    fitness = {**spec.fitness, **{name: goal.model_dump(mode="json") for name, goal in changed.items()}}
    # A kind that cannot be built of them would end the run, and each run that goes on from its history.
    _built(replace(spec, fitness=fitness))


def _rates(spec: IslandSpec, verb: str, arguments: Arguments, trial: bool) -> None:
    del trial
    rates.changed(spec.algorithm, spec.population, arguments["values"], f"steer {verb} on {spec.group}")


def _strengths(spec: IslandSpec, verb: str, arguments: Arguments, trial: bool) -> None:
    del trial
    changed = strengths.changed(spec.growth, arguments["values"], f"steer {verb} on {spec.group}")
    _built(replace(spec, growth=loaded(spec.growth, changed)))


def _insert(spec: IslandSpec, verb: str, arguments: Arguments, trial: bool) -> None:
    if not trial:
        return
    where, text = f"steer {verb}", arguments["genotype"]
    biology = _built(spec)
    try:
        genotype = biology.decode(text)
    except BaseException as error:
        let_pass(error)
        expected = f"a genotype that {spec.name} can read"
        raise InputError(where, expected, f"{describe(text)} ({told(error)})") from error
    found = scored(biology, genotype)
    if found.fitness is None:
        raise InputError(where, f"a genotype that is valid on {spec.name}", f"{describe(text)} ({found.error})")


def _nothing(spec: IslandSpec, verb: str, arguments: Arguments, trial: bool) -> None:
    del spec, verb, arguments, trial


_CHECKS: Final[Mapping[str, Callable[[IslandSpec, str, Arguments, bool], None]]] = {
    "weight": _goals,
    "target": _goals,
    "rate": _rates,
    STRENGTH: _strengths,
    "insert": _insert,
}


def _built(spec: IslandSpec) -> Biology[Any]:
    """Build an island's biology on trial."""
    with guarded(spec.where("kind"), "an island kind", describe(spec.kind)):
        return resolve_kind(spec.kind, spec.where("kind")).build(spec, time.perf_counter)


# -- for the structure -------------------------------------------------------------------------------------------------


def _settled(arguments: Mapping[str, Any], structure: Structure, epoch: int) -> dict[str, Any]:
    """Give name and whole settings of an island that is to be like those of a group, but for what is set.

    It is one island unless ``count`` is set. Where its genome is set, its species is named anew, unless that is set.
    """
    where, groups = "steer add-island", list(dict.fromkeys(spec.group for spec in structure.living(epoch)))
    like = arguments["like"]
    if not like and len(groups) == 1:
        like = groups[0]
    known = structure.loaded.experiment.islands
    if like not in known:
        got = describe(like) if like else "none"
        raise InputError(f"{where} --like", "a group of islands of the run", got, near(like, list(known)))
    settings = structure.loaded.data()["islands"][like]
    settings["count"] = 1
    changed = apply_overrides(settings, arguments["set"])
    if changed["genome"] != settings["genome"] and changed["species"] == settings["species"]:
        del changed["species"]
    return {"name": arguments["name"], "settings": changed}
