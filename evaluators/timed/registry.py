"""Finds a criterion of timed forms by its name: one of the project's, an import path, or an installed plug-in's.

To add one, write it in a file of its own and name it in :data:`TIMED_CRITERIA`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Final

from evaluators.catalogue import Catalogue
from evaluators.timed.evenness import evenness
from evaluators.timed.height import height
from evaluators.timed.lift import lift
from evaluators.timed.parts import parts
from evaluators.timed.size import size
from evaluators.timed.smoothness import smoothness
from evaluators.timed.spread import spread
from evaluators.timed.stride import stride
from evaluators.timed.surface import surface
from evaluators.timed.symmetry import symmetry
from evaluators.timed.unfolding import Unfolding
from evaluators.timed.volume import volume

TimedCriterion = Callable[[Unfolding], float]
"""A function of a form that unfolds to one finite number; it changes nothing."""

TIMED_CRITERIA: Final[Mapping[str, TimedCriterion]] = MappingProxyType(
    {
        "evenness": evenness,
        "height": height,
        "lift": lift,
        "parts": parts,
        "size": size,
        "smoothness": smoothness,
        "spread": spread,
        "stride": stride,
        "surface": surface,
        "symmetry": symmetry,
        "volume": volume,
    }
)
"""The project's own criteria of timed forms."""

_FOUND: Final = Catalogue[TimedCriterion](TIMED_CRITERIA)
resolve = _FOUND.resolve
resolve_all = _FOUND.resolve_all
