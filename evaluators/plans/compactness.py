"""How compact a plan is as a whole."""

from __future__ import annotations

from evaluators.plans.layout import Layout
from evaluators.rooms import _kernels


def perimeter(layout: Layout) -> float:
    """Give the length of the outer walls, in edges of cells."""
    return float(layout.outer.sum())


def perimeter_to_area(layout: Layout) -> float:
    """Give the length of the outer walls over the area."""
    return perimeter(layout) / (len(layout.plan.cells) * layout.plan.tiling.area)


def corners(layout: Layout) -> float:
    """Count the corners of the whole."""
    tiling = layout.plan.tiling
    return float(_kernels.turning(layout.plan.cells, tiling.corners, tiling.lattice, tiling.straight))
