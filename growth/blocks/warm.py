"""Compile the kernels of block growth before a run, so that no generation waits for the compiler."""

from __future__ import annotations

from genome.lsystem import parse_blocks
from growth.blocks.engine import grow
from growth.blocks.settings import BlockGrowth

_EVERY_KERNEL = """axiom: F
iterations: 2
F -> F[+F|^F] (0.5)
F -> &F
"""


def compile_kernels() -> None:
    """Grow a small wrapped body; Numba keeps the result on disk."""
    grow(parse_blocks(_EVERY_KERNEL, "warm-up"), BlockGrowth(envelope=True))
