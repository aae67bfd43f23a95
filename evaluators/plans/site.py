"""Whether a plan fits its site."""

from __future__ import annotations

from evaluators.plans.layout import Layout


def site(layout: Layout) -> float:
    """Give the share of the plan's cells that lie in the site's outline, where it lies best; 1 without an outline.

    A plan is shifted on its site by whole cells, and not turned: its sides face where they face.
    """
    return layout.place.inside / len(layout.plan.cells)
