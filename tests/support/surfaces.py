"""Hand-made forms, and hypothesis strategies for forms, for the criteria's tests."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from hypothesis import strategies as st

from growth.surface import Surface


def surface(vertices, edges, faces=()):
    """Make a form from lists; its labels are all alike."""
    rings = [np.asarray(face, dtype=np.int32) for face in faces]
    return Surface(
        vertices=np.asarray(vertices, dtype=np.float64).reshape(-1, 3),
        edges=np.asarray(edges, dtype=np.int32).reshape(-1, 2),
        labels=np.zeros(len(edges), dtype=np.int32),
        label_names=("Edge0",),
        face_starts=np.cumsum([0, *map(len, rings)], dtype=np.int32),
        face_vertices=np.concatenate([*rings, np.empty(0, dtype=np.int32)]).astype(np.int32),
    )


def ring(vertices):
    """Join vertices to a ring round one face."""
    n = len(vertices)
    return surface(vertices, [(i, (i + 1) % n) for i in range(n)], [range(n)])


def grid(n, height=lambda x, y: 0.0):
    """A square of n x n unit faces from the origin, its height a function of x and y."""
    vertices = [(x, y, height(x, y)) for y in range(n + 1) for x in range(n + 1)]
    at = lambda x, y: y * (n + 1) + x  # noqa: E731
    edges = [(at(x, y), at(x + 1, y)) for y in range(n + 1) for x in range(n)]
    edges += [(at(x, y), at(x, y + 1)) for y in range(n) for x in range(n + 1)]
    faces = [(at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)) for y in range(n) for x in range(n)]
    return surface(vertices, edges, faces)


def moved(form, vertices):
    """The same form with other vertices."""
    return replace(form, vertices=np.asarray(vertices, dtype=np.float64))


SQUARE = ring([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)])
TENT = surface(
    [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (1, 1, 3)],
    [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)],
    [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
)
FORMS = {
    "square": SQUARE,
    "tent": TENT,
    "grid": grid(4, lambda x, y: np.sin(x) * y),
    "triangle": ring([(0, 0, 1), (3, 0, 1), (0, 4, 1)]),
    "digon": surface([(0, 0, 0), (1, 2, 3)], [(0, 1), (1, 0)], [(0, 1)]),
    "point": surface([(1, 2, 3)] * 2, [(0, 1), (0, 1)], [(0, 1)]),
    "loop": surface([(0, 0, 0), (1, 1, 1)], [(0, 1), (0, 0)]),
    "tiny": moved(TENT, TENT.vertices * 1e-150),
    "huge": moved(TENT, TENT.vertices * 1e150),
    "far": moved(TENT, TENT.vertices + 1e9),
}


@st.composite
def forms(draw: st.DrawFn) -> Surface:
    """Draw a form with a connected ring and some more edges; coordinates are multiples of 1/8."""
    n = draw(st.integers(3, 12))
    eighths = st.integers(-400, 400).map(lambda k: k / 8)
    vertices = draw(st.lists(st.tuples(eighths, eighths, eighths), min_size=n, max_size=n))
    more = draw(st.lists(st.tuples(st.integers(0, n - 1), st.integers(0, n - 1)), max_size=12))
    return surface(vertices, [*((i, (i + 1) % n) for i in range(n)), *more])
