"""How different forms are: what they do not share when they are laid one upon the other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from growth.polyforms.polyform import Plan, Polyform

Floats = NDArray[np.float64]


def distances(forms: Sequence[Polyform | Plan]) -> Floats:
    """Give one less the intersection over union of each two forms, (n, n) float64, 0 on the diagonal.

    The forms lie with the lower left corners of the boxes around them in one place; in plans a cell is the same only in
    the same room.
    """
    rows = []
    for number, form in enumerate(forms):
        cells = form.cells - form.cells.min(axis=0) * ([1, 1, 0] if form.tiling.types > 1 else [1, 1, 1])
        rooms = form.rooms if isinstance(form, Plan) else np.zeros(len(cells), dtype=np.int64)
        rows.append(np.column_stack([cells, rooms, np.full(len(cells), number)]))
    every = np.concatenate(rows) if rows else np.empty((0, 5), dtype=np.int64)
    _, places = np.unique(every[:, :4], axis=0, return_inverse=True)
    there = np.zeros((len(forms), int(places.max(initial=-1)) + 1))
    there[every[:, 4], places.reshape(-1)] = 1.0
    both = there @ there.T
    sizes = there.sum(axis=1)
    return np.asarray(1.0 - both / np.maximum(sizes[:, None] + sizes - both, 1.0))
