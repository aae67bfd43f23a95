"""Scoring a member together with partners: who is chosen of those shown, and what the pairings make together.

A member is scored by as many pairings as the channel with the most chosen partners has; where a channel has fewer, its
partners come round again. What the pairings make together is the matter of the first channel of partners.
Schemes after Panait, Luke and Wiegand 2006, "Biasing coevolutionary search for optimal multiagent behaviors"; the
archive (their hall of fame) after Rosin and Belew 1997, "New methods for competitive coevolution".
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable, Sequence
from typing import Any, Final, NamedTuple, TypeVar

from islands.holdings import Holdings, pool
from islands.individual import Evaluation, Outcomes
from islands.kinds.protocol import Symbiotic
from islands.migration.channel import Channel, Migrant, Pairing
from islands.scoring import scored_with
from islands.streams import EpochStreams, Purpose

G = TypeVar("G")
USUAL = Pairing()
_HASHED: Final = 16
"""Hexadecimal digits of the hash of what a partner shows that stand in its name."""


class Side(NamedTuple):
    """The partners of one channel in one epoch.

    Attributes
    ----------
    channel
        Its number.
    partners
        Those that every member is paired with, or that they are drawn from, best first.
    drawn
        How many are drawn for each member; 0 where all are paired with all partners.
    names
        Of the partners: their ids, and a hash of what they show, which may change while the id stays.
    """

    channel: int
    partners: tuple[Migrant, ...]
    drawn: int
    names: tuple[str, ...] = ()


class Scored(NamedTuple):
    """What a genotype was scored with, and what came of it.

    Attributes
    ----------
    evaluation
        All in all.
    partners
        Ids of the partners, pairing by pairing; empty for one that was scored alone.
    outcomes
        Fitness of each pairing; empty as above.
    """

    evaluation: Evaluation
    partners: tuple[int, ...] = ()
    outcomes: Outcomes = ()


class Sides(NamedTuple):
    """The partners of all channels in one epoch.

    Attributes
    ----------
    sides
        By channel.
    pairing
        Of the first channel: how the pairings' scores become one.
    key
        Equal where members are paired alike: with the same ones, as they are shown now. What one shows may change while
        its id stays, as when it hangs on what surrounds it.
    """

    sides: tuple[Side, ...]
    pairing: Pairing
    key: str

    @property
    def foremost(self) -> tuple[Migrant, ...]:
        """Give one partner of each channel: those of a member's first pairing, or where some are drawn the best."""
        return tuple(side.partners[0] for side in self.sides)


def sides_of(channels: Sequence[Channel], holdings: Holdings, streams: EpochStreams) -> Sides | None:
    """Give the partners that members are paired with in this epoch; ``None`` until each channel has shown someone.

    Parameters
    ----------
    channels
        All channels of partners that reach the island, by number.
    holdings
        What it holds.
    streams
        PARTNERS, by channel, draws from an archive.
    """
    sides = []
    for channel in channels:
        shown = pool(holdings, channel.number)
        if not shown:
            return None
        sides.append(_side(channel, shown, holdings, streams))
    if not sides:
        return None
    first = channels[0].pairing or USUAL
    meaning: list[Any] = [first.score]
    for place, (channel, side) in enumerate(zip(channels, sides, strict=True)):
        # Who is drawn does not hang on the order of those drawn from.
        who = [(one.id, hashlib.sha256(one.text.encode(errors="surrogatepass")).hexdigest()) for one in side.partners]
        meaning.append(
            [channel.number, (channel.pairing or USUAL).scheme, side.drawn, sorted(who) if side.drawn else who]
        )
        sides[place] = side._replace(names=tuple(f"{identity}:{shown[:_HASHED]}" for identity, shown in who))
    return Sides(tuple(sides), first, hashlib.sha256(json.dumps(meaning).encode()).hexdigest())


def _side(channel: Channel, shown: tuple[Migrant, ...], holdings: Holdings, streams: EpochStreams) -> Side:
    pairing = channel.pairing or USUAL
    if pairing.scheme == "random":
        return Side(channel.number, shown, min(pairing.count, len(shown)))
    if pairing.scheme == "several":
        return Side(channel.number, shown[: pairing.count], 0)
    if pairing.scheme == "best":
        return Side(channel.number, shown[:1], 0)
    others: tuple[Migrant, ...] = ()
    past, wanted = past_ones(channel, holdings, shown[:1]), pairing.count - 1
    if pairing.scheme == "mixed":
        # One who is shown now is no past one, so that nobody is met twice.
        past = past_ones(channel, holdings, shown)
        young = min(len(shown) - 1, wanted - min(wanted // 2, len(past)))
        others, wanted = _drawn(shown[1:], young, channel, streams), wanted - young
    return Side(channel.number, (shown[0], *others, *_drawn(past, wanted, channel, streams)), 0)


def past_ones(channel: Channel, holdings: Holdings, but: Sequence[Migrant]) -> tuple[Migrant, ...]:
    """Give the past representatives that a channel's archive holds, the newest first: all but some, as they are now."""
    past = [one for old in holdings.archives if old.channel == channel.number for one in old.travellers]
    here = {(one.id, one.text) for one in but}
    return tuple(one for one in past if (one.id, one.text) not in here)[: (channel.pairing or USUAL).archive]


def _drawn(among: tuple[Migrant, ...], count: int, channel: Channel, streams: EpochStreams) -> tuple[Migrant, ...]:
    """Draw some, in their order; all where there are no more, without a draw."""
    if count >= len(among) or count == 0:
        return among[:count]
    places = streams(Purpose.PARTNERS, channel.number).choice(len(among), size=count, replace=False)
    return tuple(among[place] for place in sorted(places.tolist()))


def scored_in_pairs(
    biology: Symbiotic[G], genotype: G, company: Sides, streams: EpochStreams, pulse: Callable[[], None]
) -> Scored:
    """Score a genotype by all of its pairings."""
    chosen = [_chosen(side, streams) for side in company.sides]
    found: list[Evaluation] = []
    ids: list[int] = []
    outcomes: list[tuple[str, float | None]] = []
    for pairing in range(max(len(places) for places in chosen)):
        places = [choice[pairing % len(choice)] for choice in chosen]
        together = tuple(side.partners[place] for side, place in zip(company.sides, places, strict=True))
        pulse()
        found.append(scored_with(biology, genotype, together))
        ids.extend(one.id for one in together)
        named = " ".join(side.names[place] for side, place in zip(company.sides, places, strict=True))
        outcomes.append((named, found[-1].fitness))
    return Scored(combined(found, company.pairing), tuple(ids), tuple(outcomes))


def _chosen(side: Side, streams: EpochStreams) -> Sequence[int]:
    """Give the places of the partners of one member."""
    if not side.drawn or len(side.partners) == 1:
        return range(len(side.partners))
    rng = streams(Purpose.PARTNERS, side.channel)
    return sorted(rng.choice(len(side.partners), size=side.drawn, replace=False).tolist())


def combined(found: Sequence[Evaluation], pairing: Pairing) -> Evaluation:
    """Make one evaluation of those of an individual's pairings.

    ``mean``: fitness and each score are means over the valid pairings. ``best`` and ``worst``: those of the pairing
    with the highest or the lowest fitness, of equals the first. The whole is invalid when no pairing is valid, with
    ``worst`` already when one is not; scores and error are then those of the first invalid pairing. Times add up.
    """
    if len(found) == 1:
        return found[0]
    growth, evaluation = (math.fsum(one.growth_ms for one in found), math.fsum(one.evaluation_ms for one in found))
    notes = tuple(note for one in found for note in one.notes)
    valid = [(one.fitness, one) for one in found if one.fitness is not None]
    if not valid or (pairing.score == "worst" and len(valid) < len(found)):
        first = next(one for one in found if one.fitness is None)
        return Evaluation(None, first.scores, first.error, growth, evaluation, notes)
    if pairing.score == "mean":
        fitness = math.fsum(value for value, _ in valid) / len(valid)
        return Evaluation(fitness, _means([one for _, one in valid]), "", growth, evaluation, notes)
    choose = max if pairing.score == "best" else min
    fitness, one = choose(valid, key=lambda pair: pair[0])
    return Evaluation(fitness, one.scores, "", growth, evaluation, notes)


def _means(found: Sequence[Evaluation]) -> tuple[tuple[str, float], ...]:
    values: dict[str, list[float]] = {}
    for one in found:
        for name, value in one.scores:
            values.setdefault(name, []).append(value)
    return tuple((name, math.fsum(values[name]) / len(values[name])) for name in sorted(values))
