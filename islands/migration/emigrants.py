"""Choosing who emigrates. Each chooser takes a ranked deme and gives so many distinct members, by their places."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final, final

import numpy as np
from numpy.typing import NDArray

from islands.individual import Individual
from islands.kinds.protocol import Apart, Biology
from islands.migration.channel import Channel
from islands.migration.medoids import medoids
from islands.streams import EpochStreams, Purpose

ALIKE: Final = 1e-9
"""Distances that differ by a smaller share are equal."""

MOST_SPREAD: Final = 200
"""Members whose distances are looked at for medoids."""


@final
class Crowd:
    """A ranked deme to choose from, and how far its members are apart, which is worked out once and when asked for.

    Parameters
    ----------
    order
        The members, best first.
    biology
        Tells how different two are.
    promoted
        Ids of those who stand at the head whatever their fitness.
    """

    __slots__ = ("_apart", "_biology", "order", "promoted")

    def __init__(
        self,
        order: Sequence[Individual[Any]],
        biology: Biology[Any],
        apart: NDArray[np.float64] | None = None,
        promoted: Sequence[int] = (),
    ) -> None:
        self.order: Final = order
        self._biology: Final = biology
        self._apart = apart
        self.promoted: Final = promoted

    def __len__(self) -> int:
        return len(self.order)

    def worth(self) -> list[float]:
        """Give the fitness of the valid, from the highest down; one who is promoted is worth as much as the best."""
        fitness = [one.fitness for one in self.order if one.fitness is not None]
        if not self.promoted or not fitness:
            return fitness
        best = max(fitness)
        known = [best if one.id in self.promoted else one.fitness for one in self.order]
        return [value for value in known if value is not None]

    def apart(self) -> NDArray[np.float64]:
        """Give the distances of all members from all, (n, n), 0 where the kind tells none that is a number."""
        if self._apart is None and isinstance(self._biology, Apart):
            self._apart = self._biology.distances([one.genotype for one in self.order])
        if self._apart is None:
            size = len(self.order)
            self._apart = np.zeros((size, size))
            for place, one in enumerate(self.order):
                for before in range(place):
                    found = self._biology.diversity((self.order[before].genotype, one.genotype))
                    known = found is not None and math.isfinite(found)
                    self._apart[place, before] = self._apart[before, place] = found if known else 0.0
        return self._apart

    def without(self, places: Sequence[int]) -> Crowd:
        """Give the crowd once the members at these places have left."""
        gone = set(places)
        left = [place for place in range(len(self.order)) if place not in gone]
        apart = None if self._apart is None else self._apart[np.ix_(left, left)]
        return Crowd([self.order[place] for place in left], self._biology, apart, self.promoted)


Choose = Callable[[Crowd, int, Channel, EpochStreams], list[int]]
"""From a crowd, how many (at most all of them), the channel and the streams to distinct places, ascending."""


def best(crowd: Crowd, count: int, channel: Channel, streams: EpochStreams) -> list[int]:
    """Choose the best."""
    del crowd, channel, streams
    return list(range(count))


def random(crowd: Crowd, count: int, channel: Channel, streams: EpochStreams) -> list[int]:
    """Choose at random, each set of members as likely."""
    rng = streams(Purpose.EMIGRANTS, channel.number)
    return sorted(rng.choice(len(crowd), size=count, replace=False).tolist())


def tournament(crowd: Crowd, count: int, channel: Channel, streams: EpochStreams) -> list[int]:
    """Hold one tournament after the other among those not chosen yet, its entrants drawn with replacement."""
    rng = streams(Purpose.EMIGRANTS, channel.number)
    left = list(range(len(crowd)))
    chosen = []
    for _ in range(count):
        entrants = rng.integers(0, len(left), size=channel.tournament)
        chosen.append(left.pop(int(entrants.min())))
    return sorted(chosen)


def roulette(crowd: Crowd, count: int, channel: Channel, streams: EpochStreams) -> list[int]:
    """Draw one after the other of those not drawn yet, each as likely as its weight says.

    A member weighs what its fitness is above the worst valid one's; the worst and the invalid weigh nothing. Where
    nothing has weight any more, all being alike or those with weight being drawn, the rest are as likely as each other:
    first the valid among them, then the invalid.
    """
    rng = streams(Purpose.EMIGRANTS, channel.number)
    # Halved, so that no difference of two finite values is infinite.
    halves = [value / 2 for value in crowd.worth()]
    span = halves[0] - halves[-1] if halves else 0.0
    weights = [(half - halves[-1]) / span for half in halves] if span > 0 else []
    weighty, valid, size = sum(weight > 0 for weight in weights), len(halves), len(crowd)
    weights = weights[:weighty]
    left = list(range(weighty))
    chosen: list[int] = []
    while left and len(chosen) < count:
        sums = np.cumsum(weights)
        at = min(int(np.searchsorted(sums, rng.random() * sums[-1], side="right")), len(left) - 1)
        chosen.append(left.pop(at))
        weights.pop(at)
    for low, high in ((weighty, valid), (valid, size)):
        wanted = min(count - len(chosen), high - low)
        if wanted:
            chosen += [low + place for place in rng.choice(high - low, size=wanted, replace=False).tolist()]
    return sorted(chosen)


def diverse(crowd: Crowd, count: int, channel: Channel, streams: EpochStreams) -> list[int]:
    """Choose those who are most different.

    First the member of the greatest mean distance from all; then, one by one, the one whose nearest of those chosen is
    farthest away (Gonzalez 1985); of equals the better. Distances are what the kind calls the diversity of two; those
    within a billionth of the greatest one are equal to it.
    """
    del channel, streams
    if count == 0:
        return []
    apart = crowd.apart()
    chosen = [_farthest(apart.mean(axis=1))]
    nearest = apart[chosen[0]].copy()
    while len(chosen) < count:
        nearest[chosen[-1]] = -1.0
        chosen.append(_farthest(nearest))
        np.minimum(nearest, apart[chosen[-1]], out=nearest)
    return sorted(chosen)


def spread(crowd: Crowd, count: int, channel: Channel, streams: EpochStreams) -> list[int]:
    """Choose those who stand for all: medoids of the valid members (:mod:`islands.migration.medoids`).

    Those who are promoted come first whatever they stand for: they are a person's choice. Of a deme of more than
    :data:`MOST_SPREAD` valid members only so many, the best, are looked at. Where there are fewer valid members than
    are to travel the invalid fill up.
    """
    del channel, streams
    size = sum(one.fitness is not None for one in crowd.order)
    chosen = [place for place, one in enumerate(crowd.order) if one.id in crowd.promoted][:count]
    looked_at = [place for place in range(min(size, MOST_SPREAD)) if place not in chosen]
    wanted = min(count - len(chosen), len(looked_at))
    near = crowd.apart()[np.ix_(looked_at, looked_at)]
    chosen += [looked_at[place] for place in medoids(near, wanted)]
    rest = [place for place in range(len(crowd)) if place not in chosen]
    return sorted(chosen + rest[: count - len(chosen)])


def _farthest(distances: NDArray[np.float64]) -> int:
    """Give the first place of the greatest distance: sums of equal terms in another order are a few bits apart."""
    greatest = float(distances.max())
    return int((distances >= greatest - ALIKE * abs(greatest)).argmax())


CHOOSERS: Final[Mapping[str, Choose]] = {
    "best": best,
    "tournament": tournament,
    "random": random,
    "roulette": roulette,
    "diverse": diverse,
    "spread": spread,
}


def emigrants(crowd: Crowd, count: int, channel: Channel, streams: EpochStreams) -> list[int]:
    """Choose distinct members of a crowd, by their places, the best of them first; all where there are no more.

    Parameters
    ----------
    crowd
        The deme.
    count
        How many travel.
    channel
        Says how they are chosen.
    streams
        EMIGRANTS, by channel, draws.
    """
    return CHOOSERS[channel.select](crowd, min(count, len(crowd)), channel, streams)
