"""Equilibrium block by block: how what joints carry adds up at the blocks that they join."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, final

import numpy as np
from numpy.typing import NDArray

from evaluators.blocks.load.layers import Layers
from growth.blocks.body import Body

if TYPE_CHECKING:
    from scipy.sparse import csr_array

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]


@final
@dataclass(frozen=True, slots=True, eq=False)
class Equations:
    """The six equations of each block that stands, apart from the boundary's.

    Attributes
    ----------
    arms
        (j, 2, 6, 6) float64, for both ends of each joint: takes a centre's displacement and turn to the joint.
    ends
        (j, 2) int64, which equations the blocks at both ends have: 6 k to 6 k + 5; -1 for the boundary.
    count
        How many blocks there are.
    """

    arms: Floats
    ends: Ints
    count: int

    @property
    def weight(self) -> Floats:
        """Give the load of one unit of weight on each block: (count, 6) of force and moment."""
        out = np.zeros((self.count, 6))
        out[:, 2] = -1.0
        return out

    def sums(self, carried: Floats) -> Floats:
        """Add up at each centre what the blocks do to their joints: (count, 6), equal to the loads in equilibrium.

        Parameters
        ----------
        carried
            (j, 6) float64, force and moment that the second block of each joint does to the first.
        """
        out = np.zeros((self.count + 1, 6))
        for end, sign in ((0, -1.0), (1, 1.0)):
            np.add.at(out, self.ends[:, end], sign * np.einsum("jab,ja->jb", self.arms[:, end], carried))
        return out[: self.count]

    def opened(self, moved: Floats) -> Floats:
        """Give by how much each joint opens, (j, 6), when the centres move by (count, 6)."""
        whole = np.vstack([moved, np.zeros(6)])[self.ends]  # row -1: clamped
        first, second = (np.einsum("jab,jb->ja", self.arms[:, end], whole[:, end]) for end in (0, 1))
        return np.asarray(second - first)

    def matrix(self) -> csr_array:
        """Give :meth:`sums` as a sparse (6 count, 6 j) matrix."""
        from scipy.sparse import coo_array

        index, values, rows, columns = np.arange(6), [], [], []
        for end, sign in ((0, -1.0), (1, 1.0)):
            free = np.flatnonzero(self.ends[:, end] >= 0)
            block = sign * self.arms[free, end].transpose(0, 2, 1)
            values.append(block)
            rows.append(
                np.broadcast_to(6 * self.ends[free, end, np.newaxis, np.newaxis] + index[:, np.newaxis], block.shape)
            )
            columns.append(np.broadcast_to(6 * free[:, np.newaxis, np.newaxis] + index, block.shape))
        flat = [np.concatenate([part.ravel() for part in parts]) for parts in (values, rows, columns)]
        out = coo_array((flat[0], (flat[1], flat[2])), shape=(6 * self.count, 6 * len(self.ends))).tocsr()
        out.eliminate_zeros()
        return out


def equations(body: Body, found: Layers) -> Equations:
    """Set up the equations of a body's blocks; those that float have none."""
    free = np.flatnonzero(found.depth > 0)
    row = np.full(len(body.cells), -1, dtype=np.int64)
    row[free] = np.arange(free.size)
    return Equations(_arms(body, found), row[found.joints], free.size)


def _arms(body: Body, found: Layers) -> Floats:
    """Give the (j, 2, 6, 6) matrices that take a centre's displacement and turn to the joint: u + turn x arm."""
    out = np.zeros((len(found.joints), 2, 6, 6))
    out[:, :, range(6), range(6)] = 1.0
    arm = found.points[:, np.newaxis] - body.cells[found.joints]
    for row, column, axis, sign in (
        (0, 1, 2, 1),
        (0, 2, 1, -1),
        (1, 0, 2, -1),
        (1, 2, 0, 1),
        (2, 0, 1, 1),
        (2, 1, 0, -1),
    ):
        out[:, :, row, 3 + column] = sign * arm[:, :, axis]
    return out
