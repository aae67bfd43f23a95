"""What holds of every boundary, whatever its shape."""

from __future__ import annotations

import multiprocessing
from concurrent.futures import ProcessPoolExecutor
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from solids import BOXES, CYLINDERS, SHAPES, SPHERES, body, bumpy, distances, environment, points, winding_numbers

from growth.environment import Environment
from growth.environment.boundaries.mesh import RAYS
from growth.environment.boundaries.protocol import Boundary

SEEDS = st.integers(0, 2**32 - 1)


def _signed_depth(shape: dict[str, Any], at: np.ndarray) -> np.ndarray:
    """Depth within the shape by textbook formulas, in numpy; positive inside the shape."""
    from scipy.spatial.transform import Rotation

    local = at - np.array(shape["at"], dtype=float)
    if shape["shape"] == "sphere":
        return shape["radius"] - np.linalg.norm(local, axis=1)
    if shape["shape"] == "box":
        local = Rotation.from_euler("xyz", shape["rotation"], degrees=True).inv().apply(local)
        return (np.array(shape["size"]) / 2 - np.abs(local)).min(axis=1)
    axis = np.array(shape.get("normal", shape.get("axis")), dtype=float)
    height = local @ (axis / np.linalg.norm(axis))
    if shape["shape"] == "plane":
        return -height
    across = np.linalg.norm(local - height[:, None] * axis / np.linalg.norm(axis), axis=1)
    return np.minimum(shape["radius"] - across, shape["height"] / 2 - np.abs(height))


def _checked_move(env: Environment, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Move, and check what holds of every move."""
    (boundary,) = env.boundaries
    out = env.move(start, end)
    assert not env.inside(out).any()
    way, gone = end - start, out - start
    length = np.linalg.norm(way, axis=1)
    share = np.einsum("ij,ij->i", gone, way) / np.where(length > 0, length**2, 1)
    assert (share >= -boundary.skin / np.maximum(length, 1e-9)).all()
    assert (share <= 1 + 1e-12).all()
    off = np.linalg.norm(gone - share[:, None] * way, axis=1)
    assert (off <= 3 * boundary.skin + 1e-12).all()
    return out


@settings(max_examples=60, deadline=None)
@given(SHAPES, SEEDS)
def test_shapes_know_their_inside(shape: dict[str, Any], seed: int) -> None:
    at = points(seed)
    depth = _signed_depth(shape, at) * (1 if shape["solid"] == "inside" else -1)
    clear = np.abs(depth) > 1e-9
    np.testing.assert_array_equal(environment(shape).inside(at)[clear], depth[clear] > 0)


@settings(max_examples=60, deadline=None)
@given(SHAPES, SEEDS)
def test_nothing_ends_inside_and_the_cut_way_is_on_the_way(shape: dict[str, Any], seed: int) -> None:
    env = environment(shape)
    start = env.release(points(seed))
    assert start is not None
    assert not env.inside(start).any()
    end = start + points(seed + 1)
    out = _checked_move(env, start, end)
    again = _checked_move(env, out, out + points(seed + 2))
    _checked_move(env, again, end)


@settings(max_examples=40, deadline=None)
@given(SHAPES, SEEDS)
def test_a_way_is_cut_where_a_fine_walk_first_enters(shape: dict[str, Any], seed: int) -> None:
    env = environment(shape)
    (boundary,) = env.boundaries
    start = env.release(points(seed, 40))
    assert start is not None
    end = start + points(seed + 1, 40)
    hits = boundary.first_hit(start, end)
    steps = np.linspace(0, 1, 2001)[:, None, None]
    walk = start + steps * (end - start)
    within = env.inside(walk.reshape(-1, 3)).reshape(2001, -1)
    first = np.where(within.any(axis=0), within.argmax(axis=0) / 2000, np.inf)
    entered = np.isfinite(first)
    assert (np.abs(hits[entered] - first[entered]) <= 1 / 2000 + 1e-4).all()
    assert (hits[entered] <= first[entered]).all()
    missed = ~entered & np.isfinite(hits)  # a graze between two steps of the walk
    middle = start[missed] + np.minimum(hits[missed] + 1e-4, 1.0)[:, None] * (end[missed] - start[missed])
    depth = np.abs(_signed_depth(shape, middle))
    assert (depth < 0.01).all()


@settings(max_examples=60, deadline=None)
@given(SHAPES, SEEDS)
def test_released_points_go_to_the_nearest_surface(shape: dict[str, Any], seed: int) -> None:
    env = environment(shape)
    (boundary,) = env.boundaries
    at = points(seed)
    out = env.release(at)
    assert out is not None
    within = env.inside(at)
    np.testing.assert_array_equal(out[~within], at[~within])
    gone = np.linalg.norm(out - at, axis=1)[within]
    depth = np.abs(_signed_depth(shape, at))[within]
    if shape["solid"] == "inside":
        np.testing.assert_allclose(gone, depth, atol=2 * boundary.skin, rtol=1e-9)
    else:
        assert (gone >= depth - 1e-9).all()
        vertices, _ = boundary.outline(20.0)
        others = np.linalg.norm(at[within][:, None] - vertices[None], axis=2).min(axis=1, initial=np.inf)
        assert (gone <= others + 4 * boundary.skin).all()


@settings(max_examples=40, deadline=None)
@given(SPHERES, SEEDS)
def test_every_vertex_keeps_the_radius_exactly(shape: dict[str, Any], seed: int) -> None:
    env = environment(shape)
    centre, radius = np.array(shape["at"]), shape["radius"]
    at = env.release(points(seed, spread=2.0))
    assert at is not None
    for number in range(4):
        distance = np.linalg.norm(at - centre, axis=1)
        assert (distance >= radius if shape["solid"] == "inside" else distance <= radius).all()
        at = env.move(at, centre + points(seed + number, spread=radius))


def test_a_fall_onto_a_sphere_stops_a_skin_above_it() -> None:
    env = environment({"shape": "sphere", "at": [0, 0, 0], "radius": 2.0})
    out = env.move([[0, 0, 5]], [[0, 0, -5]])
    np.testing.assert_allclose(out, [[0, 0, 2 + 2e-6]], rtol=0, atol=1e-12)
    np.testing.assert_array_equal(env.move(out, out - [[0, 0, 1]]), out)
    for free in ([0, 0, 1], [1, 0, 0], [0, -3, 0.5]):
        np.testing.assert_array_equal(env.move(out, out + free), out + free)


@pytest.mark.parametrize(
    "shape",
    [
        {"shape": "sphere", "at": [0, 0, -1], "radius": 1},
        {"shape": "box", "at": [0, 0, -1], "size": [2, 2, 2]},
        {"shape": "cylinder", "at": [0, 0, -1], "radius": 1, "height": 2},
        {"shape": "plane", "at": [0, 0, 0]},
        {"shape": "plane", "at": [0, 0, 0], "normal": [0, 0, -1e-200], "solid": "outside"},
        {"shape": "sphere", "at": [0, 0, 1], "radius": 1, "solid": "outside"},
        {"shape": "box", "at": [0, 0, 1], "size": [2, 2, 2], "solid": "outside"},
        {"shape": "cylinder", "at": [0, 0, 1], "radius": 1, "height": 2, "solid": "outside"},
    ],
)
def test_a_vertex_exactly_on_the_surface_stays_or_goes_free(shape: dict[str, Any]) -> None:
    env = environment(shape)
    at = np.zeros((1, 3))
    assert not env.inside(at).any()
    np.testing.assert_array_equal(env.move(at, [[0, 0, -0.5]]), at)
    np.testing.assert_array_equal(env.move(at, [[0.1, 0, -0.5]]), at)
    np.testing.assert_array_equal(env.move(at, [[0, 0, 0.5]]), [[0, 0, 0.5]])
    np.testing.assert_array_equal(env.move(at, at), at)
    np.testing.assert_array_equal(env.move([[0, 0, 0.5]], at), at)
    assert env.inside([[0, 0, -1e-9]]).all()


@settings(max_examples=12, deadline=None)
@given(st.one_of(SPHERES, BOXES, CYLINDERS), SEEDS)
def test_shapes_agree_with_the_meshes_of_their_outlines(shape: dict[str, Any], seed: int) -> None:
    env = environment(shape)
    (exact,) = env.boundaries
    drawn = body(*exact.outline(1.0), shape["solid"])
    at = points(seed)
    size = float(np.ptp(drawn.vertices, axis=0).max())
    rough = 0.0 if shape["shape"] == "box" else 0.002 * size
    clear = np.abs(_signed_depth(shape, at)) > rough + 1e-9
    np.testing.assert_array_equal(exact.inside(at)[clear], drawn.inside(at)[clear])
    for boundary in (exact, drawn):
        within = np.ascontiguousarray(at[boundary.inside(at) & clear])
        assert not boundary.inside(boundary.nearest_free(within)).any()
    within = np.ascontiguousarray(at[exact.inside(at) & clear])
    near, far = exact.nearest_free(within), drawn.nearest_free(within)
    gone = [np.linalg.norm(place - within, axis=1) for place in (near, far)]
    np.testing.assert_allclose(gone[0], gone[1], atol=rough + 1e-5 * size)


@settings(max_examples=12, deadline=None)
@given(st.integers(0, 10_000), st.sampled_from(["inside", "outside"]))
def test_meshes_agree_with_solid_angles_and_all_triangles(seed: int, solid: str) -> None:
    vertices, triangles = bumpy(seed)
    mesh = body(vertices, triangles, solid)
    at = points(seed, 300, 0.8)
    winding = np.round(winding_numbers(vertices, triangles, at)).astype(int)
    np.testing.assert_array_equal(mesh.inside(at), (winding > 0) == (solid == "inside"))
    within = np.ascontiguousarray(at[mesh.inside(at)])
    free = mesh.nearest_free(within)
    expected = distances(vertices, triangles, within)
    gone = np.linalg.norm(free - within, axis=1)
    np.testing.assert_allclose(gone, expected, atol=1.001 * mesh.skin)
    assert (gone >= expected - 1e-12).all()
    assert not mesh.inside(free).any()


@settings(max_examples=12, deadline=None)
@given(st.integers(0, 10_000), st.sampled_from(["inside", "outside"]))
def test_ways_through_a_mesh_are_cut_at_the_first_triangle(seed: int, solid: str) -> None:
    vertices, triangles = bumpy(seed, 1)
    mesh = body(vertices, triangles, solid)
    at = points(seed, 400, 0.9)
    start = np.ascontiguousarray(at[~mesh.inside(at)])
    end = start + points(seed + 1, len(start), 1.0)
    hits = mesh.first_hit(start, end)
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    expected = np.full(len(start), np.inf)
    for i, (p, d) in enumerate(zip(start, end - start, strict=True)):  # Moeller and Trumbore 1997
        h = np.cross(d, c - a)
        det = np.einsum("ij,ij->i", b - a, h)
        u = np.einsum("ij,ij->i", p - a, h) / det
        q = np.cross(p - a, b - a)
        v = q @ d / det
        t = np.einsum("ij,ij->i", c - a, q) / det
        met = t[(u >= 0) & (v >= 0) & (u + v <= 1) & (t >= 0) & (t < 1)]
        expected[i] = met.min(initial=np.inf)
    np.testing.assert_allclose(hits, expected, atol=1e-9)


def _mesh_environment(mesh: Boundary) -> Environment:
    return Environment({}, "", (), np.zeros(3), np.empty((0, 5)), (mesh,), ())


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 10_000), st.sampled_from(["inside", "outside"]))
def test_nothing_moves_or_is_released_into_a_mesh(seed: int, solid: str) -> None:
    vertices, triangles = bumpy(seed)
    env = _mesh_environment(body(vertices, triangles, solid))
    at = env.release(points(seed, 300, 0.8))
    assert at is not None
    for number in range(4):
        end = at + points(seed + number + 1, 300, 0.5)
        at = _checked_move(env, at, end)
        winding = winding_numbers(vertices, triangles, at)
        assert ((winding < 0.5) == (solid == "inside")).all()


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 10_000))
def test_a_vertex_on_a_meshs_corner_edge_or_face_stays_or_goes_free(seed: int) -> None:
    vertices, triangles = bumpy(seed, 1)
    mesh = body(vertices, triangles)
    env = _mesh_environment(mesh)
    corners = vertices[triangles]
    rest = np.concatenate([vertices, corners[:, :2].mean(axis=1), corners.mean(axis=1)])
    outward = rest * (1 + 3e-6)  # the body is star-shaped
    assert not env.inside(outward).any()
    stuck = env.move(outward, np.zeros_like(outward))
    assert (np.linalg.norm(stuck - outward, axis=1) <= 1e-4).all()
    np.testing.assert_array_equal(env.move(outward, 2 * outward), 2 * outward)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_rays_through_corners_and_edges_do_not_mislead_the_winding(seed: int) -> None:
    vertices, triangles = bumpy(seed, 1)
    mesh = body(vertices, triangles)
    aims = np.concatenate([vertices, vertices[triangles][:, :2].mean(axis=1)])
    for way in RAYS:
        for back in (0.125, 0.5, 1.0):
            at = np.ascontiguousarray(aims - back * way)
            winding = winding_numbers(vertices, triangles, at)
            clear = np.abs(winding - 0.5) > 0.4
            np.testing.assert_array_equal(mesh.inside(at)[clear], winding[clear] > 0.5)


def test_a_start_a_rounding_error_within_does_not_walk_through() -> None:
    import trimesh

    box = trimesh.creation.box(extents=(2, 2, 2))
    for env in (
        environment({"shape": "box", "at": [0, 0, 0], "size": [2, 2, 2]}),
        environment({"shape": "sphere", "at": [0, 0, 0], "radius": 1}),
        environment({"shape": "cylinder", "at": [0, 0, 0], "radius": 1, "height": 2}),
        _mesh_environment(body(np.array(box.vertices), np.array(box.faces, dtype=np.int32))),
    ):
        out = env.move([[0, 0, 1 - 1e-9]], [[0, 0, -5]])
        np.testing.assert_allclose(out, [[0, 0, 1]], atol=1e-5)
        assert not env.inside(out).any()


@settings(max_examples=30, deadline=None)
@given(SHAPES, SEEDS)
def test_even_a_way_within_a_solid_ends_outside_it(shape: dict[str, Any], seed: int) -> None:
    env = environment(shape)
    at = points(seed, spread=1.0)
    assert not env.inside(env.move(at, at + 0.1 * points(seed + 1))).any()


def test_an_edge_that_is_hit_exactly_lets_nothing_through() -> None:
    import trimesh

    box = trimesh.creation.box(extents=(2, 2, 2))
    env = _mesh_environment(body(np.array(box.vertices), np.array(box.faces, dtype=np.int32)))
    side = np.linspace(-1, 1, 21)
    start = np.array([[x, y, 3.0] for x in side for y in side])
    inner = np.abs(start[:, :2]).max(axis=1) < 1
    out = env.move(start, start * [1, 1, -1])
    np.testing.assert_allclose(out[inner, 2], 1.0, atol=1e-5)
    assert not env.inside(out).any()
    assert env.inside(start[inner] * [1, 1, 0]).all()


def test_overlapping_bodies_are_solid_where_they_overlap_and_a_cavity_is_free() -> None:
    import trimesh

    parts = [
        trimesh.creation.icosphere(radius=r).apply_translation([x, 0, 0]) for r, x in ((1, 0), (1, 1), (0.3, -0.5))
    ]
    parts[2].invert()
    joined = trimesh.util.concatenate(parts)
    mesh = body(np.array(joined.vertices), np.array(joined.faces, dtype=np.int32))
    at = np.array([[0.5, 0, 0], [-0.9, 0, 0], [1.9, 0, 0], [-0.5, 0.0, 0.1], [2.5, 0, 0]])
    np.testing.assert_array_equal(mesh.inside(at), [True, True, True, False, False])
    env = _mesh_environment(mesh)
    np.testing.assert_allclose(env.move([[-0.5, 0, 0]], [[3, 0, 0]]), [[-0.2, 0, 0]], atol=0.01)


def test_a_point_at_the_centre_of_a_shape_is_released_upward() -> None:
    for shape in (
        {"shape": "sphere", "at": [1, 2, 3], "radius": 1},
        {"shape": "box", "at": [1, 2, 3], "size": [2, 2, 2]},
        {"shape": "cylinder", "at": [1, 2, 3], "radius": 1, "height": 2},
    ):
        out = environment(shape).release([[1, 2, 3]])
        np.testing.assert_allclose(out, [[1, 2, 4]], atol=1e-5)


def test_soft_boundaries_stop_nothing_and_count_each_node_once_for_each() -> None:
    ball = {"shape": "sphere", "at": [0, 0, 0], "radius": 1, "soft": True}
    floor = {"shape": "plane", "at": [0, 0, 0], "soft": True}
    env = environment(ball, floor)
    at = np.array([[0, 0, 0.5], [0, 0, -0.5], [0, 0, -2], [0, 0, 2], [0, 0, 1], [5, 5, 0]])
    assert env.wrong_side(at) == 4
    assert not env.inside(at).any()
    assert not env.has_hard
    np.testing.assert_array_equal(env.move(at, -at), -at)
    assert environment({**ball, "solid": "outside"}).wrong_side(at) == 3


@settings(max_examples=30, deadline=None)
@given(st.lists(SHAPES, min_size=2, max_size=4), SEEDS)
def test_with_several_boundaries_all_are_kept_or_none_is_possible(shapes: list[dict[str, Any]], seed: int) -> None:
    env = environment(*shapes)
    start = env.release(points(seed, 30))
    if start is None:
        return
    assert not env.inside(start).any()
    out = env.move(start, start + points(seed + 1, 30))
    assert not env.inside(out).any()


def test_a_narrow_gap_between_solids_is_found_and_a_full_space_is_not() -> None:
    walls = [
        {"shape": "box", "at": [0, 0, 0], "size": [2, 2, 2]},
        {"shape": "box", "at": [0, 0, 2.05], "size": [40, 40, 2]},
        {"shape": "box", "at": [0, 0, -11], "size": [40, 40, 20]},
        {"shape": "box", "at": [2, 0, 0], "size": [2, 40, 4]},
        {"shape": "box", "at": [-2, 0, 0], "size": [2, 40, 4]},
        {"shape": "box", "at": [0, 11, 0], "size": [40, 20, 4]},
    ]
    env = environment(*walls)
    out = env.release([[0.9, 0.9, 0.0], [0, 0, 0]])
    assert out is not None
    assert not env.inside(out).any()
    full = environment(
        {"shape": "sphere", "at": [0, 0, 0], "radius": 2},
        {"shape": "sphere", "at": [0, 0, 0], "radius": 1, "solid": "outside"},
    )
    assert full.release([[0, 0, 1.5]]) is None
    assert full.release([[0, 0, 5.0]]) is None


def test_an_environment_travels_to_another_process() -> None:
    vertices, triangles = bumpy(3)
    ball = environment({"shape": "sphere", "at": [0, 0, 0], "radius": 1})
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
        for env in (ball, _mesh_environment(body(vertices, triangles))):
            at = points(4)
            np.testing.assert_array_equal(pool.submit(env.release, at).result(), env.release(at))
