"""Finds a criterion by its name: one of the project's, an import path, or an installed plug-in's.

To add a criterion, write it in a file of its own and name it in :data:`CRITERIA`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Final, TypeAlias

from evaluators.catalogue import Catalogue
from evaluators.size import size
from evaluators.smoothness import smoothness
from evaluators.soft_boundaries import soft_boundaries
from evaluators.subdivisions import subdivisions
from evaluators.symmetry import symmetry
from evaluators.undulation import undulation
from growth.surface import Surface

if TYPE_CHECKING:
    from growth.environment import Environment

Criterion: TypeAlias = "Callable[[Surface, Environment], float]"
"""A function of a form and the environment that it grew in to one finite number; it changes neither."""

CRITERIA: Mapping[str, Criterion] = MappingProxyType(
    {
        "size": size,
        "smoothness": smoothness,
        "soft_boundaries": soft_boundaries,
        "subdivisions": subdivisions,
        "symmetry": symmetry,
        "undulation": undulation,
    }
)
"""The project's own criteria."""

_FOUND: Final = Catalogue[Criterion](CRITERIA)
resolve = _FOUND.resolve
resolve_all = _FOUND.resolve_all
