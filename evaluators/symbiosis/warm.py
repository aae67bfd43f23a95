"""Compile the kernels of symbiotic criteria before a run."""

from __future__ import annotations

import numpy as np

from evaluators.symbiosis.registry import SYMBIOSIS_CRITERIA
from evaluators.symbiosis.score import score
from evaluators.symbiosis.settings import SymbiosisSettings
from evaluators.symbiosis.symbiosis import Symbiosis
from growth.blocks.lattice import CUBIC


def compile_kernels() -> None:
    """Score two small partners by every criterion; Numba keeps the result on disk."""
    wall, room = np.array([[0, 0, 0], [1, 0, 0], [0, 0, 1]]), np.array([[0, 1, 0], [1, 1, 0]])
    score(Symbiosis(CUBIC, wall, room, np.empty((0, 3), dtype=np.int64), SymbiosisSettings()), SYMBIOSIS_CRITERIA)


if __name__ == "__main__":
    compile_kernels()
