"""Model ``limit``: the largest load factor that equilibrium and the joints' strengths allow, as a linear program."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from evaluators.blocks.load.equations import Equations, equations
from evaluators.blocks.load.frame import balanced, beam_springs
from evaluators.blocks.load.layers import layers
from evaluators.blocks.load.load import Load, loaded
from evaluators.blocks.load.settings import LoadSettings
from growth.blocks.body import Body

if TYPE_CHECKING:
    from scipy.sparse import csr_array

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

CRITICAL: Final = 1e-7
"""A bound counts where the factor would grow by more than this share of itself if the bound were doubled."""

UNBOUNDED: Final = 3
"""What scipy calls a program whose value has no bound."""


def limit(body: Body, settings: LoadSettings) -> Load:
    """Find the largest factor on the weight for which joints within their strengths keep every block in equilibrium.

    By the lower bound theorem of plasticity a body of ductile joints bears that much; no elastic stiffness comes in.
    What a joint carries must lie in a ball (its force within ``axial_strength``, its moment within
    ``torsion_strength``), which a linear program cannot say. In its place stands a polyhedron within: at first a cube
    with its corners on the sphere; wherever that counts for the result, the geodesic polyhedron with 162 corners on the
    sphere and 320 faces, no nearer to the centre than 0.982 of the radius. So the factor is never too large, and too
    small by 1.8 percent at most.

    Parameters
    ----------
    body
        A body; what floats carries nothing.
    settings
        Weight and strengths; the stiffness does not count.

    Returns
    -------
    Load
        With ``factor``, infinite where the strengths bound nothing, and an equilibrium under the weight as it is
        (factor 1), in which no joint is nearer to its strength than 1 / factor.

    Raises
    ------
    ArithmeticError
        Where the linear program is not solved, which is not known to happen.
    """
    found = layers(body, envelope_counts=settings.envelope_counts)
    system = equations(body, found)
    given = (settings.axial_strength, settings.torsion_strength)
    strengths = np.array([math.inf if one is None else one / settings.weight for one in given])
    solved = _solved(system, strengths) if system.count and np.isfinite(strengths).any() else None
    start = np.zeros((len(found.joints), 6)) if solved is None else solved
    carried, worst = balanced(system, beam_springs(body, found, settings), start)
    if found.floating.size:
        factor = 0.0
    elif solved is None:
        factor = math.inf
    else:  # what was out of balance by rounding is balanced; the norms, not the polyhedra, bound the factor
        factor = 1.0 / float((np.linalg.norm(carried.reshape(-1, 2, 3), axis=2) / strengths).max())
    carried = carried * settings.weight
    return loaded(found.joints, (carried[:, :3], carried[:, 3:]), found.floating, worst, settings, factor)


def _solved(system: Equations, strengths: Floats) -> Floats | None:
    """Give what joints carry, (j, 6) in units of a block's weight, where the factor is largest; None if it has no end.

    The program is solved again with the finer polyhedron wherever a cube counted, until none does.
    """
    from scipy.optimize import linprog
    from scipy.sparse import csr_array, diags_array, hstack

    finite = np.isfinite(strengths)
    unit = float(strengths[finite].max())
    scale = np.repeat(np.where(finite, strengths, unit), 3)  # of a joint's six variables, each then at most 1
    joints = len(system.ends)
    balance = system.matrix() @ diags_array(np.tile(scale / unit, joints))
    balance = hstack([balance, csr_array(-system.weight.reshape(-1, 1))], format="csr")
    goal = np.append(np.zeros(6 * joints), -1.0)
    bounded = np.tile(finite, (joints, 1))
    fine = np.zeros((joints, 2), dtype=np.bool_)
    while True:
        cube = np.where((bounded & ~fine).repeat(3, axis=1), 1.0 / math.sqrt(3.0), math.inf).ravel()
        faces, reach = _faces(fine)
        found = linprog(
            goal,
            A_ub=faces if len(reach) else None,
            b_ub=reach if len(reach) else None,
            A_eq=balance,
            b_eq=np.zeros(6 * system.count),
            bounds=np.stack([np.append(-cube, 0.0), np.append(cube, math.inf)], axis=1),
            method="highs-ipm",
        )
        if found.status == UNBOUNDED:
            return None
        if found.status != 0:
            raise ArithmeticError(f"the linear program of the load factor is not solved: {found.message}")
        counts = (np.abs(found.lower.marginals) + np.abs(found.upper.marginals))[:-1].reshape(joints, 2, 3).max(axis=2)
        critical = bounded & ~fine & (counts > CRITICAL * -found.fun)
        if not critical.any():
            return np.asarray(found.x[:-1].reshape(joints, 6) * scale / (found.x[-1] * unit))
        fine |= critical


def _faces(fine: Flags) -> tuple[csr_array, Floats]:
    """Write the finer polyhedra as rows: the coefficients of (6 j + 1) variables, and the faces' distances."""
    from scipy.sparse import coo_array
    from trimesh.creation import icosphere

    ball = icosphere(subdivisions=2)
    normals = np.asarray(ball.face_normals)
    distances = np.einsum("fa,fa->f", normals, ball.vertices[ball.faces[:, 0]])
    joint, which = np.nonzero(fine)
    shape = (joint.size, len(normals), 3)
    rows = np.broadcast_to(np.arange(joint.size * len(normals)).reshape(joint.size, len(normals), 1), shape)
    columns = np.broadcast_to((6 * joint + 3 * which)[:, np.newaxis, np.newaxis] + np.arange(3), shape)
    values = np.broadcast_to(normals, shape)
    flat = (values.ravel(), (rows.ravel(), columns.ravel()))
    return coo_array(flat, shape=(joint.size * len(normals), 6 * fine.shape[0] + 1)).tocsr(), np.tile(
        distances, joint.size
    )
