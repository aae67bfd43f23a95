"""Boundaries to test with, and plain answers to compare with: slow, simple, from other formulas."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from hypothesis import strategies as st

from growth.environment import Environment, environment_from
from growth.environment.boundaries.mesh import Mesh, closed_mesh
from growth.environment.boundaries.protocol import BoundarySettings

COORDINATE = st.floats(-3.0, 3.0, allow_nan=False)
VECTOR = st.lists(COORDINATE, min_size=3, max_size=3)
LENGTH = st.floats(0.05, 4.0)
AXIS = VECTOR.filter(lambda v: np.linalg.norm(v) > 1e-3)
ANGLES = st.lists(st.sampled_from([0.0, 30.0, 90.0, -45.0, 180.0, 12.5]), min_size=3, max_size=3)
SIDE = st.sampled_from(["inside", "outside"])


def _shape(name: str, **keys: st.SearchStrategy[Any]) -> st.SearchStrategy[dict[str, Any]]:
    return st.fixed_dictionaries({"shape": st.just(name), "at": VECTOR, "solid": SIDE, **keys})


SPHERES = _shape("sphere", radius=LENGTH)
BOXES = _shape("box", size=st.lists(LENGTH, min_size=3, max_size=3), rotation=ANGLES)
PLANES = _shape("plane", normal=AXIS)
CYLINDERS = _shape("cylinder", axis=AXIS, radius=LENGTH, height=LENGTH)
SHAPES = st.one_of(SPHERES, BOXES, PLANES, CYLINDERS)


def environment(*boundaries: dict[str, Any], **others: Any) -> Environment:
    return environment_from({"boundaries": list(boundaries), **others}, "test.yaml", Path())


def points(seed: int, count: int = 200, spread: float = 3.0) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=(count, 3)) * spread


def bumpy(seed: int, subdivisions: int = 2) -> tuple[np.ndarray, np.ndarray]:
    """A closed star-shaped body that is not convex."""
    import trimesh

    ball = trimesh.creation.icosphere(subdivisions=subdivisions)
    radii = np.random.default_rng(seed).uniform(0.6, 1.4, size=(len(ball.vertices), 1))
    return np.array(ball.vertices) * radii, np.array(ball.faces, dtype=np.int32)


def body(vertices: np.ndarray, triangles: np.ndarray, solid: str = "inside") -> Mesh:
    return closed_mesh(vertices, triangles, BoundarySettings(solid=solid))


def winding_numbers(vertices: np.ndarray, triangles: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Sum the solid angles of all triangles (Van Oosterom and Strackee 1983, equation 8)."""
    a, b, c = (vertices[triangles[:, k]][None] - at[:, None] for k in range(3))
    la, lb, lc = (np.linalg.norm(x, axis=2) for x in (a, b, c))
    top = np.einsum("ijk,ijk->ij", a, np.cross(b, c))
    bottom = la * lb * lc + (a * b).sum(2) * lc + (b * c).sum(2) * la + (c * a).sum(2) * lb
    return np.arctan2(top, bottom).sum(axis=1) / (2 * np.pi)


def distances(vertices: np.ndarray, triangles: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Distance of each point from the surface, over all triangles by trimesh."""
    import trimesh

    corners = vertices[triangles]
    return np.array(
        [
            np.linalg.norm(trimesh.triangles.closest_point(corners, np.tile(p, (len(corners), 1))) - p, axis=1).min()
            for p in at
        ]
    )
