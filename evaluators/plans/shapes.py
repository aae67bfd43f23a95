"""How the rooms of a plan are shaped."""

from __future__ import annotations

from evaluators.plans.layout import Layout
from evaluators.rooms import _kernels


def proportions(layout: Layout) -> float:
    """Give the proportions of the room that is longest for its width: short over long side of the box around it."""
    plan, tiling = layout.plan, layout.plan.tiling
    found = _kernels.slimness(plan.cells, plan.rooms, plan.count, tiling.corners, tiling.lattice, tiling.positions)
    return float(found.min())
