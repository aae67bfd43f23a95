"""Competitive fitness sharing: what a member takes of its partners counts, not how many it does well against.

Each partner that members were paired with is a resource, which those who do well against it divide among themselves:
to be the only one who copes with a partner is worth as much as to cope, with many others, with many partners. So the
deme keeps members for whom there would be no room by their mean alone (Rosin and Belew 1997, "New methods for
competitive coevolution", where outcomes are won or lost and the winners take equal parts).

Outcomes here are fitness values, positive or not. A member's gain from a partner is how far its outcome lies above the
worst of the deme's against that partner, in shares of the way to the best: 0 to 1, so that neither the scale nor the
sign of fitness matters, and one of won and lost is as in the paper. It takes its gain over the sum of all gains, of a
resource of 1, or of as much of it as the share of members who met this partner, where partners are drawn for each.
Where all do alike they take equal parts. An invalid outcome takes nothing, and neither does an invalid member. The
shared fitness is the sum of what a member takes; over all valid members it is at most the number of partners.

Shared fitness says who breeds and who lives on. The log, channels of migrants and partners, and whatever else asks for
the best, go by fitness itself.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, TypeVar

from islands.algorithms.scheme import Scheme
from islands.individual import Individual
from islands.settings import Algorithm

G = TypeVar("G")


def judged(members: Sequence[Individual[G]], settings: Algorithm) -> Sequence[Individual[G]]:
    """Give members with the fitness by which they are selected: shared, where the algorithm says so."""
    return shared(members) if settings.sharing == "competitive" else members


def shared(members: Sequence[Individual[G]]) -> Sequence[Individual[G]]:
    """Give members with their shared fitness in place of their own, in their order.

    They are as they were while none of the valid was scored with partners.
    """
    valid = [place for place, one in enumerate(members) if one.fitness is not None]
    met: dict[str, list[tuple[int, float | None]]] = {}
    for place in valid:
        for partners, outcome in members[place].outcomes:
            met.setdefault(partners, []).append((place, outcome))
    if not met:
        return members
    taken: dict[int, list[float]] = {place: [] for place in valid}
    for outcomes in met.values():
        for place, part in _divided([(place, value) for place, value in outcomes if value is not None]):
            taken[place].append(part * len(outcomes) / len(valid))
    # Summed exactly, so that no order of partners or members matters.
    return [
        replace(one, fitness=math.fsum(taken[place])) if place in taken else one for place, one in enumerate(members)
    ]


def _divided(outcomes: Sequence[tuple[int, float]]) -> list[tuple[int, float]]:
    """Divide a resource of 1 among those with valid outcomes."""
    if not outcomes:
        return []
    # Halved, so that no difference of two finite values is infinite.
    halves = [value / 2 for _, value in outcomes]
    floor, span = min(halves), max(halves) - min(halves)
    gains = [(half - floor) / span if span > 0 else 1.0 for half in halves]
    whole = math.fsum(gains)
    return [(place, gain / whole) for (place, _), gain in zip(outcomes, gains, strict=True)]


def survivors(
    scheme: Scheme,
    settings: Algorithm,
    population: int,
    order: Sequence[Individual[Any]],
    children: Sequence[Individual[Any]],
    promoted: Sequence[int] = (),
) -> tuple[Individual[Any], ...]:
    """Give the next deme, as :meth:`~islands.algorithms.scheme.Scheme.survivors` does.

    Where fitness is shared, parents and offspring divide the partners among them all, and survive by that; ``order``
    is the one in which they bred. Whoever lives on does so with its own fitness.
    """
    if settings.sharing == "none":
        return scheme.survivors(settings, population, order, children, promoted)
    everyone = judged((*order, *children), settings)
    old, young = everyone[: len(order)], everyone[len(order) :]
    own = {one.id: one for one in (*order, *children)}
    return tuple(own[one.id] for one in scheme.survivors(settings, population, old, young, promoted))
