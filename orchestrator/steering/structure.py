"""Which islands and channels a run has, epoch by epoch: as the experiment has them, and as steering changes that.

Numbers never change: what is added comes after all there ever were, and what is removed keeps its number, and its name,
for good. So the islands' streams, the ids of individuals and the order in which packets are taken in stay as they are.

What is added is there from its epoch on: an island begins in it, an edge carries at its end. What is removed is there
for the last time in the epoch before; what its edges sent at the end of that is still taken in. Topologies are laid out
once, on the islands there are then: one that is added later is on no channel until it is connected, and one that is
removed leaves a gap.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

from islands.migration.channel import Edge
from islands.migration.routes import Redrawn
from islands.spec import IslandSpec
from orchestrator.compatibility import Compatibility
from orchestrator.loading import Loaded
from orchestrator.plan import Plan, islands_of
from orchestrator.wiring import Wired, wired_channels

Span = tuple[int, int | None]
"""The first epoch, and the first one no more."""

ALWAYS: Span = (0, None)


@dataclass(frozen=True, slots=True)
class Structure:
    """See the module's docstring.

    Attributes
    ----------
    loaded
        The experiment with all groups and all channels that there ever were.
    groups
        Of groups that were added, the first epoch.
    removed
        Of islands that were removed, by name, the first epoch without them.
    channels
        Spans of the channels that were added or removed, by number.
    """

    loaded: Loaded
    groups: Mapping[str, int] = field(default_factory=dict)
    removed: Mapping[str, int] = field(default_factory=dict)
    channels: Mapping[int, Span] = field(default_factory=dict)

    def islands(self) -> tuple[IslandSpec, ...]:
        """Give all islands that there ever were, in the order of their numbers, each with its span."""
        return tuple(
            replace(spec, since=self.groups.get(spec.group, 0), until=self.removed.get(spec.name))
            for spec in islands_of(self.loaded)
        )

    def living(self, epoch: int) -> tuple[IslandSpec, ...]:
        """Give the islands that step in an epoch."""
        return tuple(spec for spec in self.islands() if spec.is_there(epoch))

    def channel_names(self, epoch: int) -> dict[str, int]:
        """Give names and numbers of the channels that are there at the end of an epoch."""
        found = {}
        for number, settings in enumerate(self.loaded.experiment.channels):
            since, until = self.channels.get(number, ALWAYS)
            if since <= epoch and (until is None or epoch < until):
                found[settings.name or f"{settings.kind}-{number}"] = number
        return found

    def wired(self, islands: tuple[IslandSpec, ...], fits: Compatibility) -> tuple[Wired, ...]:
        """Wire all channels that there ever were, each for its span.

        Raises
        ------
        InputError
            As :func:`orchestrator.wiring.wired_channels`.
        """
        loaded = self.loaded
        found = wired_channels(loaded.experiment, islands, loaded.source, loaded.base, fits)
        return tuple(
            replace(one, edges=tuple(_spanned(one.edges, islands, self.channels.get(one.channel.number, ALWAYS))))
            for one in found
        )

    def wired_at(self, epoch: int, islands: tuple[IslandSpec, ...], fits: Compatibility) -> list[Wired]:
        """Wire all channels, with the edges alone that are there at an epoch's end."""
        found = []
        for one in self.wired(islands, fits):
            redrawn = None
            if one.redrawn is not None:
                parts = parts_of(one.redrawn, islands, self.channels.get(one.channel.number, ALWAYS))
                redrawn = next((part for part in parts if part.is_there(epoch)), None)
            edges = tuple(edge for edge in one.edges if edge.is_there(epoch))
            found.append(replace(one, edges=edges, redrawn=redrawn))
        return found

    def plan(self) -> Plan:
        """Give islands and edges for all epochs.

        Raises
        ------
        InputError
            As :meth:`wired`.
        """
        islands = self.islands()
        wired = self.wired(islands, Compatibility(islands))
        redrawn = [
            part
            for one in wired
            if one.redrawn is not None
            for part in parts_of(one.redrawn, islands, self.channels.get(one.channel.number, ALWAYS))
        ]
        return Plan(islands, tuple(edge for one in wired for edge in one.edges), tuple(redrawn))


def structure_of(loaded: Loaded) -> Structure:
    """Give the structure that an experiment begins with.

    Channels among all islands come to name their groups: they stay among those.
    """
    groups = list(loaded.experiment.islands)
    channels = [
        one.model_copy(update={"among": groups}) if one.topology is not None and one.among is None else one
        for one in loaded.experiment.channels
    ]
    experiment = loaded.experiment.model_copy(update={"channels": channels})
    return Structure(replace(loaded, experiment=experiment))


def meeting(*spans: Span) -> Span | None:
    """Give the span that several have in common; ``None`` where there is none."""
    since = max(since for since, _ in spans)
    until = min((until for _, until in spans if until is not None), default=None)
    return None if until is not None and until <= since else (since, until)


def _spanned(edges: Iterable[Edge], islands: tuple[IslandSpec, ...], channel: Span) -> Iterable[Edge]:
    """Give edges with the spans in which they and both of their islands are there; those that never are, not at all."""
    spans = [(spec.since, spec.until) for spec in islands]
    for edge in edges:
        span = meeting(channel, spans[edge.source], spans[edge.target])
        if span == ALWAYS:
            yield edge
        elif span is not None:
            yield replace(edge, since=span[0], until=span[1])


def parts_of(redrawn: Redrawn, islands: tuple[IslandSpec, ...], channel: Span) -> tuple[Redrawn, ...]:
    """Part a channel whose edges are drawn anew at the epochs in which one of its members is removed."""
    first = channel[0]
    gone = {islands[number].until for number, _ in redrawn.members}
    marks: list[Any] = [first, *sorted(mark for mark in gone if mark is not None and mark > first), None]
    found = []
    for since, until in pairwise(marks):
        span = meeting(channel, (since, until))
        here = [place for place, (number, _) in enumerate(redrawn.members) if islands[number].is_there(since)]
        if span is not None and len(here) > 1:
            found.append(
                replace(
                    redrawn,
                    members=tuple(redrawn.members[place] for place in here),
                    species=tuple(redrawn.species[place] for place in here) if redrawn.species else (),
                    degree=min(redrawn.degree, len(here) - 1),
                    since=span[0],
                    until=span[1],
                )
            )
    return tuple(found)
