"""What may travel between two islands: one species, an adapter between two, or what one kind gives and the other takes.

Everything that can be known of it is checked before a run starts.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from contextlib import AbstractContextManager
from importlib.metadata import entry_points
from typing import Final, final

from evaluators.plugins import find, guarded
from genome.errors import InputError
from genome.settings import describe
from islands.kinds.protocol import Kind
from islands.kinds.registry import resolve_kind
from islands.kinds.trade import METHODS, gives, needed, needs, takes, variation
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
        with _telling(spec, "needs"):
            return needs(self._kind(spec), spec)

    def needed(self, spec: IslandSpec) -> Mapping[ChannelKind, tuple[str, ...]]:
        """Give the names of what has to come to an island, by the kind of channel that brings it."""
        with _telling(spec, "needed"):
            found = {kind: needed(self._kind(spec), kind, spec) for kind in METHODS}
        return {kind: names for kind, names in found.items() if names}

    def given(self, spec: IslandSpec, kind: ChannelKind) -> str:
        """Give the name of what an island gives to channels of a kind; empty for nothing."""
        with _telling(spec, "gives"):
            return gives(self._kind(spec), kind, spec)

    def check(self, settings: ChannelSettings, edges: Sequence[Edge], redrawn: Redrawn | None, where: str) -> None:
        """Check one channel.

        Raises
        ------
        InputError
            When two islands on it have nothing to exchange, one of them is smaller than what is to travel, or its
            adapter has nothing to translate.
        """
        if settings.adapter is not None:
            find(settings.adapter, f"{where}.adapter", "adapter", ADAPTERS, GROUP)
        pairs = list(self._pairs(edges, redrawn))
        for source, target, channel in pairs:
            if channel.kind == "migrants":
                self._check_species(settings, source, target, where)
            else:
                self._check_trade(channel.kind, source, target, where)
            _check_size(channel, source, target, where)
        if settings.adapter is not None and pairs and all(one.species == other.species for one, other, _ in pairs):
            got = f"islands of '{pairs[0][0].species}' alone, which need none"
            raise InputError(f"{where}.adapter", "islands of different species to adapt between", got, "remove the key")
        self._check_pool(settings, edges, redrawn, where)

    def _pairs(self, edges: Sequence[Edge], redrawn: Redrawn | None) -> Iterator[Pair]:
        """Give the first pair of islands of each two groups that a channel joins."""
        seen: set[tuple[str, str]] = set()
        groups = [spec.group for spec in self._islands]
        for edge in edges:
            if (pair := (groups[edge.source], groups[edge.target])) not in seen:
                seen.add(pair)
                yield self._islands[edge.source], self._islands[edge.target], edge.channel
        if redrawn is not None:
            firsts = {groups[number]: self._islands[number] for number, _ in reversed(redrawn.members)}
            several = Counter(groups[number] for number, _ in redrawn.members)
            for source in firsts.values():
                for target in firsts.values():
                    if source is not target or several[source.group] > 1:
                        yield source, target, redrawn.channel

    def _kind(self, spec: IslandSpec) -> Kind:
        if spec.kind not in self._kinds:
            with _telling(spec):
                self._kinds[spec.kind] = resolve_kind(spec.kind, spec.where("kind"))
        return self._kinds[spec.kind]

    def _check_species(self, settings: ChannelSettings, source: IslandSpec, target: IslandSpec, where: str) -> None:
        kinds = self._kind(source).name, self._kind(target).name
        pair = f"{source.name} ({source.species}) and {target.name} ({target.species})"
        if source.species == target.species:
            if kinds[0] != kinds[1]:
                got = f"{pair} of the kinds '{kinds[0]}' and '{kinds[1]}'"
                raise InputError(where, "islands of one kind in a species", got, "give them different 'species'")
            if keys := self._unlike(source, target):
                got = f"{pair}, whose genomes differ in {_told(keys, source, target)}"
                remedy = f"give them one genome, or different 'species'{_or_adapters(self._suiting(source, target))}"
                raise InputError(where, "islands of one genome in a species", got, remedy)
            return
        if settings.adapter is not None:
            self._check_adapter(settings.adapter, source, target, f"{where}.adapter")
            return
        remedy = "migrants travel within a species"
        if kinds[0] == kinds[1]:
            remedy += ": give both the same "
            remedy += "genome and 'species'" if self._unlike(source, target) else "'species'"
        known = self._suiting(source, target)
        remedy += f", or set adapter: {' or '.join(known)}" if known else ""
        got = f"{pair}, {_difference(source, target, kinds)}"
        raise InputError(where, "islands of one species", got, remedy)

    def _check_adapter(self, name: str, source: IslandSpec, target: IslandSpec, where: str) -> None:
        try:
            _build(name, source, target, where)
        except InputError as error:
            known = self._suiting(source, target)
            remedy = f"these would do: {', '.join(known)}" if known else error.remedy
            raise InputError(error.where, error.expected, error.got, remedy) from None

    def _unlike(self, source: IslandSpec, target: IslandSpec) -> list[str]:
        """Give the genome's keys in which two islands of a kind differ, and may not within a species."""
        with _telling(source, "variation"):
            harmless = variation(self._kind(source))
        return [key for key in _differing(source, target) if key not in harmless]

    def _suiting(self, source: IslandSpec, target: IslandSpec) -> list[str]:
        """Give the names of adapters that would do between two islands; one that is broken would not."""
        found = []
        for name in sorted({*ADAPTERS, *entry_points(group=GROUP).names}):
            try:
                _build(name, source, target, "")
            except InputError:
                continue
            found.append(name)
        return found

    def _check_trade(self, kind: ChannelKind, source: IslandSpec, target: IslandSpec, where: str) -> None:
        given = self.given(source, kind)
        with _telling(target, "takes"):
            taken = takes(self._kind(target), kind, target)
        if given and given in taken:
            return
        ends = f"{source.name} ('{source.kind}'), which gives {given or 'nothing'} to channels of kind {kind}, and "
        ends += f"{target.name} ('{target.kind}'), which takes {' or '.join(taken) or 'nothing'}"
        raise InputError(
            where, f"islands of which one gives {kind} that the other takes", ends, "change 'from' or 'to'"
        )

    def _check_pool(
        self, settings: ChannelSettings, edges: Sequence[Edge], redrawn: Redrawn | None, where: str
    ) -> None:
        """Refuse more pairings than there are partners shown, or ever can be where edges are drawn anew."""
        if settings.kind != "partners" or settings.pairing not in ("several", "random", "mixed"):
            return
        pairings = settings.pairings or 1
        wanted = 1 + pairings // 2 if settings.pairing == "mixed" else pairings
        shown: dict[int, int] = defaultdict(int)
        for edge in edges:
            shown[edge.target] += edge.channel.size(self._islands[edge.source].population)
        if redrawn is not None:
            # What a source showed is held until it shows others: in time each may have shown to each.
            sizes = {number: redrawn.channel.size(self._islands[number].population) for number, _ in redrawn.members}
            shown.update({number: sum(sizes.values()) - size for number, size in sizes.items()})
        for target, count in shown.items():
            if wanted > count:
                expected = f"at most {count}, as many as are shown to {self._islands[target].name}"
                got = str(pairings)
                if settings.pairing == "mixed":
                    got += f", of which {wanted} are with some of those shown"
                raise InputError(f"{where}.pairings", expected, got, "raise 'count'")


def _check_size(channel: Channel, source: IslandSpec, target: IslandSpec, where: str) -> None:
    """Refuse more travellers than a deme has members; migrants need places, too."""
    size, key = channel.size(source.population), "count" if channel.rate is None else "rate"
    for end in (source, target) if channel.kind == "migrants" else (source,):
        if size > end.population:
            what = str(size) if channel.rate is None else f"{channel.rate} of {source.name}, {size}"
            got = f"{what}, more than the {end.population} members of {end.name}"
            raise InputError(f"{where}.{key}", "at most a deme's members", got)


def _telling(spec: IslandSpec, part: str = "") -> AbstractContextManager[None]:
    """Tell whatever an island's kind raises as bad input."""
    what = f"the {part} of {describe(spec.kind)}" if part else describe(spec.kind)
    return guarded(spec.where("kind"), "an island kind", what)


def _build(name: str, source: IslandSpec, target: IslandSpec, where: str) -> None:
    """Build an adapter on trial."""
    with guarded(where, f"an adapter from {source.name} to {target.name}", describe(name)):
        build_adapter(name, source, target, where)


def _or_adapters(known: Sequence[str]) -> str:
    return f" and adapter: {' or '.join(known)}" if known else ""


def _differing(source: IslandSpec, target: IslandSpec) -> list[str]:
    """Give the keys in which the genome sections of two islands differ."""
    keys = dict.fromkeys((*source.genome, *target.genome))
    return [key for key in keys if source.genome.get(key) != target.genome.get(key)]


def _told(keys: Sequence[str], source: IslandSpec, target: IslandSpec) -> str:
    """Give keys of the genome section with both islands' values."""
    ends = (source.genome, target.genome)
    return ", ".join(f"{key} ({', '.join(describe(genome.get(key)) for genome in ends)})" for key in keys)


def _difference(source: IslandSpec, target: IslandSpec, kinds: tuple[str, str]) -> str:
    """Say why two islands are of different species."""
    if kinds[0] != kinds[1]:
        return f"of the kinds '{kinds[0]}' and '{kinds[1]}'"
    keys = _differing(source, target)
    if not keys:
        return "whose genomes are alike: they differ by 'species' alone"
    return f"whose genomes differ in {_told(keys, source, target)}"
