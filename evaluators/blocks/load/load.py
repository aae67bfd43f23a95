"""What a load analysis finds: what each joint carries, and whether it holds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from numpy.typing import NDArray

from evaluators.blocks.load.settings import LoadSettings
from growth.blocks.body import Body

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]

FALLEN: Final = -1.0
"""The largest margin of a body that nothing carries, or a part of which nothing carries."""

TOLERANCE: Final = 1e-9
"""A joint that carries this share more than its strength still holds: rounding decides nothing."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Load:
    """The result of an analysis.

    Attributes
    ----------
    joints
        (j, 2) int64, places in the body's cells, the lower layer first: the block nearer to the foundation; within a
        layer the first place. All pairs of neighbours that count and stand, but for those within the foundation.
    forces, moments
        (j, 3) float64, what the second block of a joint does to the first at the joint, half way between their centres.
        Units: the weight's, and weight times the lattice's unit of length. The layered models ``galasyn`` and ``rigid``
        leave zeros at joints within a layer.
    translational, torsional
        (j,) float64, the norms of both, which the strengths bound.
    failed
        (f,) int64, places of joints over a strength.
    floating
        (m,) int64, places of the cells that are joined to no boundary, in ascending order.
    residual
        The largest imbalance of force or of moment over one unit of length, relative to the weight of what is out of
        balance.
    margins
        1 - max(load / strength) at each stage of growth, the last being the body itself; 1 where nothing is bounded,
        -1 or less where something floats.
    factor
        How many times its weight the body can bear; of the model ``limit`` alone.
    """

    joints: Ints
    forces: Floats
    moments: Floats
    translational: Floats
    torsional: Floats
    failed: Ints
    floating: Ints
    residual: float
    margins: tuple[float, ...]
    factor: float | None = None

    @property
    def stable(self) -> bool:
        """Whether no joint fails, nothing floats, and the load factor, where there is one, is at least 1."""
        held = self.factor is None or self.factor >= 1.0 - TOLERANCE
        return held and not self.failed.size and not self.floating.size

    @property
    def margin(self) -> float:
        """The share of strength that is left at the worst joint; below 0 for an unstable body."""
        return self.margins[-1]

    @property
    def worst(self) -> int | None:
        """The place of the joint that is nearest to its strength, or farthest over it; None without failure."""
        return int(self.failed[0]) if self.failed.size else None

    @property
    def shares(self) -> Floats:
        """Give the forces as (j,) shares of the largest, 0 to 1, for display; zeros where there are none."""
        largest = float(self.translational.max(initial=0.0))
        return self.translational / largest if largest > 0 else np.zeros_like(self.translational)

    def by_cell(self, body: Body) -> Floats:
        """Give (n,) float64 in 0..1: the largest share of the joints of each cell of the body; 0 without joints."""
        out = np.zeros(len(body.cells))
        np.maximum.at(out, self.joints.ravel(), np.repeat(self.shares, 2))
        return out


def loaded(
    joints: Ints,
    carried: tuple[Floats, Floats],
    floating: Ints,
    residual: float,
    settings: LoadSettings,
    factor: float | None = None,
) -> Load:
    """Make the result from what the joints carry.

    Parameters
    ----------
    joints, floating, residual, factor
        As in :class:`Load`.
    carried
        Its forces and moments.
    settings
        With the strengths.
    """
    forces, moments = carried
    translational, torsional = np.linalg.norm(forces, axis=1), np.linalg.norm(moments, axis=1)
    use = np.zeros(len(joints))
    if settings.axial_strength is not None:
        use = translational / settings.axial_strength
    if settings.torsion_strength is not None:
        use = np.maximum(use, torsional / settings.torsion_strength)
    over = np.flatnonzero(use > 1.0 + TOLERANCE)
    failed = over[np.argsort(-use[over], kind="stable")].astype(np.int64)
    margin = 1.0 - (float(use.max(initial=0.0)))
    if floating.size:
        margin = min(margin, FALLEN)
    return Load(
        joints, forces, moments, translational, torsional, failed, floating, float(residual), (margin,), factor
    )  # fmt: skip
