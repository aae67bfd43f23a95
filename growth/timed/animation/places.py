"""Places of nodes: translation, rotation and scale of frames, as glTF moves them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from growth.timed.tables import Floats


class Places(NamedTuple):
    """Where a part stands at k times.

    Attributes
    ----------
    translations
        (k, 3) float64.
    rotations
        (k, 4) float64, unit quaternions x, y, z, w; each on the side of the one before, so that between two the
        shorter way is gone.
    scales
        (k, 3) float64; all under 0 where the frame is mirrored, as that of a surface with a scale under 0.
    """

    translations: Floats
    rotations: Floats
    scales: Floats


def places_of(frames: Floats) -> Places:
    """Take frames (k, 4, 4) apart.

    Their axes are at right angles, as the turtle's are. Along an axis without length the rotation is as it was before,
    or is completed at right angles to the others.
    """
    axes = frames[:, :3, :3]
    mirrored = np.linalg.det(axes) < 0.0
    scales = np.linalg.norm(axes, axis=1) * np.where(mirrored, -1.0, 1.0)[:, None]
    turns = _completed(axes, scales)
    return Places(frames[:, :3, 3].copy(), _continuous(_quaternions(turns)), scales)


def _completed(axes: Floats, scales: Floats) -> Floats:
    """Give rotations (k, 3, 3) of axes in columns, of which some may have no length."""
    turns = np.array(axes / np.where(scales == 0.0, 1.0, scales)[:, None, :])
    before = np.eye(3)
    for row in np.flatnonzero((scales == 0.0).any(axis=1)):
        turn, gone = turns[row], scales[row] == 0.0
        before = turns[row - 1] if row else before
        if gone.sum() == 1:
            (axis,) = np.flatnonzero(gone)
            turn[:, axis] = np.cross(turn[:, (axis + 1) % 3], turn[:, (axis + 2) % 3])
        elif gone.sum() == 2:
            (axis,) = np.flatnonzero(~gone)
            turn[:] = _swung(before, turn[:, axis], int(axis))
        else:
            turn[:] = before
    return turns


def _swung(before: Floats, way: Floats, axis: int) -> Floats:
    """Turn a rotation by as little as can be so that one axis points a way."""
    other = (axis + 1) % 3
    side = before[:, other] - way * float(before[:, other] @ way)
    if float(np.linalg.norm(side)) < 1e-9:
        side = np.eye(3)[int(np.argmin(np.abs(way)))]
        side = side - way * float(side @ way)
    found = np.empty((3, 3))
    found[:, axis] = way
    found[:, other] = side / np.linalg.norm(side)
    found[:, (axis + 2) % 3] = np.cross(found[:, axis], found[:, other])
    return found


def _quaternions(turns: Floats) -> Floats:
    from scipy.spatial.transform import Rotation

    return np.asarray(Rotation.from_matrix(turns).as_quat())


def _continuous(quaternions: Floats) -> Floats:
    """Choose of each two opposite quaternions the one nearer to the one before."""
    ways = np.einsum("ij,ij->i", quaternions[1:], quaternions[:-1])
    signs = np.cumprod(np.concatenate([[1.0], np.where(ways < 0.0, -1.0, 1.0)]))
    return np.asarray(quaternions * signs[:, None])
