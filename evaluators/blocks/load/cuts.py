"""A body cut under each of its layers: what the models ``rigid`` and ``galasyn`` bring into balance."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from evaluators.blocks.load import _kernels as kernels
from evaluators.blocks.load.layers import Layers, layers
from evaluators.blocks.load.load import Load, loaded
from evaluators.blocks.load.settings import LoadSettings
from growth.blocks.body import Body

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]


@final
@dataclass(frozen=True, slots=True, eq=False)
class Cuts:
    """The parts above the cuts, each with the joints that it stands on.

    Attributes
    ----------
    layers
        The joints.
    part
        (j,) int64, the part that stands on each; -1 within a layer. Each joint is cut once at most.
    first, order
        (p + 1,) and (c,) int64: part p stands on the joints ``order[first[p] : first[p + 1]]``.
    weights, centres
        (p,) and (p, 3) float64, of each part.
    stiffness
        (j,) float64.
    """

    layers: Layers
    part: Ints
    first: Ints
    order: Ints
    weights: Floats
    centres: Floats
    stiffness: Floats

    def load(self, forces: Floats, moments: Floats, settings: LoadSettings) -> Load:
        """Make the result, with the imbalance of the worst part as its residual."""
        missing = kernels.imbalance(self.layers.points, forces, moments, self.part, self.weights, self.centres)
        residual = float((missing / self.weights[:, np.newaxis]).max(initial=0.0))
        return loaded(self.layers.joints, (forces, moments), self.layers.floating, residual, settings)


def cuts(body: Body, settings: LoadSettings) -> Cuts:
    """Cut a body under each layer (semantics.md, section 4: two towers do not lean on each other)."""
    found = layers(body, envelope_counts=settings.envelope_counts)
    part, counts, centres = kernels.parts_above(body.cells, found.depth, found.joints)
    stiffness = np.array(settings.stiffness)[found.kinds]
    weights = counts.astype(np.float64) * settings.weight
    first, order = kernels.by_group(part, len(weights))
    return Cuts(found, part, first, order, weights, centres, stiffness)
