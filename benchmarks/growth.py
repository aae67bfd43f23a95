"""Growing the square system 7 steps against subdividing a mesh into as many faces with trimesh.

Both make 16,384 faces from one. trimesh only splits triangles; growth rewrites edges, places branches in regions and
joins them, so the aim is to stay within a small factor: at most 5, aim 2.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import trimesh

from benchmarks.timing import best_of
from growth.hemls import SurfaceGrowth, grow, parse_system
from growth.surface import Surface

SQUARE = Path(__file__).parents[1] / "experiments" / "systems" / "square.hemls"
LIMIT = 5.0


def grown() -> int:
    """Grow the square system 7 steps and give the number of faces."""
    surface = grow(parse_system(SQUARE.read_text()), SurfaceGrowth(steps=7, max_elements=100_000))
    assert isinstance(surface, Surface)
    return surface.counts[2]


def subdivided() -> int:
    """Subdivide one triangle 7 times and give the number of faces."""
    vertices, faces = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]])
    for _ in range(7):
        vertices, faces = trimesh.remesh.subdivide(vertices, faces)
    return len(faces)


def main() -> bool:
    """Print the ratio; tell whether it is within the limit."""
    assert grown() == subdivided() == 16_384
    ours, theirs = best_of(grown, subdivided)
    ratio = ours / theirs
    print(f"growth: 7 steps of the square system {ours * 1e3:.1f} ms, trimesh.remesh.subdivide {theirs * 1e3:.1f} ms")
    print(f"growth: ratio {ratio:.2f} (at most {LIMIT:g}, aim 2)")
    return ratio <= LIMIT


if __name__ == "__main__":
    raise SystemExit(not main())
