"""From the experiment's channels to edges between islands, and the refusal of those that cannot be meant."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from genome.errors import InputError
from islands.migration.channel import Channel, ChannelKind, Edge
from islands.migration.routes import Redrawn
from islands.spec import IslandSpec
from orchestrator.channels import ChannelSettings, channel_of
from orchestrator.compatibility import Compatibility
from orchestrator.experiment import Experiment
from orchestrator.members import members_of, numbers_of
from orchestrator.topology.protocol import Ground, Link, located
from orchestrator.topology.random import Random
from orchestrator.topology.registry import OPEN, TOPOLOGIES, links_of, with_parameters


@dataclass(frozen=True, slots=True)
class Wired:
    """One channel, wired.

    Attributes
    ----------
    settings, where
        As in the file, and where there.
    channel
        What its edges share.
    members
        The islands that its topology is laid out on; empty for a channel from islands to others.
    ends
        The islands that it is about.
    edges
        Its edges, by source, then target.
    redrawn
        In place of edges, where they are drawn anew for each epoch.
    """

    settings: ChannelSettings
    where: str
    channel: Channel
    members: tuple[int, ...]
    ends: frozenset[int]
    edges: tuple[Edge, ...]
    redrawn: Redrawn | None = None


def wire(experiment: Experiment, islands: Sequence[IslandSpec], source: str, base: Path) -> tuple[Wired, ...]:
    """Wire all channels of an experiment.

    Parameters
    ----------
    experiment
        Its channels are completed.
    islands
        In the order of their numbers.
    source, base
        The file's name, and the folder that file names are relative to.

    Raises
    ------
    InputError
        For two channels of one name, islands that are not there, a topology that does not fit them, islands that have
        nothing to exchange, more migrants than members, or an island that nobody reaches.
    """
    fits = Compatibility(islands)
    wired = wired_channels(experiment, islands, source, base, fits)
    _refuse_needy(wired, islands, fits)
    _refuse_sharing_alone(wired, islands)
    refuse_emptied(wired, islands)
    _refuse_unreached(wired, islands, source)
    _refuse_unfed(wired, islands, fits)
    return wired


def wired_channels(
    experiment: Experiment, islands: Sequence[IslandSpec], source: str, base: Path, fits: Compatibility
) -> tuple[Wired, ...]:
    """Wire all channels of an experiment, each looked at by itself; as :func:`wire` otherwise."""
    names: dict[str, int] = {}
    wired = []
    for number, settings in enumerate(experiment.channels):
        where = f"{source}: channels.{number}"
        name = settings.name or f"{settings.kind}-{number}"
        if name in names:
            raise InputError(f"{where}.name", "a name of its own", f"'{name}', as channel {names[name]}", "rename it")
        names[name] = number
        one = _Wiring(experiment, islands, base, number, name).wired(settings, where)
        fits.check(one.settings, one.edges, one.redrawn, where)
        wired.append(one)
    return tuple(wired)


@dataclass(frozen=True, slots=True)
class _Wiring:
    """Wires one channel."""

    experiment: Experiment
    islands: Sequence[IslandSpec]
    base: Path
    number: int
    name: str

    def wired(self, settings: ChannelSettings, where: str) -> Wired:
        if settings.topology is None:
            joined, ends = self._from_to(settings, where)
            return self._laid(settings, where, (), ends, joined)
        names = [(spec.group, spec.name) for spec in self.islands]
        members = tuple(members_of(settings, names, where))
        ground = Ground(
            names=tuple(self.islands[member].name for member in members),
            base=self.base,
            seed=self.experiment.seed,
            channel=self.number,
            reach=settings.unreached != "allow",
        )
        place = f"{where}.topology"
        topology = with_parameters(settings.topology_name, settings.parameters, place)
        if isinstance(topology, Random):
            return self._anew(settings, where, members, topology, ground)
        links = links_of(settings.topology_name, settings.parameters, ground, place)
        between = links
        if members != tuple(range(len(members))):
            between = [Link(members[link.source], members[link.target], link.weight) for link in links]
        return self._laid(settings, where, members, members, between)

    def _laid(
        self, settings: ChannelSettings, where: str, members: Sequence[int], ends: Sequence[int], links: Sequence[Link]
    ) -> Wired:
        largest = max((self.islands[source].population for source in {link.source for link in links}), default=1)
        channel = channel_of(settings, self.number, self.name, largest)
        edges = []
        # There may be a million of them: what they share is looked up once.
        names, species = [spec.name for spec in self.islands], [spec.species for spec in self.islands]
        usual, adapter = settings.weight, settings.adapter or ""
        for source, target, weight in sorted(links):
            between = adapter if adapter and species[source] != species[target] else ""  # one species needs none
            carries = usual if weight is None else weight
            edges.append(Edge(channel, source, target, names[source], names[target], carries, between))
        if edges and not any(edge.weight for edge in edges):
            got = "0 on each edge, by which it never carries"
            raise InputError(f"{where}.topology", "an edge with a weight above 0", got, "remove the channel")
        return Wired(settings, where, channel, tuple(members), frozenset(ends), tuple(edges))

    def _anew(
        self, settings: ChannelSettings, where: str, members: Sequence[int], topology: Random, ground: Ground
    ) -> Wired:
        try:
            topology.check(ground)
        except InputError as error:
            raise located(error, f"{where}.topology") from None
        specs = [self.islands[member] for member in sorted(members)]
        channel = channel_of(settings, self.number, self.name, max(spec.population for spec in specs))
        redrawn = None
        if len(specs) > 1:
            named = tuple((spec.number, spec.name) for spec in specs)
            species = tuple(spec.species for spec in specs) if settings.adapter else ()
            redrawn = Redrawn(channel, named, topology.degree, settings.weight, settings.adapter or "", species)
        return Wired(settings, where, channel, tuple(members), frozenset(members), (), redrawn)

    def _from_to(self, settings: ChannelSettings, where: str) -> tuple[list[Link], list[int]]:
        names = [(spec.group, spec.name) for spec in self.islands]
        sides = []
        for key, given in (("from", settings.source), ("to", settings.target)):
            if not given:
                raise InputError(f"{where}.{key}", "an island or a group", "none", "name one")
            sides.append(numbers_of(given, names, f"{where}.{key}"))
        sources, targets = sides
        if settings.join == "matching":
            if len(sources) != len(targets):
                got = f"{len(sources)} and {len(targets)}"
                raise InputError(f"{where}.join", "as many islands in 'from' as in 'to'", got, "take join: all")
            pairs = list(zip(sources, targets, strict=True))
            loop = next((source for source, target in pairs if source == target), None)
        else:
            pairs = [(source, target) for source in sources for target in targets if source != target]
            loop = None if pairs else sources[0]
        if loop is not None:
            got = f"'{self.islands[loop].name}' twice"
            raise InputError(f"{where}.to", "two islands", got, "a channel to itself carries nothing")
        return [Link(*pair) for pair in pairs], [*sources, *targets]


def needy(
    wired: Sequence[Wired], islands: Sequence[IslandSpec], fits: Compatibility
) -> list[tuple[IslandSpec, ChannelKind]]:
    """Give the islands whose kinds need a channel of some kind that never reaches them, and which kind of channel."""
    fed: dict[ChannelKind, set[int]] = defaultdict(set)
    for one in wired:
        fed[one.channel.kind] |= _entered(one)
    return [(spec, kind) for spec in islands for kind in fits.needs(spec) if spec.number not in fed[kind]]


def _refuse_needy(wired: Sequence[Wired], islands: Sequence[IslandSpec], fits: Compatibility) -> None:
    """Refuse an island whose kind needs a channel of some kind that never reaches it."""
    for spec, kind in needy(wired, islands, fits):
        expected = f"a channel of kind {kind} to {spec.name}, which it needs"
        remedy = f"{kind} missing: add {{kind: {kind}, from: ..., to: {spec.group}}} to 'channels'"
        raise InputError(spec.where("kind"), expected, "none", remedy)


def _refuse_sharing_alone(wired: Sequence[Wired], islands: Sequence[IslandSpec]) -> None:
    """Refuse an island that is to share fitness, and has no partners to divide, or but one."""
    most: dict[int, int] = defaultdict(int)
    for one in wired:
        if one.channel.pairing is not None:
            for number in _entered(one):
                most[number] = max(most[number], one.channel.pairing.count)
    for spec in islands:
        if spec.algorithm.sharing != "none" and most[spec.number] < 2:
            got = f"{most[spec.number] or 'no channel of partners'} to {spec.name}"
            remedy = "it is partners that members share: add {kind: partners, pairing: several}, or take sharing: none"
            raise InputError(spec.where("algorithm", "sharing"), "two or more pairings to share by", got, remedy)


def refuse_emptied(wired: Sequence[Wired], islands: Sequence[IslandSpec]) -> None:
    """Refuse channels that move so many at a time that none is left."""
    leaving: dict[int, int] = defaultdict(int)
    last: dict[int, str] = {}
    for one in wired:
        if not one.channel.move:
            continue
        edges: dict[int, int] = defaultdict(int)
        for edge in one.edges:
            edges[edge.source] += 1
        if one.redrawn is not None:
            edges |= {number: one.redrawn.degree for number, _ in one.redrawn.members}
        for source, number in edges.items():
            times = 1 if one.channel.routing == "point" else number
            leaving[source] += times * one.channel.size(islands[source].population)
            last[source] = one.where
    for source in sorted(leaving):
        spec = islands[source]
        if leaving[source] >= spec.population:
            expected = f"at most {spec.population - 1} that move from {spec.name} at a time, so that one of them stays"
            remedy = "lower 'count', take mode: copy, or routing: point"
            raise InputError(f"{last[source]}.mode", expected, str(leaving[source]), remedy)


def _refuse_unreached(wired: Sequence[Wired], islands: Sequence[IslandSpec], source: str) -> None:
    """Refuse an island that is on no channel though there are some, or that no edge enters though it is a member."""
    if not wired:
        return
    on = frozenset().union(*(one.ends for one in wired))
    for spec in islands:
        if spec.number not in on:
            remedy = f"name it in 'among', or add {{topology: unconnected, among: {spec.group}}}"
            got = f"{spec.name}, which is on none"
            raise InputError(f"{source}: channels", "islands that are each on a channel", got, remedy)
    entered: dict[ChannelKind, set[int]] = defaultdict(set)
    for one in wired:
        entered[one.channel.kind] |= _entered(one)
    for one in wired:
        if not _may_miss(one.settings) or one.settings.unreached == "allow":
            continue
        for member in one.members:
            if member not in entered[one.channel.kind] and len(one.members) > 1:
                expected = "a topology that reaches each of its islands"
                got = f"none of its edges to {islands[member].name}"
                remedy = "add one, or set unreached: allow"
                raise InputError(f"{one.where}.topology", expected, got, remedy)


def _may_miss(settings: ChannelSettings) -> bool:
    """Tell whether a channel's topology is one that may leave out islands."""
    name = settings.topology_name
    return bool(name) and (name in OPEN or name not in TOPOLOGIES)


def _entered(one: Wired) -> set[int]:
    """Give the islands that a channel's edges enter: those that never carry do not count."""
    if one.redrawn is not None:
        return {number for number, _ in one.redrawn.members} if one.redrawn.weight > 0 else set()
    return {edge.target for edge in one.edges if edge.weight > 0}


def unfed(
    wired: Sequence[Wired], islands: Sequence[IslandSpec], among: Sequence[IslandSpec], fits: Compatibility
) -> list[tuple[IslandSpec, ChannelKind, str]]:
    """Give those among the islands to which something never comes that they need, the kind of channel, and its name."""
    wanted = {(spec.number, kind): names for spec in among for kind, names in fits.needed(spec).items()}
    if not wanted:
        return []
    come: dict[tuple[int, ChannelKind], set[str]] = defaultdict(set)
    for one in wired:
        kind = one.channel.kind
        given = {number: fits.given(islands[number], kind) for number in _sources(one)}
        for edge in one.edges:
            if edge.weight > 0 and (edge.target, kind) in wanted:
                come[edge.target, kind].add(given[edge.source])
        if one.redrawn is not None and one.redrawn.weight > 0:
            for number, _ in one.redrawn.members:  # in time each may show to each; nobody needs what it gives itself
                come[number, kind] |= set(given.values())
    return [
        (spec, kind, name)
        for spec in among
        for kind, names in fits.needed(spec).items()
        for name in names
        if name not in come[spec.number, kind]
    ]


def _sources(one: Wired) -> dict[int, None]:
    """Give the islands that a channel leads from."""
    members = () if one.redrawn is None else one.redrawn.members
    return dict.fromkeys([*(edge.source for edge in one.edges), *(number for number, _ in members)])


def _refuse_unfed(wired: Sequence[Wired], islands: Sequence[IslandSpec], fits: Compatibility) -> None:
    """Refuse an island to which channels never bring something that its kind needs."""
    for spec, kind, name in unfed(wired, islands, islands, fits):
        expected = f"a channel of kind {kind} that brings {spec.name} what it needs, {name}"
        remedy = f"add {{kind: {kind}, from: ..., to: {spec.group}}} to 'channels', from islands that give it"
        raise InputError(spec.where("kind"), expected, "none", remedy)
