"""From a resolved experiment to islands, edges, and what each host is to do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from genome.errors import InputError
from islands.host import HostPlan
from islands.migration.channel import Channel, Edge
from islands.spec import IslandSpec
from orchestrator.experiment import ChannelSettings
from orchestrator.loading import Loaded, check_name
from orchestrator.topology.registry import edges_of


@dataclass(frozen=True, slots=True)
class Plan:
    """The islands of a run in the order of their numbers, and its edges in the order of channels, then sources."""

    islands: tuple[IslandSpec, ...]
    edges: tuple[Edge, ...]


def make_plan(loaded: Loaded) -> Plan:
    """Expand an experiment.

    Raises
    ------
    InputError
        For islands of one name, a channel to an island that is not there, islands of different species on a channel,
        or a migration larger than a deme.
    """
    islands = _islands(loaded)
    edges: list[Edge] = []
    names: dict[str, int] = {}
    for number, settings in enumerate(loaded.experiment.channels):
        where = f"{loaded.source}: channels.{number}"
        name = settings.name or f"{settings.kind}-{number}"
        if name in names:
            raise InputError(f"{where}.name", "a name of its own", f"'{name}', as channel {names[name]}", "rename it")
        names[name] = number
        edges.extend(_edges(settings, number, name, islands, where))
    return Plan(islands, tuple(edges))


def host_plans(loaded: Loaded, plan: Plan, hosts: int, run: str, folder: Path) -> tuple[HostPlan, ...]:
    """Share the islands out among hosts, in blocks of neighbours as equal as can be."""
    count = len(plan.islands)
    placement = tuple(island * hosts // count for island in range(count))
    plans = []
    for host in range(hosts):
        here = tuple(spec for spec in plan.islands if placement[spec.number] == host)
        edges = tuple(edge for edge in plan.edges if host in (placement[edge.source], placement[edge.target]))
        plans.append(
            HostPlan(
                host=host,
                hosts=hosts,
                run=run,
                seed=loaded.experiment.seed,
                folder=str(folder),
                islands=here,
                edges=edges,
                placement=placement,
                generations=loaded.experiment.epoch,
                flush_epochs=loaded.experiment.flush_epochs,
                best_forms=loaded.experiment.forms.best,
            )
        )
    return tuple(plans)


def _islands(loaded: Loaded) -> tuple[IslandSpec, ...]:
    specs: list[IslandSpec] = []
    groups: dict[str, str] = {}
    for group, settings in loaded.experiment.islands.items():
        names = [group] if settings.count == 1 else [f"{group}-{place}" for place in range(settings.count)]
        for name in names:
            if name in groups:
                got = f"'{name}', a name that the islands of '{groups[name]}' have already"
                raise InputError(f"{loaded.source}: islands.{group}", "islands of different names", got, "rename it")
            groups[name] = group
            specs.append(
                IslandSpec(
                    name=name,
                    group=group,
                    number=len(specs),
                    species=str(settings.species),
                    kind=settings.kind,
                    population=settings.population,
                    genome=settings.genome,
                    growth=settings.growth,
                    fitness={key: goal.model_dump(mode="json") for key, goal in settings.fitness.items()},
                    algorithm=settings.algorithm,
                    source=loaded.source,
                    base=str(loaded.base),
                )
            )
    return tuple(specs)


def _edges(settings: ChannelSettings, number: int, name: str, islands: Sequence[IslandSpec], where: str) -> list[Edge]:
    channel = Channel(
        number=number,
        name=name,
        kind=settings.kind,
        every=settings.every,
        count=settings.count,
        select=settings.select,
        tournament=settings.tournament,
        replace=settings.replace,
        accept=settings.accept,
    )
    edges = []
    for source, target in _pairs(settings, islands, where):
        if source.species != target.species:
            got = f"{source.name} ({source.species}) and {target.name} ({target.species})"
            remedy = "migrants travel within a species: give both the same genome, or the same 'species'"
            raise InputError(where, "islands of one species", got, remedy)
        for end in (source, target):
            if settings.count > end.population:
                got = f"{settings.count}, more than the {end.population} members of {end.name}"
                raise InputError(f"{where}.count", "at most a deme's members", got)
        edges.append(Edge(channel, source.number, target.number, source.name, target.name))
    return sorted(edges, key=lambda edge: (edge.source, edge.target))


def _pairs(settings: ChannelSettings, islands: Sequence[IslandSpec], where: str) -> list[tuple[IslandSpec, IslandSpec]]:
    if settings.topology is None:
        (source,) = _named([str(settings.source)], islands, f"{where}.from", single=True)
        (target,) = _named([str(settings.target)], islands, f"{where}.to", single=True)
        if source == target:
            raise InputError(where, "two islands", f"'{source.name}' twice", "a channel to itself carries nothing")
        return [(source, target)]
    among = [settings.among] if isinstance(settings.among, str) else settings.among
    if among is not None and len(set(among)) < max(len(among), 1):
        got = "none" if not among else f"{', '.join(among)}"
        raise InputError(f"{where}.among", "islands or groups, each once", got, "without 'among' it is all islands")
    members = list(islands) if among is None else _named(among, islands, f"{where}.among", single=False)
    edges = edges_of(settings.topology, len(members), f"{where}.topology")
    return [(members[source], members[target]) for source, target in edges]


def _named(names: Sequence[str], islands: Sequence[IslandSpec], where: str, *, single: bool) -> list[IslandSpec]:
    """Give the islands by name, or by the name of their group, each once."""
    known = list(dict.fromkeys([*(spec.group for spec in islands), *(spec.name for spec in islands)]))
    found: dict[int, IslandSpec] = {}
    for name in names:
        check_name(name, known, where, "an island of the experiment")
        for spec in islands:
            if name == spec.name or (name == spec.group and not (single and spec.name != name)):
                found[spec.number] = spec
    if single and len(found) != 1:
        members = [spec.name for spec in islands if spec.group in names]
        raise InputError(where, "one island", f"the group '{names[0]}'", f"name one of {', '.join(members)}")
    return list(found.values())
