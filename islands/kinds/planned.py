"""What islands of rooms and of assemblies share: plans of cells, scored with what the islands above ask for."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from evaluators.plans import Layout
from genome.polyform import Assembly, Room, encode
from growth.polyforms import Plan, Polyform, Tiling, distances, form_of
from growth.protocol import Failure
from islands.individual import Evaluation
from islands.kinds.parts import read_demand_text
from islands.migration.channel import Migrant

if TYPE_CHECKING:
    from PIL.Image import Image

G = TypeVar("G", Room, Assembly)

FRESH: Final = "fresh"
"""How far a form is from those that unsatisfied upper islands use, 0 to 1; 0 where all are satisfied."""

SECONDS: Final = 1.0


class PlannedBiology(ABC, Generic[G]):
    """Breeds what grows to a plan; see :class:`islands.kinds.protocol.Biology`.

    Parameters
    ----------
    tiling
        What the cells are.
    """

    seconds: Final = SECONDS

    def __init__(self, tiling: Tiling) -> None:
        self._tiling: Final = tiling

    @abstractmethod
    def scored(self, genotype: G, partners: tuple[Migrant, ...]) -> Evaluation:
        """Grow and score a genotype by its form, and by what these islands above use and miss."""

    @abstractmethod
    def layout(self, genotype: G) -> Layout | Failure:
        """Grow a plan and lay it out."""

    def picture(self, genotype: G, partners: tuple[Migrant, ...], size: tuple[int, int]) -> Image | None:
        """Draw a plan; see :class:`islands.kinds.protocol.Pictured`."""
        from evaluators.plans.drawings.pictures import plan_picture

        del partners  # plans are shown by themselves
        layout = self.layout(genotype)
        return None if isinstance(layout, Failure) else plan_picture(layout, size)

    def encode(self, genotype: G) -> str:
        """Write a genotype as JSON, the parts of an assembly whole."""
        return encode(genotype)

    def evaluate(self, genotype: G) -> Evaluation:
        """Score a genotype; nobody asks for fresh ones."""
        return self.scored(genotype, ())

    def evaluate_with(self, genotype: G, partners: tuple[Migrant, ...]) -> Evaluation:
        """Score a genotype by what the islands above use and miss, too."""
        return self.scored(genotype, partners)

    def diversity(self, genotypes: Sequence[G]) -> float | None:
        """Give the mean distance of the forms, of assemblies room by room."""
        return shape_diversity([form_of(one, self._tiling) for one in genotypes])

    def distances(self, genotypes: Sequence[G]) -> NDArray[np.float64]:
        """Give the distances of the forms."""
        return shape_distances([form_of(one, self._tiling) for one in genotypes])


def freshness(form: Polyform | Plan, name: str, partners: Sequence[Migrant]) -> float:
    """Give the least distance from the parts of this name that unsatisfied upper islands use, times what they miss.

    Parameters
    ----------
    form
        A part of this name.
    name
        Its name.
    partners
        What upper islands show, see :mod:`islands.kinds.parts`.
    """
    found = []
    for one in partners:
        demand = read_demand_text(one.text)
        used = demand.parts.get(name)
        shape = None if used is None else form_of(used, form.tiling)
        if demand.met < 1.0 and isinstance(shape, Plan):
            found.append((1.0 - demand.met) * float(distances([form, shape])[0, 1]))
    return min(found, default=0.0)


def shape_distances(forms: Sequence[Plan | Failure]) -> NDArray[np.float64]:
    """Give the distances of forms, (n, n), 0 to 1; what cannot be grown is as far from all as can be."""
    grown = [place for place, one in enumerate(forms) if isinstance(one, Plan)]
    found = np.ones((len(forms), len(forms)))
    found[np.ix_(grown, grown)] = distances([one for one in forms if isinstance(one, Plan)])
    np.fill_diagonal(found, 0.0)
    return found


def shape_diversity(forms: Sequence[Plan | Failure]) -> float | None:
    """Give the mean distance of all pairs of forms, 0 to 1; ``None`` for fewer than two."""
    count = len(forms)
    return float(shape_distances(forms).sum()) / (count * (count - 1)) if count > 1 else None
