"""Compile the kernels of timed growth before a run, so that no generation waits for the compiler."""

from __future__ import annotations

from genome.timed import parse_tl
from growth.protocol import Failure
from growth.timed.derivation import derive
from growth.timed.turtle import draw

_EVERY_KERNEL = """#define K 1 + 1
axiom A(1) C
A(x) @ 0.5 : x < 9 -> A(x + besselj(0, x)) [ B(random(0, x)) @ (x/9) ] : 0.5
A(x) @ 0.5 -> A(x)
B(x) @ x -> B(x)
g A(x, age) = if(age > 1, root(3, x), x^2)
"""

_DRAWN = """section bud(a) = 1 + 0.5*cos(a)
surface sheet(u, v) = u, v, u*v
axiom bud cC(1) [ star +(9) cC(1, 0) /(9) cC(1) ] F { f + f ^ f } $ ' sphere(1) disc(1) sheet ~(1)
"""


def compile_kernels() -> None:
    """Derive small words, one of a system with contexts, and draw one; Numba keeps the result on disk."""
    for text in (_EVERY_KERNEL, f"{_EVERY_KERNEL}A(x) < C -> C\n"):
        derive(parse_tl(text, "warm-up"), 2.0)
    word = derive(parse_tl(_DRAWN, "warm-up"), 0.0)
    assert not isinstance(word, Failure)
    draw(word)
