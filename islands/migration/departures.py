"""What leaves an island at an epoch's end: a packet for each of its edges, empty where nothing travels."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final, NamedTuple, final

from genome.mishaps import let_pass, told
from islands.individual import Individual
from islands.kinds.protocol import Biology, Offering
from islands.migration.channel import Channel, Edge, Migrant, Packet
from islands.migration.emigrants import Crowd, emigrants
from islands.migration.triggers import pulled
from islands.selection import ranked
from islands.steered import UNSTEERED, Steered
from islands.streams import EpochStreams, Purpose

Bundle = tuple[Channel, tuple[Edge, ...]]


def bundled(edges: Sequence[Edge]) -> tuple[Bundle, ...]:
    """Put an island's outgoing edges together by channel."""
    found: dict[int, list[Edge]] = {}
    for edge in edges:
        found.setdefault(edge.channel.number, []).append(edge)
    return tuple((together[0].channel, tuple(together)) for together in found.values())


class Standing(NamedTuple):
    """How an island stands at an epoch's end, as far as its channels' conditions ask.

    Attributes
    ----------
    epoch
        The one that ends.
    stagnant, diversity
        As :func:`islands.migration.triggers.pulled` takes them.
    scoring
        The context in which its members were scored.
    """

    epoch: int
    stagnant: int
    diversity: float | None
    scoring: str


@final
class Departures:
    """Makes the packets of one epoch's end.

    On a ``broadcast`` of copies the emigrants are chosen once and go the way of each edge that carries; those that move
    are chosen edge by edge from who is left. Channels with a higher number choose from who is left after them, and send
    fewer than their count where there are no more. The valid members alone are offered as components or surroundings:
    what cannot stand can be no part of something else. What a kind fails to offer is left out, with a note.

    Parameters
    ----------
    deme
        The members.
    biology
        Writes them down.
    standing
        See :class:`Standing`.
    streams
        EMIGRANTS and ROUTING, by channel, draw.
    steered
        Says which members are promoted, and rank first, or locked, and never move away.

    Attributes
    ----------
    gone
        Ids of those who moved.
    mishaps
        What could not be offered: ids, and why.
    """

    __slots__ = ("_biology", "_crowd", "_deme", "_standing", "_steered", "_streams", "_texts", "gone", "mishaps")

    def __init__(
        self,
        deme: Sequence[Individual[Any]],
        biology: Biology[Any],
        standing: Standing,
        streams: EpochStreams,
        steered: Steered = UNSTEERED,
    ) -> None:
        self._deme: Final = deme
        self._crowd: Crowd | None = None
        self._biology: Final = biology
        self._standing: Final = standing
        self._streams: Final = streams
        self._steered: Final = steered
        self._texts: Final[dict[tuple[str, int], str | None]] = {}
        self.gone: Final[set[int]] = set()
        self.mishaps: Final[list[tuple[int, str]]] = []

    def packets(self, bundles: Sequence[Bundle]) -> tuple[Packet, ...]:
        """Give a packet for each edge, by channel."""
        found: list[Packet] = []
        epoch, scoring = self._standing.epoch, self._standing.scoring
        for channel, edges in bundles:
            full: Sequence[bool] = ()
            copies: tuple[Migrant, ...] = ()
            if channel.carries(epoch) and pulled(channel.trigger, self._standing.stagnant, self._standing.diversity):
                full = self._carrying(channel, edges)
                if not channel.move and True in full:
                    copies = self._chosen(channel)
            for place, edge in enumerate(edges):
                migrants: tuple[Migrant, ...] = ()
                if full and full[place]:
                    migrants = self._chosen(channel) if channel.move else copies
                found.append(Packet(channel.number, edge.source, edge.target, epoch, scoring, migrants))
        return tuple(found)

    def _carrying(self, channel: Channel, edges: Sequence[Edge]) -> list[bool]:
        """Tell which edges of a channel carry: all or, point to point, one drawn; each by its weight."""
        drawn = -1
        if channel.routing == "point":
            rng = self._streams(Purpose.ROUTING, channel.number) if len(edges) > 1 else None
            drawn = 0 if rng is None else int(rng.integers(0, len(edges)))
        full = []
        for place, edge in enumerate(edges):
            carries = drawn in (-1, place)
            if carries and edge.weight < 1:
                carries = float(self._streams(Purpose.ROUTING, channel.number).random()) < edge.weight
            full.append(carries)
        return full

    def _chosen(self, channel: Channel) -> tuple[Migrant, ...]:
        if self._crowd is None:
            promoted = self._steered.promoted
            self._crowd = Crowd(ranked(self._deme, promoted), self._biology, promoted=promoted)
        crowd = self._crowd
        if channel.kind in ("components", "surroundings"):
            invalid = [place for place, one in enumerate(crowd.order) if one.fitness is None]
            if invalid:
                crowd = crowd.without(invalid)
        if channel.move and self._steered.locked:
            crowd = crowd.without([place for place, one in enumerate(crowd.order) if one.id in self._steered.locked])
        places = emigrants(crowd, channel.size(len(self._deme)), channel, self._streams)
        chosen = [crowd.order[place] for place in places]
        if channel.move:
            gone = {one.id for one in chosen}
            self.gone.update(gone)
            self._crowd = self._crowd.without([place for place, one in enumerate(self._crowd.order) if one.id in gone])
        return tuple(
            Migrant(one.id, text, one.fitness, one.scores, one.error)
            for one in chosen
            if (text := self._text(one, channel)) is not None
        )

    def _text(self, member: Individual[Any], channel: Channel) -> str | None:
        """Give what travels for a member on a channel; ``None`` where its kind could not make it."""
        kind = channel.kind
        key = (kind, member.id)
        if key not in self._texts:
            biology: object = self._biology
            if kind == "migrants" or not isinstance(biology, Offering):
                self._texts[key] = self._biology.encode(member.genotype)
            else:
                try:
                    self._texts[key] = biology.offer(member.genotype, kind)
                except BaseException as error:  # noqa: BLE001 - whatever a plug-in raises must not end the run
                    let_pass(error)
                    self.mishaps.append((member.id, f"{kind}: {told(error)}"))
                    self._texts[key] = None
        return self._texts[key]
