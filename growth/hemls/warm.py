"""Compile the kernels of surface growth before a run, so that no generation waits for the compiler."""

from __future__ import annotations

from growth.hemls.engine import grow
from growth.hemls.rules import parse_system
from growth.hemls.settings import SurfaceGrowth

_EVERY_KERNEL = """A + B + A
A -> A [ [ + B ] - B ] A
B -> A [ + A + B ] B
A < B -> A B
Angle 60
BranchAngle 60
"""


def compile_kernels() -> None:
    """Grow a small surface whose rules pass through every kernel; Numba keeps the result on disk."""
    for sync in ("", "Sync\n"):
        grow(parse_system(_EVERY_KERNEL + sync, "warm-up"), SurfaceGrowth(steps=2))
