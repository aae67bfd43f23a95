"""The criteria of rooms by name: the project's own, an import path, or an installed plug-in's."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Final

from evaluators.applying import applied, read_only
from evaluators.catalogue import Catalogue
from evaluators.rooms.shape import corners, perimeter, perimeter_to_area, proportions
from growth.polyforms.polyform import Polyform
from growth.protocol import Failure

RoomCriterion = Callable[[Polyform], float]
"""A function of a form of cells to one finite number; it changes nothing."""

ROOM_CRITERIA: Final[Mapping[str, RoomCriterion]] = MappingProxyType(
    {
        "corners": corners,
        "perimeter": perimeter,
        "perimeter_to_area": perimeter_to_area,
        "proportions": proportions,
    }
)
"""The project's own."""

_FOUND: Final = Catalogue[RoomCriterion](ROOM_CRITERIA)
resolve = _FOUND.resolve


def score(room: Polyform, criteria: Mapping[str, RoomCriterion]) -> dict[str, float] | Failure:
    """Apply criteria to a room; see :func:`evaluators.applying.applied`."""
    return applied(criteria, read_only(room))
