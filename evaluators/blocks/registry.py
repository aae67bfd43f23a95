"""Finds a criterion of block bodies by its name: one of the project's, an import path, or an installed plug-in's.

To add one, write it in a file of its own and name it in :data:`BLOCK_CRITERIA`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Final

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
from evaluators.catalogue import Catalogue

BlockCriterion = Callable[[Structure], float]
"""A function of a body under load to one finite number; it changes nothing."""

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

_FOUND: Final = Catalogue[BlockCriterion](BLOCK_CRITERIA)
resolve = _FOUND.resolve
resolve_all = _FOUND.resolve_all
