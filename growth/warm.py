"""Compile every kernel ahead of a run: ``python -m growth.warm``.

Numba keeps compiled kernels on disk beside the source, so that neither a run nor its Ray workers wait for the compiler.
"""

from __future__ import annotations

from pathlib import Path

from genome.genr8 import Genr8Genome
from growth.environment.warm import compile_kernels as compile_environment
from growth.hemls.warm import compile_kernels as compile_hemls


def compile_surfaces() -> None:
    """Compile the kernels of genome mapping, environments and surface growth."""
    Genr8Genome().mapper(Path()).map(range(200))
    compile_environment()
    compile_hemls()


def compile_kernels() -> None:
    """Compile the kernels of all engines."""
    # Imported here: islands of surfaces need not hold the other engines.
    from growth.blocks.warm import compile_kernels as compile_blocks
    from growth.timed.warm import compile_kernels as compile_timed

    compile_surfaces()
    compile_blocks()
    compile_timed()


if __name__ == "__main__":
    compile_kernels()
