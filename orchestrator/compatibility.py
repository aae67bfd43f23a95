"""What may travel between two islands: one species, an adapter between two, or what one kind gives and the other takes.

Everything that can be known of it is checked before a run starts.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from importlib.metadata import entry_points
from typing import Final, final

from genome.errors import InputError
from genome.settings import describe
from islands.kinds.protocol import Kind
from islands.kinds.registry import resolve_kind
from islands.kinds.trade import gives, needs, takes
from islands.migration.adapters import ADAPTERS, GROUP, build_adapter
from islands.migration.channel import Channel, ChannelKind, Edge
from islands.migration.routes import Redrawn
from islands.spec import IslandSpec
from orchestrator.channels import ChannelSettings

Pair = tuple[IslandSpec, IslandSpec, Channel]
"""Source, target, and what is between them."""


@final
class Compatibility:
    """Checks what channels are to carry. Islands of one group are alike, so that each pair of groups is looked at once.

    Parameters
    ----------
    islands
        In the order of their numbers.
    """

    def __init__(self, islands: Sequence[IslandSpec]) -> None:
        self._islands: Final = islands
        self._kinds: Final[dict[str, Kind]] = {}

    def needs(self, spec: IslandSpec) -> tuple[ChannelKind, ...]:
        """Give the kinds of channels that an island cannot do without."""
        return needs(self._kind(spec), spec)

    def check(self, settings: ChannelSettings, edges: Sequence[Edge], redrawn: Redrawn | None, where: str) -> None:
        """Check one channel.

        Raises
        ------
        InputError
            When two islands on it have nothing to exchange, or one of them is smaller than what is to travel.
        """
        for source, target, channel in self._pairs(edges, redrawn):
            if channel.kind == "migrants":
                self._check_species(settings, source, target, where)
            else:
                self._check_trade(channel.kind, source, target, where)
            _check_size(channel, source, target, where)
        self._check_pool(settings, edges, where)

    def _pairs(self, edges: Sequence[Edge], redrawn: Redrawn | None) -> Iterator[Pair]:
        """Give the first pair of islands of each two groups that a channel joins."""
        seen: set[tuple[str, str]] = set()
        for edge in edges:
            source, target = self._islands[edge.source], self._islands[edge.target]
            if (source.group, target.group) not in seen:
                seen.add((source.group, target.group))
                yield source, target, edge.channel
        if redrawn is not None:
            firsts = {self._islands[number].group: self._islands[number] for number, _ in reversed(redrawn.members)}
            for source in firsts.values():
                for target in firsts.values():
                    yield source, target, redrawn.channel

    def _kind(self, spec: IslandSpec) -> Kind:
        if spec.kind not in self._kinds:
            self._kinds[spec.kind] = resolve_kind(spec.kind, spec.where("kind"))
        return self._kinds[spec.kind]

    def _check_species(self, settings: ChannelSettings, source: IslandSpec, target: IslandSpec, where: str) -> None:
        kinds = self._kind(source).name, self._kind(target).name
        pair = f"{source.name} ({source.species}) and {target.name} ({target.species})"
        if source.species == target.species:
            if kinds[0] != kinds[1]:
                got = f"{pair} of the kinds '{kinds[0]}' and '{kinds[1]}'"
                raise InputError(where, "islands of one kind in a species", got, "give them different 'species'")
            return
        if settings.adapter is not None:
            self._check_adapter(settings.adapter, source, target, f"{where}.adapter")
            return
        known = self._suiting(source, target, where)
        remedy = "migrants travel within a species: give both the same genome, or the same 'species'"
        if kinds[0] != kinds[1]:
            remedy = "migrants travel within a species"
        remedy += f", or set adapter: {' or '.join(known)}" if known else ""
        got = f"{pair}, {_difference(source, target, kinds)}"
        raise InputError(where, "islands of one species", got, remedy)

    def _check_adapter(self, name: str, source: IslandSpec, target: IslandSpec, where: str) -> None:
        try:
            build_adapter(name, source, target, where)
        except InputError as error:
            known = self._suiting(source, target, where)
            remedy = f"these would do: {', '.join(known)}" if known else error.remedy
            raise InputError(error.where, error.expected, error.got, remedy) from None

    def _suiting(self, source: IslandSpec, target: IslandSpec, where: str) -> list[str]:
        """Give the names of adapters that would do between two islands."""
        found = []
        for name in sorted({*ADAPTERS, *entry_points(group=GROUP).names}):
            try:
                build_adapter(name, source, target, where)
            except InputError:
                continue
            found.append(name)
        return found

    def _check_trade(self, kind: ChannelKind, source: IslandSpec, target: IslandSpec, where: str) -> None:
        given, taken = gives(self._kind(source), kind), takes(self._kind(target), kind)
        if given and given in taken:
            return
        ends = f"{source.name} ('{source.kind}'), which gives {given or 'nothing'} to channels of kind {kind}, and "
        ends += f"{target.name} ('{target.kind}'), which takes {' or '.join(taken) or 'nothing'}"
        raise InputError(
            where, f"islands of which one gives {kind} that the other takes", ends, "change 'from' or 'to'"
        )

    def _check_pool(self, settings: ChannelSettings, edges: Sequence[Edge], where: str) -> None:
        """Refuse more pairings than there are partners shown."""
        if settings.kind != "partners" or settings.pairing not in ("several", "random"):
            return
        shown: dict[int, int] = defaultdict(int)
        for edge in edges:
            shown[edge.target] += edge.channel.size(self._islands[edge.source].population)
        for target, count in shown.items():
            if (settings.pairings or 1) > count:
                expected = f"at most {count}, as many as are shown to {self._islands[target].name}"
                raise InputError(f"{where}.pairings", expected, str(settings.pairings), "raise 'count'")


def _check_size(channel: Channel, source: IslandSpec, target: IslandSpec, where: str) -> None:
    """Refuse more travellers than a deme has members; migrants need places, too."""
    size, key = channel.size(source.population), "count" if channel.rate is None else "rate"
    for end in (source, target) if channel.kind == "migrants" else (source,):
        if size > end.population:
            what = str(size) if channel.rate is None else f"{channel.rate} of {source.name}, {size}"
            got = f"{what}, more than the {end.population} members of {end.name}"
            raise InputError(f"{where}.{key}", "at most a deme's members", got)


def _difference(source: IslandSpec, target: IslandSpec, kinds: tuple[str, str]) -> str:
    """Say why two islands are of different species."""
    if kinds[0] != kinds[1]:
        return f"of the kinds '{kinds[0]}' and '{kinds[1]}'"
    keys = [
        key
        for key in dict.fromkeys((*source.genome, *target.genome))
        if source.genome.get(key) != target.genome.get(key)
    ]
    if not keys:
        return "whose genomes are alike: they differ by 'species' alone"
    told = (f"{key} ({describe(source.genome.get(key))}, {describe(target.genome.get(key))})" for key in keys)
    return f"whose genomes differ in {', '.join(told)}"
