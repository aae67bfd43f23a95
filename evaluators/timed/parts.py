"""Parts: of how many cylinders, spheres, discs, generalised cylinders, polygons and surfaces a form is made."""

from __future__ import annotations

from evaluators.timed.unfolding import Unfolding


def parts(unfolding: Unfolding) -> float:
    """Count the parts at the last time."""
    return float(len(unfolding.form))
