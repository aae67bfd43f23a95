"""Mesh boundaries: Atoll's queries against trimesh's, in time and near the surface (docs/adr/0010)."""

from __future__ import annotations

import importlib.util
import time
from collections.abc import Callable

import numpy as np
import trimesh
from trimesh.ray.ray_pyembree import RayMeshIntersector as Embree
from trimesh.ray.ray_triangle import RayMeshIntersector as Rtree

from growth.environment.boundaries import _tree as tree
from growth.environment.boundaries.mesh import closed_mesh
from growth.environment.boundaries.protocol import BoundarySettings


def best(work: Callable[[], object], rounds: int = 5) -> float:
    """Give the least time of some rounds, in milliseconds."""
    work()
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return 1000.0 * min(times)


def main() -> None:
    """Print the ratios and the wrong answers."""
    ball = trimesh.creation.icosphere(subdivisions=3)
    ours = closed_mesh(np.array(ball.vertices), np.array(ball.faces, np.int32), BoundarySettings())
    tables = (ours._corners, ours._boxes, ours._first, ours._count)
    rng = np.random.default_rng(1)
    points, ways = rng.normal(size=(300, 3)) * 0.7, rng.normal(size=(300, 3))
    within = best(lambda: ours.inside(points))
    hit = best(lambda: ours.first_hit(points, points + ways))
    nearest = best(lambda: tree.nearest(*tables, points))
    print(f"atoll: within {within:.2f} ms, first hit {hit:.2f} ms, nearest {nearest:.2f} ms; the others as multiples")
    peers = [("embree", Embree(ball))]
    if importlib.util.find_spec("rtree"):
        peers.append(("rtree", Rtree(ball)))
    for name, peer in peers:
        a = best(lambda peer=peer: peer.contains_points(points), 2) / within
        b = best(lambda peer=peer: peer.intersects_location(points, ways, multiple_hits=False), 2) / hit
        print(f"trimesh with {name}: within {a:.1f}, first hit {b:.1f}")
    if importlib.util.find_spec("rtree"):
        ratio = best(lambda: trimesh.proximity.closest_point(ball, points), 2) / nearest
        print(f"trimesh with rtree: nearest {ratio:.1f}")
    for distance in (3e-6, 1e-7, 1e-8):
        out = np.ascontiguousarray(ball.triangles_center + ball.face_normals * distance)
        into = np.ascontiguousarray(ball.triangles_center - ball.face_normals * distance)
        sides = [ours.inside, peers[0][1].contains_points]
        wrong = [int(side(out).sum() + (~side(into)).sum()) for side in sides]
        place, ray, _ = peers[0][1].intersects_location(out, -ball.face_normals, multiple_hits=False)
        far = np.full(len(out), np.inf)
        far[ray] = np.linalg.norm(place - out[ray], axis=1)
        fractions = ours.first_hit(out, out - ball.face_normals)
        missed = [int((np.abs(got - distance) > 1e-9 + 0.1 * distance).sum()) for got in (fractions, far)]
        print(f"{distance:g} off: atoll {wrong[0]} wrong sides, {missed[0]} missed; embree {wrong[1]}, {missed[1]}")


if __name__ == "__main__":
    main()
