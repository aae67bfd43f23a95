"""The turtle on words of 195,311 modules, against a plain Python turtle; a generalised cylinder, against trimesh.

Both peers hold modules as tuples (symbol, parameters), keep nothing but places and frames, and make nothing orthonormal
again. The plain one knows moves, turns and brackets, its state is a tuple of vectors; the bare one is written by hand
for this word's symbols, its state twelve local numbers. Told besides: the whole drawing with its shapes. The cylinder
has 400 sections of 32 sides along a helix; trimesh sweeps a polygon of as many sides along as many places. Limits: 30
times as fast as the plain turtle; no slower than trimesh.
"""

from __future__ import annotations

import math
import statistics
import time
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from genome.timed import parse_tl
from growth.protocol import Failure
from growth.timed import Word, derive
from growth.timed.turtle import TurtleSettings, draw
from growth.timed.turtle.walking import walk
from tests.support.reference_drawing import Vector, mixed

BUSH = "axiom F(1)\nF(l) -> F(l)[+(25.7)F(l)]F(l)[-(25.7)F(l)]F(l)\n"
HELIX = "axiom !(0.2) A(399)\nA(n) @ 0 : n > 0 -> cC(0.1, n = 1) +(3) /(1) A(n - 1)\n"
ROUNDS = 15
LEAST_RATIO = 30.0
SIDES = 32

Module = tuple[str, tuple[float, ...]]
Row = tuple[float, ...]


class Turtle(NamedTuple):
    """A place and directions."""

    place: Vector
    heading: Vector
    left: Vector
    up: Vector


def plain(modules: Sequence[Module]) -> list[Turtle]:
    """Give the turtle at each F."""
    turtle = Turtle((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (-1.0, 0.0, 0.0))
    found: list[Turtle] = []
    pile: list[Turtle] = []
    for symbol, given in modules:
        place, heading, left, up = turtle
        if symbol in ("F", "f"):
            if symbol == "F":
                found.append(turtle)
            (x, y, z), (hx, hy, hz), length = place, heading, given[0]
            turtle = Turtle((x + length * hx, y + length * hy, z + length * hz), heading, left, up)
        elif symbol == "[":
            pile.append(turtle)
        elif symbol == "]":
            turtle = pile.pop()
        elif symbol in "+-^&/\\":
            angle = math.radians(given[0] if symbol in "+^/" else -given[0])
            if symbol in "+-":
                heading, left = mixed(heading, left, angle)
            elif symbol in "^&":
                heading, up = mixed(heading, up, angle)
            else:
                left, up = mixed(left, up, angle)
            turtle = Turtle(place, heading, left, up)
    return found


def bare(modules: Sequence[Module]) -> list[Row]:
    """Give the place and directions at each F, twelve numbers."""
    x = y = z = 0.0
    hx, hy, hz, lx, ly, lz, ux, uy, uz = 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0
    rows: list[Row] = []
    pile: list[Row] = []
    for symbol, given in modules:
        if symbol == "F":
            rows.append((x, y, z, hx, hy, hz, lx, ly, lz, ux, uy, uz))
            length = given[0]
            x, y, z = x + length * hx, y + length * hy, z + length * hz
        elif symbol == "[":
            pile.append((x, y, z, hx, hy, hz, lx, ly, lz, ux, uy, uz))
        elif symbol == "]":
            x, y, z, hx, hy, hz, lx, ly, lz, ux, uy, uz = pile.pop()
        else:
            angle = math.radians(given[0] if symbol == "+" else -given[0])
            c, s = math.cos(angle), math.sin(angle)
            hx, lx = c * hx + s * lx, c * lx - s * hx
            hy, ly = c * hy + s * ly, c * ly - s * hy
            hz, lz = c * hz + s * lz, c * lz - s * hz
    return rows


def timed(*contestants: Callable[[], object]) -> list[list[float]]:
    """Give the seconds of each contestant, round by round; they take turns."""
    seconds: list[list[float]] = [[] for _ in contestants]
    for _ in range(ROUNDS):
        for mine, run in zip(seconds, contestants, strict=True):
            start = time.perf_counter()
            run()
            mine.append(time.perf_counter() - start)
    return seconds


def told(seconds: Sequence[float]) -> str:
    """Write median, least and most in milliseconds."""
    return f"{statistics.median(seconds) * 1e3:.2f} ms ({min(seconds) * 1e3:.2f} to {max(seconds) * 1e3:.2f})"


def word_of(text: str, until: float) -> Word:
    """Derive a word."""
    word = derive(parse_tl(text), until)
    assert isinstance(word, Word)
    return word


def walking() -> bool:
    """Compare the turtles; tell whether ours is quick enough."""
    word, turtle = word_of(BUSH, 7.0), TurtleSettings(radius=1.0)
    modules: list[Module] = [(module.symbol, module.parameters) for module in word.modules()]
    trail, expected = walk(word, turtle), np.array(bare(modules))
    assert not isinstance(trail, Failure)
    np.testing.assert_allclose(trail.frames[:, :3, 3], expected[:, :3], atol=1e-9)
    for column, first in ((2, 3), (0, 6), (1, 9)):
        np.testing.assert_allclose(trail.frames[:, :3, column], expected[:, first : first + 3], atol=1e-9)
    np.testing.assert_array_equal(np.array(plain(modules)).reshape(-1, 12), expected)
    mine, theirs, hand, whole = timed(
        lambda: walk(word, turtle), lambda: plain(modules), lambda: bare(modules), lambda: draw(word, turtle)
    )
    ratio, by_hand = (statistics.median(b / a for a, b in zip(mine, other, strict=True)) for other in (theirs, hand))
    print(f"timed_turtle: {len(word)} modules in {told(mine)}, plain turtle in {told(theirs)}: {ratio:.1f} times as "
          f"fast (at least {LEAST_RATIO:g}), {by_hand:.1f} times the bare one; drawn in {told(whole)}")  # fmt: skip
    return ratio >= LEAST_RATIO


def sweeping() -> bool:
    """Compare generalised cylinders; tell whether ours is no slower."""
    from shapely.geometry import Polygon
    from trimesh.creation import sweep_polygon

    word, turtle = word_of(HELIX, 0.0), TurtleSettings(sides=SIDES, rings=1)
    drawing = draw(word, turtle)
    assert not isinstance(drawing, Failure)
    assert len(drawing) == 1
    path = drawing.corners(0)[:-2].reshape(-1, SIDES, 3).mean(axis=1)
    angles = 2.0 * np.pi * np.arange(SIDES) / SIDES
    ring = Polygon(0.2 * np.stack([np.cos(angles), np.sin(angles)], axis=1))
    mesh = sweep_polygon(ring, path)
    assert len(path) == 400
    assert len(mesh.vertices) >= 400 * SIDES
    mine, theirs = timed(lambda: draw(word, turtle), lambda: sweep_polygon(ring, path))
    ratio = statistics.median(a / b for a, b in zip(mine, theirs, strict=True))
    print(f"timed_turtle: 400 sections of {SIDES} sides from a word in {told(mine)}, trimesh in {told(theirs)}: "
          f"{ratio:.3f} of its time (at most 1)")  # fmt: skip
    return ratio <= 1.0


def main() -> bool:
    """Print both; tell whether they are within their limits."""
    return all([walking(), sweeping()])


if __name__ == "__main__":
    raise SystemExit(not main())
