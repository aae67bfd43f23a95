"""Doors where wanted adjacencies are met, and the front door towards the street: where in the wall, and how they open.

Of all places in the walls between two rooms, with hinges at either end and the leaf in either room, the one is taken
whose leaf keeps free of walls and of other leaves, opens into the room that lies farther from the front door, and
stands, when open, before a wall that meets the door's at the hinges.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from evaluators.plans.drawings.drawing import OUTSIDE, Opening, Point, Ring, Wall, leaf_of
from evaluators.plans.drawings.inside import inside
from evaluators.plans.layout import COMPASS, TOWARDS, Layout
from evaluators.plans.ways import through_doors

Floats = NDArray[np.float64]

WIDTH: Final = 0.9
FRONT: Final = 1.0
"""Of openings, in metres, where the walls are long enough."""
LEAST: Final = 0.75
LEAST_FRONT: Final = 0.9
"""What is narrower is taken where nothing else is to be had."""
JAMB: Final = 0.03
"""Between an opening and the end of a wall's face, as a share of a cell's edge, and in metres at most twice as much."""
ROUND: Final = 0.01
"""Widths are whole centimetres."""

_SWEEP: Final = np.array(list(itertools.product(np.linspace(0.25, 0.97, 4), np.linspace(0.1, math.pi / 2 - 0.06, 6))))


def doors(layout: Layout, walls: Sequence[Wall], floors: Sequence[Ring]) -> list[Opening]:
    """Place the front door and those between rooms.

    Parameters
    ----------
    layout
        What is adjacent, and where the street is.
    walls
        Of the plan, in metres.
    floors
        What is free of walls, by room.

    Returns
    -------
    list of Opening
        The front door first where the brief names an entrance, then one for each of ``layout.doors``, in their order.
    """
    unit = layout.brief.unit
    ranks = _ranks(layout)
    swept: list[Floats] = []
    found: list[Opening] = []
    own = _front_walls(layout, walls)
    if own:
        options = [one for k in own for one in _options(k, walls[k], FRONT, unit, front=True)]
        found.append(_best(options, walls, floors, swept, ranks))
    for first, second in layout.doors:
        own = [k for k, wall in enumerate(walls) if set(wall.rooms) == {first, second}]
        options = [one for k in own for one in _options(k, walls[k], WIDTH, unit)]
        found.append(_best(options, walls, floors, swept, ranks))
    return found


def _front_walls(layout: Layout, walls: Sequence[Wall]) -> list[int]:
    """Give the outer walls of the entrance that face the street, all of them where none does."""
    entrance, street = layout.brief.entrance, layout.brief.site.street
    if entrance is None:
        return []
    room = list(layout.brief.rooms).index(entrance)
    own = [k for k, wall in enumerate(walls) if wall.outer and wall.rooms[0] == room]
    return own if street is None else [k for k in own if faces(walls[k], COMPASS[street])] or own


def _ranks(layout: Layout) -> list[tuple[bool, int]]:
    """Rank rooms: a door opens into the private one of two, else into the one that is more doors from the entrance."""
    private = [wish.private for wish in layout.brief.rooms.values()]
    return list(zip(private, _depths(layout), strict=True))


def jamb(unit: float) -> float:
    """Give the least distance of an opening from where a wall's face ends, in metres."""
    return JAMB * min(unit, 2.0)


def _options(number: int, wall: Wall, most: float, unit: float, *, front: bool = False) -> Iterator[Opening]:
    low, high = wall.clear[0] + jamb(unit), wall.clear[1] - jamb(unit)
    width = max(min(most, math.floor((high - low) / ROUND + 1e-6) * ROUND), (high - low) / 2)
    sides = [room for room in wall.rooms if room != OUTSIDE]
    starts = dict.fromkeys((low, high - width, (low + high - width) / 2))
    for start, into, hinge_last in itertools.product(starts, sides, (False, True)):
        yield Opening("door", number, start, width, into, hinge_last, front)


def _best(
    options: Sequence[Opening],
    walls: Sequence[Wall],
    floors: Sequence[Ring],
    swept: list[Floats],
    ranks: Sequence[tuple[bool, int]],
) -> Opening:
    """Choose a door, the first of the best; what its leaf sweeps joins the others' sweeps."""
    sweeps = [sweep(walls[one.wall], one) for one in options]

    def cost(place: int) -> float:
        one, points = options[place], sweeps[place]
        blocked = 1.0 - float(inside(points, floors[one.into]).mean())
        apart = [float(np.hypot(*(points[:, None] - other[None]).transpose(2, 0, 1)).min()) for other in swept]
        crowded = sum(far < one.width / 6 for far in apart)
        leaf = leaf_of(walls[one.wall], one)
        behind = np.array([_beyond(leaf.jamb, leaf.hinge, 0.2 * one.width)])
        free = bool(inside(behind + 0.1 * (np.array(leaf.tip) - np.array(leaf.hinge)), floors[one.into])[0])
        backward = any(ranks[room] > ranks[one.into] for room in walls[one.wall].rooms if room != OUTSIDE)
        narrow = max(0.0, (LEAST_FRONT if one.front else LEAST) - one.width)
        return 100.0 * blocked + 20.0 * crowded + 40.0 * narrow + 3.0 * backward + 1.5 * free

    best = min(range(len(options)), key=lambda place: (round(cost(place), 6), place))
    swept.append(sweeps[best])
    return options[best]


def sweep(wall: Wall, door: Opening) -> Floats:
    """Give points (n, 2) that a door's leaf passes over."""
    hinge, tip, shut = (np.array(point) for point in leaf_of(wall, door))
    far, angle = _SWEEP[:, :1], _SWEEP[:, 1:]
    return np.asarray(hinge + far * (np.cos(angle) * (shut - hinge) + np.sin(angle) * (tip - hinge)))


def _beyond(first: Point, last: Point, far: float) -> tuple[float, float]:
    """Give the point that lies so far beyond the last of two."""
    length = math.dist(first, last)
    return last[0] + far * (last[0] - first[0]) / length, last[1] + far * (last[1] - first[1]) / length


def faces(wall: Wall, way: Point) -> bool:
    """Tell whether an outer wall's outer side faces a direction; the room is left of it."""
    dx, dy = wall.along
    return dy * way[0] - dx * way[1] > TOWARDS


def _depths(layout: Layout) -> list[int]:
    """Give how many doors each room is from the entrance; from the room with most doors without one."""
    count = layout.plan.count
    ways = through_doors(layout)
    entrance = layout.brief.entrance
    start = (
        max(range(count), key=lambda k: len(ways[k])) if entrance is None else list(layout.brief.rooms).index(entrance)
    )
    far = [count] * count
    far[start], todo = 0, [start]
    for room in todo:
        for other in ways[room]:
            if far[other] == count:
                far[other] = far[room] + 1
                todo.append(other)
    return far
