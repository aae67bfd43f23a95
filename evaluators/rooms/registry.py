"""The criteria of rooms by name: the project's own, an import path, or an installed plug-in's."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Final, cast

from evaluators.applying import applied, read_only
from evaluators.plugins import find_function
from evaluators.rooms.shape import corners, perimeter, perimeter_to_area, proportions
from growth.polyforms.polyform import Polyform
from growth.protocol import Failure

RoomCriterion = Callable[[Polyform], float]
"""A function of a form of cells to one finite number; it changes nothing."""

GROUP: Final = "atoll.evaluators"

ROOM_CRITERIA: Final[Mapping[str, RoomCriterion]] = MappingProxyType(
    {
        "corners": corners,
        "perimeter": perimeter,
        "perimeter_to_area": perimeter_to_area,
        "proportions": proportions,
    }
)
"""The project's own."""


def resolve(name: str, where: str = "fitness") -> RoomCriterion:
    """Find one criterion; see :func:`evaluators.plugins.find_function`."""
    return cast("RoomCriterion", find_function(name, where, "criterion", ROOM_CRITERIA, GROUP))


def score(room: Polyform, criteria: Mapping[str, RoomCriterion]) -> dict[str, float] | Failure:
    """Apply criteria to a room; see :func:`evaluators.applying.applied`."""
    return applied(criteria, read_only(room))
