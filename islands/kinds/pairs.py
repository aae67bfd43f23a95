"""Two bodies in one space: merged where they meet, and each by itself (Senatore 2009, 'structural co-evolution')."""

from __future__ import annotations

from typing import Final

import numpy as np

from growth.blocks import BlockGrowth, stand
from growth.blocks.body import Body
from growth.blocks.lattice import Lattice
from islands.kinds.bodies import BlockLoad, Cells, is_stable

PAIR: Final = ("alone_first", "alone_second", "meet", "shared")
"""What is measured of two bodies besides the criteria of the whole: whether each stands alone, whether they meet (share
a cell or touch), 0 or 1 each, and how many cells they share."""


def united(first: Cells, second: Cells) -> Cells:
    """Merge two skeletons, each (n, 3) in the order of its growth, into one: a cell of both is there once.

    They grow at the same time, so that any prefix holds about the same share of each: blocks are ordered by the share
    of its own body that is there with them, of equals those of the first body before.

    Returns
    -------
    (m, 3) int64.
    """
    cells = np.concatenate([first, second])
    times = np.concatenate([np.arange(1, len(one) + 1) / max(1, len(one)) for one in (first, second)])
    ordered = cells[np.argsort(times, kind="stable")]
    _, places = np.unique(ordered, axis=0, return_index=True)
    return np.ascontiguousarray(ordered[np.sort(places)], dtype=np.int64)


def meetings(first: Cells, second: Cells, lattice: Lattice) -> tuple[int, bool]:
    """Count the cells that two skeletons share, and tell whether they meet: share a cell, or touch."""
    low = np.concatenate([first, second]).min(axis=0) - 1
    size = np.concatenate([first, second]).max(axis=0) - low + 2

    def keys(cells: Cells) -> Cells:
        x, y, z = (cells - low).T
        return np.asarray((x * size[1] + y) * size[2] + z)

    others = keys(second)
    shared = int(np.isin(keys(first), others).sum())
    beside = (first[:, None, :] + lattice.offsets[None, :, :]).reshape(-1, 3)
    return shared, shared > 0 or bool(np.isin(keys(beside), others).any())


def grounded(cells: Cells, growth: BlockGrowth) -> BlockGrowth:
    """Give the growth settings under which a part stands on the ground that the whole has, and on no other."""
    if growth.supports is not None or growth.ground == "fixed":
        return growth
    return growth.model_copy(update={"ground": "fixed", "ground_level": int(cells[:, 2].min())})


def paired(first: Cells, second: Cells, growth: BlockGrowth, load: BlockLoad) -> tuple[Body, dict[str, float]]:
    """Make one body of two skeletons, and measure what makes a pair of them.

    Parameters
    ----------
    first, second
        (n, 3) int64, at least one cell each, where they grew.
    growth, load
        Of the whole.

    Returns
    -------
    The body, and the criteria ``PAIR``. Alone each part stands on the ground of the whole.
    """
    cells = united(first, second)
    by_itself = grounded(cells, growth)
    shared, meet = meetings(first, second, growth.cells)
    alone = [float(is_stable(stand(part, by_itself), by_itself, load)) for part in (first, second)]
    return stand(cells, growth), dict(zip(PAIR, (*alone, float(meet), float(shared)), strict=True))
