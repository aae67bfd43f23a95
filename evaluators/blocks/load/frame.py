"""Model ``frame``: a frame of beams between block centres, solved as sparse linear statics; the accurate reference."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from evaluators.blocks.load.equations import Equations, equations
from evaluators.blocks.load.layers import Layers, layers
from evaluators.blocks.load.load import Load, loaded
from evaluators.blocks.load.settings import LoadSettings
from growth.blocks.body import Body

if TYPE_CHECKING:
    from scipy.sparse import csc_array

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]

AREA: Final = 1.0
BENDING: Final = 1.0 / 12.0
TORSION: Final = 0.140577
POISSON: Final = 0.2
"""The beams' section: a unit square (its area, second moment and St. Venant's torsion constant), of one material with
Young's modulus 1 and this Poisson's ratio. Only ratios matter for forces."""

BALANCED: Final = 1e-12
"""Refinement ends when no block is out of balance by more than this share of one block's weight ..."""

ROUNDS: Final = 40
"""... or after so many rounds, or when one brings nothing."""


def frame(body: Body, settings: LoadSettings, bending: float = 1.0) -> Load:
    """Solve the frame that a body is: a beam for each joint, clamped at the cells of the boundary.

    A slender (Euler-Bernoulli) beam of length L has, taken at its middle, no coupling: relative displacement and turn
    of its two halves meet E A / L along it, 12 E I / L^3 across, G J / L about it, and E I / L in bending. So the
    12x12 stiffness of a joint is that of four springs between rigid arms from the middle to the two centres. Every
    joint has the same unit square section, times its ``stiffness``; joints over edges and vertices are longer, hence
    softer. Weights act at the centres.

    Forces are refined until each block is in balance: what is out of balance is applied to the frame anew, and the
    forces that it causes are added.

    Parameters
    ----------
    body
        A body; what floats carries nothing.
    settings
        Stiffness, weight and strengths.
    bending
        A factor on the second moment of area, to see how far the result depends on it.

    Returns
    -------
    Load
        In balance block by block: ``residual`` stays under 1e-9.
    """
    found = layers(body, envelope_counts=settings.envelope_counts)
    system = equations(body, found)
    springs = beam_springs(body, found, settings, bending)
    carried, worst = balanced(system, springs, np.zeros((len(found.joints), 6)))
    carried = carried * settings.weight
    return loaded(found.joints, (carried[:, :3], carried[:, 3:]), found.floating, worst, settings)


def balanced(system: Equations, springs: Floats, carried: Floats) -> tuple[Floats, float]:
    """Add to what joints carry what the frame does with the unit weights that are not in balance with it.

    Parameters
    ----------
    system, springs
        The frame: (j, 6, 6) stiffness of each joint at its middle.
    carried
        (j, 6) float64, zeros or something near equilibrium.

    Returns
    -------
    carried : (j, 6) float64
    worst : float
        The largest component of any block's imbalance, in units of its weight.
    """
    from scipy.sparse.linalg import splu

    if not system.count:
        return carried, 0.0
    solver = splu(
        _stiffness(system, springs),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    missing = system.weight - system.sums(carried)
    worst = np.inf
    for _ in range(ROUNDS):
        moved = solver.solve(missing.ravel()).reshape(-1, 6)
        trial = carried + np.einsum("jab,jb->ja", springs, system.opened(moved))
        missing = system.weight - system.sums(trial)
        now = float(np.abs(missing).max())
        if now >= worst:
            break
        carried, worst = trial, now
        if worst <= BALANCED:
            break
    return carried, worst


def beam_springs(body: Body, found: Layers, settings: LoadSettings, bending: float = 1.0) -> Floats:
    """Give the (j, 6, 6) stiffness of each joint at its middle."""
    stiffness = np.array(settings.stiffness)[found.kinds]
    along = (body.cells[found.joints[:, 1]] - body.cells[found.joints[:, 0]]).astype(np.float64)
    length = np.linalg.norm(along, axis=1)
    along /= length[:, np.newaxis]
    line = along[:, :, np.newaxis] * along[:, np.newaxis]
    across = np.eye(3) - line
    second = BENDING * bending
    shear_modulus = 1.0 / (2.0 * (1.0 + POISSON))
    stretch, shear = stiffness * AREA / length, stiffness * 12.0 * second / length**3
    twist, bend = stiffness * shear_modulus * TORSION / length, stiffness * second / length
    out = np.zeros((len(length), 6, 6))
    out[:, :3, :3] = stretch[:, np.newaxis, np.newaxis] * line + shear[:, np.newaxis, np.newaxis] * across
    out[:, 3:, 3:] = twist[:, np.newaxis, np.newaxis] * line + bend[:, np.newaxis, np.newaxis] * across
    return out


def _stiffness(system: Equations, springs: Floats) -> csc_array:
    """Assemble the (6 count, 6 count) stiffness of the blocks."""
    from scipy.sparse import coo_array

    rows, columns, values = [], [], []
    index, ends, arms = np.arange(6), system.ends, system.arms
    for a in (0, 1):
        for b in (0, 1):
            both = np.flatnonzero((ends[:, a] >= 0) & (ends[:, b] >= 0))
            sign = 1.0 if a == b else -1.0
            block = sign * np.matmul(arms[both, a].transpose(0, 2, 1), np.matmul(springs[both], arms[both, b]))
            rows.append(np.broadcast_to(6 * ends[both, a, np.newaxis, np.newaxis] + index[:, np.newaxis], block.shape))
            columns.append(np.broadcast_to(6 * ends[both, b, np.newaxis, np.newaxis] + index, block.shape))
            values.append(block)
    flat = [np.concatenate([part.ravel() for part in parts]) for parts in (values, rows, columns)]
    return coo_array((flat[0], (flat[1], flat[2])), shape=(6 * system.count, 6 * system.count)).tocsc()
