"""How the rooms of a plan are shaped."""

from __future__ import annotations

from evaluators.plans.layout import Layout
from evaluators.rooms.shape import proportions as of_room
from growth.polyforms.polyform import Polyform


def proportions(layout: Layout) -> float:
    """Give the proportions of the room that is longest for its width: short over long side of the box around it."""
    plan = layout.plan
    return min(of_room(Polyform(plan.tiling, plan.cells[plan.rooms == room])) for room in range(plan.count))
