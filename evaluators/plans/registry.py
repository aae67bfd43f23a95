"""The criteria of plans by name: the project's own, an import path, or an installed plug-in's."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Final

from evaluators.applying import applied, read_only
from evaluators.catalogue import Catalogue
from evaluators.plans.adjacency import adjacency, met
from evaluators.plans.compactness import corners, perimeter, perimeter_to_area
from evaluators.plans.layout import Layout
from evaluators.plans.light import daylight, orientation, street, view
from evaluators.plans.shapes import proportions
from evaluators.plans.site import site
from evaluators.plans.syntax import i_value
from evaluators.plans.ways import circulation, reachable
from growth.protocol import Failure

PlanCriterion = Callable[[Layout], float]
"""A function of a plan as it is laid out to one finite number; it changes nothing."""

PLAN_CRITERIA: Final[Mapping[str, PlanCriterion]] = MappingProxyType(
    {
        "adjacency": adjacency,
        "circulation": circulation,
        "corners": corners,
        "daylight": daylight,
        "i_value": i_value,
        "met": met,
        "orientation": orientation,
        "perimeter": perimeter,
        "perimeter_to_area": perimeter_to_area,
        "proportions": proportions,
        "reachable": reachable,
        "site": site,
        "street": street,
        "view": view,
    }
)
"""The project's own."""

COSTLY: Final = ("i_value",)
"""Criteria that take longer than all others together, and are measured where they have a goal."""

_FOUND: Final = Catalogue[PlanCriterion](PLAN_CRITERIA)
resolve = _FOUND.resolve


def score(layout: Layout, criteria: Mapping[str, PlanCriterion]) -> dict[str, float] | Failure:
    """Apply criteria to a plan; see :func:`evaluators.applying.applied`."""
    return applied(criteria, read_only(layout))
