"""Growing a body of 400 blocks from a word of 2,400 symbols, against the plain Python reference of the tests.

Both rewrite the same system, read the word and stand the body on its ground; the bodies are equal. Limits: under 1 ms a
growth, and at least 20 times as fast as the reference.
"""

from __future__ import annotations

import sys
from pathlib import Path

from benchmarks.timing import best_of
from genome.lsystem import parse_blocks
from growth.blocks import BlockGrowth, Body, derive, grow
from growth.blocks.lattice import CUBIC
from growth.protocol import Failure

sys.path.append(str(Path(__file__).parents[1] / "tests" / "support"))

from reference_blocks import Turtle, derived, stood

SYSTEM = parse_blocks(
    """
axiom: F
iterations: 5
F -> F[+^F|-&F]+£F$ (0.7)
F -> &+F£F
G < F -> F
seed: 14602
""",
    "benchmark",
)
GROWTH = BlockGrowth()
MOST_MS = 1.0
LEAST_RATIO = 20.0


def grown() -> Body:
    """Grow it."""
    body = grow(SYSTEM, GROWTH)
    assert isinstance(body, Body)
    return body


def main() -> bool:
    """Print time and ratio; tell whether both are within their limits."""
    turtle = Turtle(CUBIC)

    def plain() -> list[list[tuple[int, int, int]]]:
        return [*stood(turtle.walked(derived(SYSTEM)), CUBIC, GROWTH)]

    body = grown()
    internal, _, boundary = plain()
    assert body.internal.tolist() == [list(cell) for cell in internal]
    assert body.boundary.tolist() == [list(cell) for cell in boundary]
    word = derive(SYSTEM, GROWTH)
    assert not isinstance(word, Failure)
    ours, theirs = best_of(grown, plain)
    ratio = theirs / ours
    print(f"blocks_growth: {len(internal)} blocks from {word.size} symbols in {ours * 1e3:.3f} ms (under {MOST_MS:g})")
    print(f"blocks_growth: {ratio:.0f} times the plain reference, {theirs * 1e3:.1f} ms (at least {LEAST_RATIO:g})")
    return ours * 1e3 < MOST_MS and ratio >= LEAST_RATIO


if __name__ == "__main__":
    raise SystemExit(not main())
