"""Pictures: what is seen where, determinism, and size."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from solids import environment
from surfaces import grid, surface

from genome.errors import InputError
from growth.bodies import solid_body, surface_body
from growth.camera import looking_at
from growth.environment.boundaries._kernels import BALL, BLOCK, DRUM
from growth.environment.boundaries.outlines import outline_of
from growth.forms import newell_normals
from growth.pictures import render, write_png

SIZE = (160, 120)
DRAPE = grid(6, lambda x, y: 0.4 * np.sin(x) * np.cos(y))


def _pixels(*arguments: object, **keys: object) -> np.ndarray:
    return np.asarray(render(*arguments, size=SIZE, **keys), dtype=float)


def _is_clay(pixels: np.ndarray) -> np.ndarray:
    return pixels[..., 0] > 1.25 * pixels[..., 2]


def test_the_same_form_gives_the_same_picture_and_small_bytes(tmp_path: Path) -> None:
    paths = [tmp_path / f"{name}.png" for name in "ab"]
    for path in paths:
        write_png(render(DRAPE, size=SIZE), path)
    assert paths[0].read_bytes() == paths[1].read_bytes()
    assert paths[0].stat().st_size < 40_000
    assert [path.name for path in sorted(tmp_path.iterdir())] == ["a.png", "b.png"]


def test_the_form_is_in_the_middle_on_white_with_a_shadow_beside_it() -> None:
    pixels = _pixels(DRAPE)
    clay = _is_clay(pixels)
    assert 0.15 < clay.mean() < 0.6
    rows, columns = np.nonzero(clay)
    assert abs(columns.mean() - 80) < 12
    assert abs(rows.mean() - 60) < 12
    assert clay[:4].sum() == clay[-4:].sum() == clay[:, :4].sum() == clay[:, -4:].sum() == 0
    assert pixels[0].min() > 235
    ground = pixels[~clay].mean(axis=1)
    assert ground.min() < 190
    assert np.median(ground) > 225


def test_edges_are_darker_than_faces() -> None:
    flat = grid(4)
    pixels = _pixels(flat, azimuth=-90.0, elevation=89.0, samples=4)
    camera = looking_at(flat.vertices, SIZE, -90.0, 89.0)
    middle = camera.seen(np.array([[1.5, 1.5, 0.0]]))[0].astype(int)
    edge = camera.seen(np.array([[1.5, 2.0, 0.0]]))[0].astype(int)
    assert pixels[edge[1] - 1 : edge[1] + 2, edge[0]].sum(axis=1).min() < 0.85 * pixels[middle[1], middle[0]].sum()


def test_a_diagonal_that_only_the_triangles_have_is_no_line() -> None:
    body = surface_body(DRAPE, (1, 0, 0), (0, 0, 1), 1.0)
    assert len(body) == 72
    assert (body.lines == 1.0).sum() == 4 * 36
    ball = solid_body(*outline_of(BALL, np.ones(3), 1.0), (1, 1, 1), 1.0)
    assert ball.lines.sum() == 0
    block = solid_body(*outline_of(BLOCK, np.ones(3), 1.0), (1, 1, 1), 1.0)
    assert (block.lines > 0).sum() == 24
    drum = solid_body(*outline_of(DRUM, np.ones(3), 1.0), (1, 1, 1), 1.0)
    assert (drum.lines > 0).sum() == 4 * 96


def test_a_balls_shading_normals_point_from_its_centre_and_a_blocks_along_its_axes() -> None:
    ball = solid_body(*outline_of(BALL, np.ones(3), 1.0), (1, 1, 1), 1.0)
    assert np.einsum("ijk,ijk->ij", ball.normals, ball.corners).min() > 0.999
    block = solid_body(*outline_of(BLOCK, np.ones(3), 1.0), (1, 1, 1), 1.0)
    np.testing.assert_allclose(
        block.normals, np.repeat(newell_normals(block.corners)[:, None] / 2, 3, axis=1), atol=1e-12
    )


def test_everything_fitted_is_within_the_picture_and_touches_its_margin() -> None:
    points = np.random.default_rng(5).normal(size=(300, 3)) * [5, 1, 2] + [100, -40, 7]
    for azimuth, elevation in ((-62.0, 27.0), (10.0, 80.0), (200.0, -5.0)):
        seen = looking_at(points, (400, 300), azimuth, elevation).seen(points)
        margin = np.array([400, 300]) * 0.07
        assert (seen >= margin - 1).all()
        assert (seen <= [400, 300] - margin + 1).all()
        filled = np.ptp(seen, axis=0) / ([400, 300] - 2 * margin)
        assert filled.max() > 0.97


def test_rays_and_places_seen_are_inverse() -> None:
    camera = looking_at(DRAPE.vertices, SIZE, -62.0, 27.0)
    places = np.array([[10.0, 20.0], [80.0, 60.0], [150.5, 3.25]])
    points = camera.eye + 7.0 * camera.rays(places[:, 0], places[:, 1])
    np.testing.assert_allclose(camera.seen(points), places, atol=1e-9)


def test_a_solid_is_shown_pale_a_container_as_glass_and_a_plane_as_ground() -> None:
    form = grid(2)
    alone = _pixels(form)
    ball = _pixels(form, environment({"shape": "sphere", "at": [1, 1, -1.5], "radius": 1.4}))
    assert _is_clay(ball).mean() < _is_clay(alone).mean()
    room = {"shape": "box", "at": [1, 1, 0], "size": [4, 4, 2], "solid": "outside"}
    glass = _pixels(form, environment(room))
    assert 0.02 < _is_clay(glass).mean() < _is_clay(alone).mean()
    floor = _pixels(form, environment({"shape": "plane", "at": [0, 0, -1]}))
    assert (floor != alone).any()
    assert floor[:3].min() > 235


def test_a_face_whose_corners_rest_on_a_sphere_is_not_hidden_by_it() -> None:
    side = np.linspace(-0.6, 0.6, 4)
    vertices = [(x, y, np.sqrt(1.0001 - x * x - y * y)) for y in side for x in side]
    faces = [(4 * j + i, 4 * j + i + 1, 4 * j + i + 5, 4 * j + i + 4) for j in range(3) for i in range(3)]
    cap = surface(vertices, [(0, 1)], faces)
    env = environment({"shape": "sphere", "at": [0, 0, 0], "radius": 1})
    pixels = _pixels(cap, env, azimuth=-90.0, elevation=60.0)
    camera = looking_at(np.concatenate([cap.vertices, env.boundaries[0].outline(1.0)[0]]), SIZE, -90.0, 60.0)
    for ring in faces:
        column, row = camera.seen(cap.vertices[list(ring)].mean(axis=0)).astype(int)
        assert _is_clay(pixels[row, column])


def test_several_surfaces_have_their_own_colours() -> None:
    pixels = _pixels([grid(2), grid(2, lambda x, y: 2.0)])
    assert _is_clay(pixels).any()
    assert (pixels[..., 2] > 1.25 * pixels[..., 0]).any()


def test_nothing_to_draw_and_nan_are_refused() -> None:
    with pytest.raises(InputError, match="a form with faces to draw"):
        render(surface([(0, 0, 0), (1, 0, 0)], [(0, 1)]))
    bad = grid(1)
    bad.vertices[0, 0] = np.nan
    with pytest.raises(InputError, match="finite coordinates"):
        render(bad)
    with pytest.raises(InputError, match="a file that can be written"):
        write_png(render(grid(1), size=(40, 30)), Path("/nonexistent/a.png"))


def test_a_form_that_is_one_point_or_a_line_is_drawn_without_a_crash() -> None:
    for scale in ([0, 0, 0], [1, 0, 0]):
        folded = grid(2)
        folded.vertices[:] *= scale
        assert np.isfinite(_pixels(folded)).all()
