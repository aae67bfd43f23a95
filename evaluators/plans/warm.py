"""Compile the kernels of rooms and plans before a run, so that no generation waits for the compiler."""

from __future__ import annotations

import numpy as np

from evaluators.plans.brief import Brief
from evaluators.plans.layout import laid_out
from evaluators.plans.registry import PLAN_CRITERIA, score
from evaluators.rooms.registry import ROOM_CRITERIA
from evaluators.rooms.registry import score as score_room
from genome.polyform import Part
from growth.polyforms import CUBE, SQUARE, Plan, Polyform, draw_assembly, draw_room, form_of, grow_room
from growth.protocol import Failure


def compile_kernels() -> None:
    """Draw, grow and judge a plan of two rooms, and a room of cubes; Numba keeps the result on disk."""
    rng = np.random.default_rng(0)
    rooms = [draw_room(4, SQUARE, rng) for _ in range(2)]
    house = draw_assembly([Part(number, room) for number, room in enumerate(rooms)], SQUARE, rng)
    plan = house if isinstance(house, Failure) else form_of(house, SQUARE)
    outline = [[0, 0], [9, 0], [9, 9], [0, 9]]
    brief = Brief.model_validate({"rooms": {"a": {"cells": 4}, "b": {"cells": 4}}, "site": {"outline": outline}})
    if isinstance(plan, Plan):
        score(laid_out(plan, brief), PLAN_CRITERIA)
    for tiling in (SQUARE, CUBE):
        form = grow_room(draw_room(4, tiling, rng), tiling)
        if isinstance(form, Polyform):
            score_room(form, ROOM_CRITERIA)


if __name__ == "__main__":
    compile_kernels()
