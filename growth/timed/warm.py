"""Compile the kernels of timed growth before a run, so that no generation waits for the compiler."""

from __future__ import annotations

from genome.timed import parse_tl
from growth.timed.derivation import derive

_EVERY_KERNEL = """axiom A(1) C
A(x) @ 0.5 : x < 9 -> A(x + besselj(0, x)) [ B(random(0, x)) @ (x/9) ] : 0.5
A(x) @ 0.5 -> A(x)
B(x) @ x -> B(x)
g A(x, age) = if(age > 1, root(3, x), x^2)
"""


def compile_kernels() -> None:
    """Derive two small words, one of a system with contexts; Numba keeps the result on disk."""
    for text in (_EVERY_KERNEL, f"{_EVERY_KERNEL}A(x) < C -> C\n"):
        derive(parse_tl(text, "warm-up"), 2.0)
