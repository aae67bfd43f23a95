"""The space syntax of a plan: how deep its rooms lie among each other, from door to door."""

from __future__ import annotations

import numpy as np

from evaluators.plans.layout import Layout
from evaluators.space_syntax import mean_rra, of_edges


def i_value(layout: Layout) -> float:
    """Give Jackson's I of the rooms, the mean RRA over the graph of doors: the lower, the better integrated.

    As of :func:`evaluators.space_syntax.mean_rra`: a plan that is not connected is measured by part.
    """
    return mean_rra(of_edges(np.array(layout.doors, dtype=np.int64).reshape(-1, 2), layout.plan.count))
