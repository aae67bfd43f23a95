"""Finds a criterion by its name: one of the project's, an import path, or an installed plug-in's.

To add a criterion, write it in a file of its own and name it in :data:`CRITERIA`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, TypeAlias, cast

from evaluators.plugins import find_function
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

GROUP = "atoll.evaluators"
"""The entry points' group of installed plug-ins."""

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


def resolve(name: str, where: str = "fitness") -> Criterion:
    """Find one criterion.

    Parameters
    ----------
    name
        A key of :data:`CRITERIA`, ``package.module:object``, or the name of an entry point of the group
        ``atoll.evaluators``. The project's own names cannot be taken by a plug-in.
    where
        The place that an error names.

    Raises
    ------
    InputError
        Where there is no such criterion, it cannot be imported, or it cannot be called.
    """
    return cast("Criterion", find_function(name, where, "criterion", CRITERIA, GROUP))


def resolve_all(names: Iterable[str], where: str = "fitness") -> dict[str, Criterion]:
    """Find several criteria, in the order given."""
    return {name: resolve(name, where) for name in names}
