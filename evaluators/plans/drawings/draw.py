"""From a layout to its drawing."""

from __future__ import annotations

import numpy as np

from evaluators.plans.drawings.dimensions import dimensions
from evaluators.plans.drawings.doors import doors, sweep
from evaluators.plans.drawings.drawing import OUTSIDE, Drawing, DrawnRoom, Ground, Point, Ring
from evaluators.plans.drawings.edges import Corner, sides
from evaluators.plans.drawings.inside import label
from evaluators.plans.drawings.walls import faces, floor, straightened, walls
from evaluators.plans.drawings.windows import windows
from evaluators.plans.layout import Layout
from genome.errors import InputError


def drawing(layout: Layout, title: str) -> Drawing:
    """Draw a plan, where it lies on its site.

    Parameters
    ----------
    layout
        A plan of a tiling of the plane, and its brief.
    title
        What it is.

    Raises
    ------
    InputError
        For a plan of cubes, which has no single floor.
    """
    plan, brief = layout.plan, layout.brief
    tiling, unit = plan.tiling, brief.unit
    if tiling.solid:
        raise InputError("drawing", "a plan on one floor", "one of cubes", "write it as .glb or .png")
    x, y = layout.place.shift
    around = sides(plan, plan.cells + np.array([x, y, 0], dtype=np.int64))
    flat: list[list[float]] = (unit * tiling.positions[:2, :2]).tolist()

    def place(corner: Corner) -> Point:
        return flat[0][0] * corner[0] + flat[0][1] * corner[1], flat[1][0] * corner[0] + flat[1][1] * corner[1]

    found = {room: faces(runs, room, unit, place) for room, runs in around.items()}
    body = walls(around, found, unit, place)
    floors = [floor(found[room]) for room in range(plan.count)]
    placed = doors(layout, body, floors)
    swept = [sweep(body[one.wall], one) for one in placed]
    rooms = []
    for room, (name, wish) in enumerate(brief.rooms.items()):
        area = int((plan.rooms == room).sum()) * tiling.area * unit**2
        outline = straightened([place(run.first) for run in around[room]])
        own = [points for one, points in zip(placed, swept, strict=True) if one.into == room]
        words = label((plain(name), f"{area:.1f} m2"), floors[room], own, unit)
        rooms.append(DrawnRoom(name, area, outline, floors[room], words, wish.private))
    openings = (*placed, *windows(layout, body, placed))
    ground = Ground(_site(layout), brief.site.street, brief.site.view)
    hull, outline = floor(found[OUTSIDE])[::-1], straightened([place(run.first) for run in around[OUTSIDE]])[::-1]
    xs, ys = zip(*hull, *(ground.outline or ()), strict=True)
    measured = tuple(dimensions(body, max(max(xs) - min(xs), max(ys) - min(ys)), chains=tiling.name == "square"))
    return Drawing(title, tuple(rooms), tuple(body), openings, hull, outline, measured, ground)


def plain(name: str) -> str:
    """Give a room's name as it is written in a drawing."""
    words = name.replace("_", " ").strip() or name
    return words[:1].upper() + words[1:]


def _site(layout: Layout) -> Ring | None:
    site = layout.brief.site.outline
    return None if site is None else tuple((x * layout.brief.unit, y * layout.brief.unit) for x, y in site.points)
