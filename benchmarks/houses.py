"""Rooms and houses against shapely: joining and scoring a room of 24 cells, and a generation of 60 houses.

A room's peer reads the same genotype: it looks for each free edge among the cells so far, unites the polygon with the
next square, refuses what is no simple polygon, and measures perimeter, corners and proportions. The houses'
peer assembles the same ones by unions of their rooms, refuses overlaps as the engine does, and measures the edges that
rooms share. Limits: a room at least 30 times as fast as its peer, and 60 houses under 20 ms.
"""

from __future__ import annotations

import numpy as np
import shapely

from benchmarks.timing import best_of
from evaluators.plans import PLAN_CRITERIA, Brief, laid_out
from evaluators.plans import score as score_plan
from evaluators.plans.registry import COSTLY
from evaluators.rooms import ROOM_CRITERIA, score
from genome.polyform import Assembly, Part, Room
from growth.polyforms import SQUARE, Plan, assemble, draw_assembly, draw_room, form_of, grow_room

SIZES = {"living": 24, "dining": 15, "kitchen": 9, "entrance": 4}
MORE = {"hall": 3, "master_bedroom": 15, "bedroom": 12, "bathroom": 6}
WANTED = [["entrance", "living"], ["living", "dining"], ["dining", "kitchen"], ["hall", "master_bedroom"],
          ["hall", "bedroom"], ["hall", "bathroom"], ["entrance", "hall"]]  # fmt: skip
STEPS = [(x, y) for x, y, _ in SQUARE.steps[0].tolist()]
ROOMS, HOUSES = 80, 60
LEAST_RATIO, MOST_MS = 30.0, 20.0
USUAL = {name: criterion for name, criterion in PLAN_CRITERIA.items() if name not in COSTLY}
"""What every plan is measured by, with a goal or not."""


def by_unions(room: Room) -> tuple[float, float, float]:
    """Join a room's cells one by one, each to the polygon so far; give its perimeter, corners and proportions."""
    cells, whole = [(0, 0)], shapely.box(0, 0, 1, 1)
    for vector, edge in room.joins:
        dx, dy = STEPS[vector]
        beyond = [(x + dx, y + dy) for x, y in cells]
        x, y = [one for one in beyond if one not in cells][edge]
        cells.append((x, y))
        whole = whole.union(shapely.box(x, y, x + 1, y + 1))
        if not (isinstance(whole, shapely.Polygon) and whole.is_valid and not whole.interiors):
            raise AssertionError("no simple polygon")
    left, low, right, high = whole.bounds
    sides = sorted((right - left, high - low))
    return whole.length, float(len(whole.simplify(0.0).exterior.coords) - 1), sides[0] / sides[1]


def houses(rng: np.random.Generator) -> list[Assembly]:
    """Draw houses of two zones."""
    found: list[Assembly] = []
    while len(found) < HOUSES:
        zones = [
            draw_assembly([Part(k, draw_room(size, SQUARE, rng)) for k, size in enumerate(sizes.values())], SQUARE, rng)
            for sizes in (SIZES, MORE)
        ]
        house = draw_assembly([Part(k, one) for k, one in enumerate(zones) if isinstance(one, Assembly)], SQUARE, rng)
        if isinstance(house, Assembly) and len(house.parts) == len(zones):
            found.append(house)
    return found


def shared(plan: Plan) -> list[float]:
    """Unite each room of a plan, refuse overlaps, and measure what rooms share."""
    squares = shapely.box(plan.cells[:, 0], plan.cells[:, 1], plan.cells[:, 0] + 1, plan.cells[:, 1] + 1)
    rooms = [shapely.union_all(squares[plan.rooms == room]) for room in range(plan.count)]
    whole = shapely.union_all(rooms)
    assert whole.area == len(plan.cells)
    return [a.intersection(b).length for k, a in enumerate(rooms) for b in rooms[:k]]


def main() -> bool:
    """Print times and ratios; tell whether all are within their limits."""
    rng = np.random.default_rng(7)
    rooms = [draw_room(24, SQUARE, rng) for _ in range(ROOMS)]
    brief = Brief.model_validate({
        "rooms": {name: {"cells": cells} for name, cells in {**SIZES, **MORE}.items()},
        "adjacencies": WANTED, "entrance": "entrance",
    })  # fmt: skip
    bred = houses(rng)
    plans = [one for one in (form_of(house, SQUARE) for house in bred) if isinstance(one, Plan)]
    for room in rooms:
        found = score(grow_room(room, SQUARE), ROOM_CRITERIA)  # type: ignore[arg-type]
        assert isinstance(found, dict)
        assert by_unions(room) == (found["perimeter"], found["corners"], found["proportions"])
    for plan in plans:
        pairs = laid_out(plan, brief).shared
        assert shared(plan) == [float(pairs[k, other]) for k in range(plan.count) for other in range(k)]

    def ours_rooms() -> None:
        for room in rooms:
            score(grow_room(room, SQUARE), ROOM_CRITERIA)  # type: ignore[arg-type]

    def generation() -> None:
        for house in bred:
            plan = assemble(house, SQUARE)
            assert isinstance(plan, Plan)
            score_plan(laid_out(plan, brief), USUAL)

    ours, theirs, all_houses, peers = best_of(
        ours_rooms, lambda: [by_unions(room) for room in rooms], generation, lambda: [shared(plan) for plan in plans]
    )  # type: ignore[misc]
    print(f"houses: a room of 24 cells joined and scored in {ours / ROOMS * 1e6:.0f} us, by unions in "
          f"{theirs / ROOMS * 1e6:.0f} us: {theirs / ours:.0f} times (at least {LEAST_RATIO:g})")  # fmt: skip
    print(f"houses: {HOUSES} houses of 88 cells assembled and scored in {all_houses * 1e3:.1f} ms (under {MOST_MS:g}), "
          f"{peers / all_houses:.1f} times as fast as shapely unites and measures them")  # fmt: skip
    return theirs / ours >= LEAST_RATIO and all_houses * 1e3 < MOST_MS


if __name__ == "__main__":
    raise SystemExit(not main())
