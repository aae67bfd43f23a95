"""Compile the kernels of block bodies' loads and criteria before a run."""

from __future__ import annotations

import numpy as np

from evaluators.blocks.load import LoadSettings, analyse
from evaluators.blocks.registry import BLOCK_CRITERIA
from evaluators.blocks.structure import Structure
from growth.blocks import BlockGrowth, stand


def compile_kernels() -> None:
    """Load and score a small body that passes through every kernel; Numba keeps the result on disk."""
    body = stand(np.array([[0, 0, 0], [0, 0, 1], [1, 0, 1], [1, 1, 2]]), BlockGrowth())
    for model in ("galasyn", "rigid"):
        structure = Structure(body, analyse(body, LoadSettings(model=model)))
    for criterion in BLOCK_CRITERIA.values():
        criterion(structure)


if __name__ == "__main__":
    compile_kernels()
