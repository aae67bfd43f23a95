"""From a resolved experiment to islands, edges, and what each host is to do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from genome.errors import InputError
from islands.migration.channel import Edge
from islands.migration.routes import Redrawn
from islands.orders import NOWHERE, HostPlan
from islands.spec import IslandSpec
from islands.store import Anywhere, Store
from orchestrator.loading import Loaded
from orchestrator.wiring import wire


@dataclass(frozen=True, slots=True)
class Plan:
    """The islands of a run in the order of their numbers, and its edges in the order of channels, then sources.

    ``redrawn`` are the channels whose edges are drawn anew for each epoch.
    """

    islands: tuple[IslandSpec, ...]
    edges: tuple[Edge, ...]
    redrawn: tuple[Redrawn, ...] = ()


def make_plan(loaded: Loaded) -> Plan:
    """Expand an experiment.

    Raises
    ------
    InputError
        For islands of one name, and for all that :func:`~orchestrator.wiring.wire` refuses.
    """
    islands = islands_of(loaded)
    wired = wire(loaded.experiment, islands, loaded.source, loaded.base)
    edges = tuple(edge for one in wired for edge in one.edges)
    return Plan(islands, edges, tuple(one.redrawn for one in wired if one.redrawn is not None))


def host_plans(
    loaded: Loaded, plan: Plan, hosts: int, run: str, folder: Anywhere, epoch: int = 0
) -> tuple[HostPlan, ...]:
    """Share the islands that are there in an epoch out among hosts, in blocks of neighbours as equal as can be."""
    place = Store.open(folder).place
    living = [spec.number for spec in plan.islands if spec.is_there(epoch)]
    homes = {number: turn * hosts // len(living) for turn, number in enumerate(living)}
    placement = tuple(homes.get(spec.number, NOWHERE) for spec in plan.islands)
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
                folder=place,
                islands=here,
                edges=edges,
                placement=placement,
                generations=loaded.experiment.epoch,
                flush_epochs=loaded.experiment.flush_epochs,
                best_forms=loaded.experiment.forms.best,
                redrawn=plan.redrawn,
                foreign=_foreign(plan, placement, host),
            )
        )
    return tuple(plans)


def _foreign(plan: Plan, placement: Sequence[int], host: int) -> tuple[IslandSpec, ...]:
    """Give the islands of other hosts whose genotypes adapters of this one are to translate."""
    sources = {edge.source for edge in plan.edges if edge.adapter and placement[edge.target] == host}
    for channel in plan.redrawn:
        if channel.adapter and any(placement[number] == host for number, _ in channel.members):
            sources |= {number for number, _ in channel.members}
    return tuple(plan.islands[source] for source in sorted(sources) if placement[source] != host)


def islands_of(loaded: Loaded) -> tuple[IslandSpec, ...]:
    """Give the islands of an experiment in the order of their numbers.

    Raises
    ------
    InputError
        For islands of one name.
    """
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
                    epochs=settings.epochs,
                )
            )
    return tuple(specs)
