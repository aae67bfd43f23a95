"""Finds a criterion of block bodies by its name: one of the project's, an import path, or an installed plug-in's.

To add one, write it in a file of its own and name it in :data:`BLOCK_CRITERIA`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType
from typing import Final, cast

from evaluators.blocks.accessibility import accessibility
from evaluators.blocks.blocks import blocks
from evaluators.blocks.exposed_surface import exposed_surface
from evaluators.blocks.ground import ground
from evaluators.blocks.height import height
from evaluators.blocks.helicity import helicity
from evaluators.blocks.particles import particles
from evaluators.blocks.rise import rise
from evaluators.blocks.self_support import self_support
from evaluators.blocks.span import span_x, span_y
from evaluators.blocks.stability import stability
from evaluators.blocks.structure import Structure
from evaluators.blocks.sun import sun
from evaluators.blocks.symmetry import symmetry
from evaluators.plugins import find_function

BlockCriterion = Callable[[Structure], float]
"""A function of a body under load to one finite number; it changes nothing."""

GROUP: Final = "atoll.evaluators"
"""The entry points' group of installed plug-ins, that of all criteria."""

BLOCK_CRITERIA: Final[Mapping[str, BlockCriterion]] = MappingProxyType(
    {
        "accessibility": accessibility,
        "blocks": blocks,
        "exposed_surface": exposed_surface,
        "ground": ground,
        "height": height,
        "helicity": helicity,
        "particles": particles,
        "rise": rise,
        "self_support": self_support,
        "span_x": span_x,
        "span_y": span_y,
        "stability": stability,
        "sun": sun,
        "symmetry": symmetry,
    }
)
"""The project's own criteria of block bodies."""


def resolve(name: str, where: str = "fitness") -> BlockCriterion:
    """Find one criterion.

    Parameters
    ----------
    name
        A key of :data:`BLOCK_CRITERIA`, ``package.module:object``, or the name of an entry point of the group
        ``atoll.evaluators``.
    where
        The place that an error names.

    Raises
    ------
    InputError
        Where there is no such criterion, it cannot be imported, or it cannot be called.
    """
    return cast("BlockCriterion", find_function(name, where, "criterion", BLOCK_CRITERIA, GROUP))


def resolve_all(names: Iterable[str], where: str = "fitness") -> dict[str, BlockCriterion]:
    """Find several criteria, in the order given."""
    return {name: resolve(name, where) for name in names}
