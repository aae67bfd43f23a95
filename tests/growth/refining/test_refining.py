"""Refining: what each step promises of any form, and what is said where pymeshlab cannot be used."""

from __future__ import annotations

import sys

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from genome.errors import InputError
from growth.protocol import Failure
from growth.refining import STEPS, Mesh, RefineSettings, lab, parse_recipe, quality, refine
from growth.refining.clean import outward
from growth.refining.mesh import joined_at_places, pieces
from growth.refining.parting import parted
from growth.refining.union import touching, united

try:
    lab.load()
    USABLE, WHY = True, ""
except InputError as error:  # a bare machine
    USABLE, WHY = False, str(error)
with_pymeshlab = pytest.mark.skipif(not USABLE, reason=WHY)


def mesh_of(body: trimesh.Trimesh) -> Mesh:
    return Mesh(np.array(body.vertices, dtype=np.float64), np.array(body.faces, dtype=np.int32))


def sheet(count: int = 8, height: float = 0.0) -> Mesh:
    """A square of 2 by 2, (count + 1)^2 vertices; its waves are as high as asked for."""
    at = np.linspace(-1.0, 1.0, count + 1)
    x, y = (grid.reshape(-1) for grid in np.meshgrid(at, at))
    corner = (np.arange(count)[:, None] * (count + 1) + np.arange(count)).reshape(-1)
    first = np.stack([corner, corner + 1, corner + count + 2], axis=1)
    second = np.stack([corner, corner + count + 2, corner + count + 1], axis=1)
    vertices = np.stack([x, y, height * np.sin(5.0 * x) * np.cos(4.0 * y)], axis=1)
    return Mesh(vertices, np.concatenate([first, second]).astype(np.int32))


def refined(mesh: Mesh, recipe: str, **settings: object) -> Mesh:
    found = refine(mesh, parse_recipe(recipe), RefineSettings.model_validate(settings))
    assert isinstance(found, Mesh)
    return found


def test_quality_of_an_open_a_closed_and_a_crossing_form() -> None:
    box = mesh_of(trimesh.creation.box((1, 2, 3)))
    assert quality(box) == (True, True, True, 0, 0, 1, pytest.approx(6.0))
    assert quality(sheet(4)) == (False, True, True, 16, 0, 1, pytest.approx(0.0))
    apart = Mesh(np.concatenate([box.vertices, box.vertices + 9]), np.concatenate([box.triangles, box.triangles + 8]))
    assert quality(apart)[5:] == (2, pytest.approx(12.0))
    fin = Mesh(
        np.append(box.vertices, [[5.0, 5, 5]], axis=0), np.append(box.triangles, [[*box.triangles[0, :2], 8]], axis=0)
    )
    assert not quality(fin).manifold
    assert quality(fin).crossings == 1
    turned = box.triangles.copy()
    turned[0] = turned[0, ::-1]
    assert not quality(Mesh(box.vertices, turned)).oriented
    assert not quality(Mesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int32))).watertight


def test_pieces_are_joined_by_vertices() -> None:
    triangles = np.array([[0, 1, 2], [4, 5, 6], [2, 3, 0]], dtype=np.int32)
    assert pieces(triangles, 7).tolist() == [0, 1, 0]


def test_bodies_are_turned_outward_each_by_itself_and_sheets_are_not() -> None:
    box, flat = mesh_of(trimesh.creation.box()), sheet(2, 0.5)
    inner = Mesh(box.vertices + 5, box.triangles[:, ::-1])
    parts = (box, inner, flat, Mesh(flat.vertices + 9, flat.triangles[:, ::-1]))
    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    whole = Mesh(
        np.concatenate([part.vertices for part in parts]),
        np.concatenate([part.triangles + start for part, start in zip(parts, starts, strict=False)]),
    )
    turned = outward(whole).triangles
    assert (turned[:12] == whole.triangles[:12]).all()
    assert (turned[12:24] == whole.triangles[12:24][:, ::-1]).all()
    assert (turned[24:] == whole.triangles[24:]).all()


@with_pymeshlab
def test_cleaning_parts_crossings_and_makes_fronts_agree() -> None:
    box = mesh_of(trimesh.creation.box())
    triangles = box.triangles.copy()
    triangles[::3] = triangles[::3, ::-1]
    again = np.concatenate([triangles, triangles[:2], [[3, 3, 3]]])
    soup = Mesh(box.vertices[again].reshape(-1, 3), np.arange(3 * len(again), dtype=np.int32).reshape(-1, 3))
    found = quality(refined(soup, "clean"))
    assert found == (True, True, True, 0, 0, 1, pytest.approx(1.0))
    fin = Mesh(np.append(box.vertices, [[2.0, 2, 2]], axis=0), np.append(box.triangles, [[0, 1, 8]], axis=0))
    assert not quality(fin).manifold
    assert quality(refined(fin, "clean")).manifold


@with_pymeshlab
def test_remeshed_triangles_have_nearly_equal_sides_and_keep_the_form() -> None:
    box = mesh_of(trimesh.creation.box((2, 2, 2)))
    found = refined(box, "remesh", length=0.25)
    sides = np.linalg.norm(
        found.vertices[found.triangles] - np.roll(found.vertices[found.triangles], 1, axis=1), axis=2
    )
    assert quality(found).watertight
    assert quality(found).volume == pytest.approx(8.0, rel=0.01)
    assert 0.2 < float(np.median(sides)) < 0.3
    assert float(np.quantile(sides, 0.95) / np.quantile(sides, 0.05)) < 2.5


@with_pymeshlab
def test_smoothing_levels_noise_and_does_not_shrink() -> None:
    ball = trimesh.creation.icosphere(subdivisions=4)
    rng = np.random.default_rng(1)
    rough = Mesh(
        ball.vertices * (1.0 + 0.02 * rng.standard_normal((len(ball.vertices), 1))), ball.faces.astype(np.int32)
    )
    smoothed = refined(rough, "smooth", rounds=20)
    spread = [float(np.linalg.norm(mesh.vertices, axis=1).std()) for mesh in (rough, smoothed)]
    assert spread[1] < 0.4 * spread[0]
    assert quality(smoothed).volume == pytest.approx(4.0 / 3.0 * np.pi, rel=0.02)
    assert (smoothed.triangles == rough.triangles).all()


@with_pymeshlab
@pytest.mark.parametrize("height", [0.0, 0.2])
def test_a_surface_becomes_a_solid_of_the_thickness_asked_for(height: float) -> None:
    surface = sheet(12, height)
    found = refined(surface, "solid", thickness=0.1)
    area = trimesh.Trimesh(surface.vertices, surface.triangles).area
    assert quality(found).watertight
    assert quality(found).volume == pytest.approx(0.1 * area, rel=0.12)
    extent = np.ptp(found.vertices, axis=0) - np.ptp(surface.vertices, axis=0)
    assert (extent < 0.11).all()
    assert (extent > 0.02).all()


@with_pymeshlab
def test_a_solid_stays_as_it_is() -> None:
    box = mesh_of(trimesh.creation.box())
    assert refined(box, "solid").vertices.tolist() == refined(box, "clean").vertices.tolist()


@with_pymeshlab
@given(st.integers(0, 2**32 - 1))
def test_solid_of_any_triangles_is_watertight_and_the_same_each_time(seed: int) -> None:
    rng = np.random.default_rng(seed)
    soup = Mesh(rng.normal(size=(12, 3)), rng.permuted(np.tile(np.arange(12, dtype=np.int32), (6, 1)), axis=1)[:, :3])
    found = refined(soup, "solid", thickness=0.2)
    assert quality(found).watertight
    assert quality(found).volume > 0.0
    assert refined(soup, "solid", thickness=0.2).vertices.tobytes() == found.vertices.tobytes()


@with_pymeshlab
def test_what_is_not_a_form_fails_as_a_value() -> None:
    point = Mesh(np.ones((3, 3)), np.array([[0, 1, 2]], dtype=np.int32))
    assert refine(point, ("clean",)) == Failure("refining", "meshing_merge_close_vertices: the form has no area")
    assert refine(point, ("solid",)) == Failure("refining", "solid: the form has no extent")


def test_recipes_are_names_with_commas_or_blanks() -> None:
    assert parse_recipe("clean, remesh smooth,solid") == tuple(STEPS)
    with pytest.raises(
        InputError, match="--recipe: expected steps: clean, remesh, smooth, solid, got 'sold'; did you mean 'solid'"
    ):
        parse_recipe("clean,sold")
    with pytest.raises(InputError, match="got none"):
        parse_recipe(" , ")


@pytest.mark.parametrize(
    ("error", "told"),
    [
        (
            ImportError("libGL.so.1: cannot open shared object file"),
            "lacks libGL.so.1, which it needs; apt-get install libgl1",
        ),
        (ImportError("libfoo-2.so.3: cannot open"), "install the package that holds libfoo-2.so.3"),
        (ModuleNotFoundError("No module named 'pymeshlab'", name="pymeshlab"), "it is not installed; install it: pip"),
        (ImportError("a symbol is missing"), "it does not load: a symbol is missing"),
    ],
)
def test_what_pymeshlab_lacks_is_said(monkeypatch: pytest.MonkeyPatch, error: ImportError, told: str) -> None:
    class Lacking:
        def find_spec(self, name: str, *_: object) -> None:
            if name == "pymeshlab":
                raise error

    monkeypatch.delitem(sys.modules, "pymeshlab", raising=False)
    monkeypatch.setattr(sys, "meta_path", [Lacking(), *sys.meta_path])
    with pytest.raises(InputError) as caught:
        lab.load()
    assert told in str(caught.value)


def cubes(*places: tuple[int, int, int]) -> Mesh:
    """The outer faces of unit cubes of a grid, corners at one place being one vertex."""
    taken = set(places)
    faces = [(axis, side) for axis in range(3) for side in (0, 1)]
    rings = []
    for place in places:
        for axis, side in faces:
            beside = tuple(place[at] + (2 * side - 1) * (at == axis) for at in range(3))
            if beside in taken:
                continue
            one, other = (axis + 1) % 3, (axis + 2) % 3
            ring = np.zeros((4, 3), dtype=np.int64) + place
            ring[:, axis] += side
            ring[[1, 2], one] += 1
            ring[[2, 3], other] += 1
            rings.append(ring if side else ring[::-1])
    corners = np.array(rings)
    vertices, numbers = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    quads = numbers.reshape(-1, 4)
    return Mesh(vertices.astype(float), np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]).astype(np.int32))


BODIES = {
    "two that share an edge": [(0, 0, 0), (1, 1, 0)],
    "two that share a corner": [(0, 0, 0), (1, 1, 1)],
    "one that touches itself": [(0, 0, 0), (1, 0, 0), (1, 0, 1), (1, 1, 1), (0, 1, 1), (0, 1, 2), (0, 0, 2)],
    "four round an edge that they do not fill": [(0, 0, 0), (1, 1, 0), (0, 0, 1), (1, 1, 1), (2, 1, 0), (2, 0, 0)],
    "a board of chess": [(x, y, 0) for x in range(4) for y in range(4) if (x + y) % 2],
}


@pytest.mark.parametrize("name", BODIES)
def test_bodies_that_touch_are_parted_and_stay_closed(name: str) -> None:
    body = cubes(*BODIES[name])
    assert quality(body).volume == pytest.approx(len(BODIES[name]))
    found = quality(parted(body))
    assert found[:5] == (True, True, True, 0, 0)
    assert found.volume == pytest.approx(len(BODIES[name]))


@given(st.sets(st.tuples(st.integers(0, 2), st.integers(0, 2), st.integers(0, 2)), min_size=1))
def test_any_body_of_cubes_is_parted_into_closed_sides(places: set[tuple[int, int, int]]) -> None:
    found = quality(parted(cubes(*sorted(places))))
    assert found[:5] == (True, True, True, 0, 0)
    assert found.volume == pytest.approx(len(places))


@with_pymeshlab
@pytest.mark.parametrize("name", BODIES)
def test_bodies_that_touch_become_one_by_welds_alone(name: str) -> None:
    found = refined(cubes(*BODIES[name]), "solid")
    assert quality(joined_at_places(found)).watertight
    assert not any(map(len, touching(joined_at_places(found))))
    assert quality(found).parts == 1
    assert quality(found).volume == pytest.approx(len(BODIES[name]), abs=1e-3)


@with_pymeshlab
@settings(max_examples=25)
@given(st.sets(st.tuples(st.integers(0, 2), st.integers(0, 2), st.integers(0, 2)), min_size=1))
def test_a_solid_of_cubes_has_their_volume_and_their_hollows(places: set[tuple[int, int, int]]) -> None:
    # Each cube with all its faces: those that two share stand twice, as where two species touch.
    alone = [cubes(place) for place in sorted(places)]
    starts = 8 * np.arange(len(alone), dtype=np.int32)
    whole = Mesh(
        np.concatenate([one.vertices for one in alone]),
        np.concatenate([one.triangles + start for one, start in zip(alone, starts, strict=True)]),
    )
    found = refined(whole, "solid")
    assert quality(joined_at_places(found)).watertight
    assert quality(found).volume == pytest.approx(len(places), abs=5e-3)
    assert np.ptp(found.vertices, axis=0) == pytest.approx(np.ptp(whole.vertices, axis=0), abs=0.02)


@with_pymeshlab
def test_bodies_that_overlap_count_once_and_one_turned_inside_out_is_wrapped() -> None:
    box = trimesh.creation.box()
    shifted = box.vertices + np.array([0.5, 0.0, 0.0])  # their sides lie in one plane
    both = np.concatenate([box.vertices, shifted])
    found = refined(Mesh(both, np.concatenate([box.faces, box.faces + 8]).astype(np.int32)), "solid")
    assert quality(found).watertight
    assert quality(found).volume == pytest.approx(1.5)
    inward = Mesh(both + 0.0, np.concatenate([box.faces[:, ::-1], box.faces[:, ::-1] + 8]).astype(np.int32))
    assert isinstance(united(inward), Failure)
    assert quality(refined(inward, "solid")).volume == pytest.approx(1.5, rel=0.05)


def test_sides_that_do_not_go_in_pairs_are_parted_each_by_itself() -> None:
    fan = np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]], dtype=np.int32)
    vertices = np.array([[0, 0, 0], [0, 0, 1], [1, 0, 0], [-1, 1, 0], [-1, -1, 0]], dtype=float)
    found = parted(Mesh(vertices, fan))
    assert len(found.vertices) == 9
    assert quality(found).manifold


@with_pymeshlab
def test_blocks_that_touch_are_cleaned_and_hollows_stay() -> None:
    found = refined(cubes(*BODIES["a board of chess"]), "clean")
    assert quality(found)[:5] == (True, True, True, 0, 0)
    outer, inner = trimesh.creation.icosphere(radius=2.0), trimesh.creation.icosphere(radius=1.0)
    hollow = Mesh(
        np.concatenate([outer.vertices, inner.vertices]),
        np.concatenate([outer.faces, inner.faces[:, ::-1] + len(outer.vertices)]).astype(np.int32),
    )
    for step in ("clean", "solid"):
        assert quality(refined(hollow, step)).volume == pytest.approx(outer.volume - inner.volume)


@with_pymeshlab
@pytest.mark.parametrize(
    ("recipe", "settings", "told"),
    [
        ("solid", {"thickness": 1e-6}, "solid: a thickness of 1e-06 is less than can be wrapped (0.005657, 0.002 of"),
        ("remesh", {"length": 1e-6}, "remesh: edges of 1e-06 are shorter than can be made (0.002828, 0.001 of"),
    ],
)
def test_what_would_take_for_ever_is_refused(recipe: str, settings: dict[str, float], told: str) -> None:
    found = refine(sheet(4), parse_recipe(recipe), RefineSettings.model_validate(settings))
    assert isinstance(found, Failure)
    assert found.detail.startswith(told)


@with_pymeshlab
@pytest.mark.parametrize("recipe", list(STEPS))
def test_triangles_in_a_line_have_no_area(recipe: str) -> None:
    line = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]]), np.array([[0, 1, 2]], dtype=np.int32))
    found = refine(line, (recipe,))
    assert isinstance(found, Failure)
    assert found.detail.endswith("the form has no area")
