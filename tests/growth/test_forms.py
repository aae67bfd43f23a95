"""Triangles of faces, and files that are read back."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from genome.errors import InputError
from growth.forms import newell_normals, to_trimesh, triangulate, write_form
from growth.surface import Surface

SUFFIXES = (".glb", ".obj", ".ply", ".stl")


def surface_of(vertices: object, *rings: list[int]) -> Surface:
    edges = sorted({tuple(sorted((a, b))) for ring in rings for a, b in zip(ring, ring[1:] + ring[:1], strict=True)})
    return Surface(
        vertices=np.array(vertices, dtype=np.float64),
        edges=np.array(edges, dtype=np.int32).reshape(-1, 2),
        labels=np.zeros(len(edges), dtype=np.int32),
        label_names=("A",),
        face_starts=np.cumsum([0, *map(len, rings)]).astype(np.int32),
        face_vertices=np.array([v for ring in rings for v in ring], dtype=np.int32),
    )


def draped() -> Surface:
    side = np.linspace(-2, 2, 9)
    vertices = [[x, y, np.sin(x) * np.cos(1.3 * y) + 1 / 3] for y in side for x in side]
    rings = [[9 * j + i, 9 * j + i + 1, 9 * j + i + 10, 9 * j + i + 9] for j in range(8) for i in range(8)]
    first = rings.pop(0)
    return surface_of(vertices, [first[0], first[1], first[2]], [first[0], first[2], first[3]], *rings, [0, 1])


def _read(path: Path) -> tuple[np.ndarray, float]:
    import trimesh

    mesh = trimesh.load_scene(path, process=False).to_mesh()
    vertices = np.array(mesh.vertices)
    if path.suffix == ".glb":
        vertices = np.stack([vertices[:, 0], -vertices[:, 2], vertices[:, 1]], axis=1)
    return vertices, float(mesh.area)


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_file_is_read_back_with_the_same_vertices_and_area(suffix: str, tmp_path: Path) -> None:
    form = draped()
    path = tmp_path / f"form{suffix}"
    write_form(form, path, title="Drape \u00e9\n2", extras={"fitness": 0.5})
    vertices, area = _read(path)
    tolerance = {".obj": 0.0, ".ply": 0.0}.get(suffix, 1e-6)
    expected = form.vertices if suffix != ".stl" else form.vertices[triangulate(form)[1]].reshape(-1, 3)
    np.testing.assert_allclose(vertices, expected, rtol=0, atol=tolerance)
    assert area == pytest.approx(to_trimesh(form).area, rel=2e-2 if suffix == ".obj" else 1e-6)
    assert [p.name for p in tmp_path.iterdir()] == [path.name]


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_the_same_surface_gives_the_same_bytes(suffix: str, tmp_path: Path) -> None:
    paths = [tmp_path / f"{name}{suffix}" for name in "ab"]
    for path in paths:
        write_form(draped(), path, title="Drape")
    assert paths[0].read_bytes() == paths[1].read_bytes()


def test_an_obj_keeps_the_polygons_and_every_digit(tmp_path: Path) -> None:
    form = surface_of([[0, 0, 1 / 3], [1, 0, 0.1], [1, 1, 0], [0.5, 1.5, 0], [0, 1, 1e-300]], [0, 1, 2, 3, 4], [0, 1])
    write_form(form, tmp_path / "form.obj")
    lines = (tmp_path / "form.obj").read_text(encoding="utf-8").splitlines()
    assert [line for line in lines if line.startswith("f ")] == ["f 1 2 3 4 5"]
    read = [[float(word) for word in line.split()[1:]] for line in lines if line.startswith("v ")]
    np.testing.assert_array_equal(read, form.vertices)


def test_a_glb_has_a_double_sided_material_and_its_title(tmp_path: Path) -> None:
    import trimesh

    write_form(draped(), tmp_path / "form.glb", title="Drape", extras={"fitness": 0.25})
    scene = trimesh.load_scene(tmp_path / "form.glb")
    (mesh,) = scene.geometry.values()
    assert mesh.visual.material.doubleSided
    assert scene.metadata["title"] == "Drape"
    assert scene.metadata["fitness"] == 0.25


def test_a_reflex_quadrangle_is_cut_within_itself() -> None:
    for shift in range(4):
        ring = list(np.roll([0, 1, 2, 3], shift))
        form = surface_of([[0, 0, 0], [2, 0, 0], [0.5, 0.5, 0], [0, 2, 0]], [int(v) for v in ring])
        vertices, triangles = triangulate(form)
        np.testing.assert_allclose(newell_normals(vertices[triangles])[:, 2].sum(), 1.0)
        assert (newell_normals(vertices[triangles])[:, 2] > 0).all()


def test_a_reflex_polygon_is_cut_within_itself_on_any_plane() -> None:
    flat = np.array([[0, 0], [4, 0], [4, 4], [3, 4], [3, 1], [1, 1], [1, 4], [0, 4]], dtype=float)
    for axes in ([0, 1, 2], [1, 2, 0], [2, 0, 1]):
        for ring in (list(range(8)), list(range(7, -1, -1))):
            vertices = np.zeros((8, 3))
            vertices[:, axes[0]], vertices[:, axes[1]] = flat[:, 0], flat[:, 1]
            form = surface_of(vertices, ring)
            normals = newell_normals(form.vertices[triangulate(form)[1]])
            whole = newell_normals(form.vertices[ring])
            assert len(normals) == 6
            assert (normals @ whole > 0).all()
            np.testing.assert_allclose(normals.sum(axis=0), whole)
            np.testing.assert_allclose(np.linalg.norm(normals, axis=1).sum(), 10.0)


@settings(max_examples=80, deadline=None)
@given(st.integers(3, 9), st.integers(0, 10_000), st.sampled_from(["any", "flat", "line", "point"]))
def test_any_ring_gives_two_triangles_less_than_corners_and_its_own_area_vector(n: int, seed: int, kind: str) -> None:
    vertices = np.random.default_rng(seed).normal(size=(n, 3))
    vertices[:, {"any": 3, "flat": 2, "line": 1, "point": 0}[kind] :] = 0.0
    form = surface_of(vertices, list(range(n)))
    _, triangles = triangulate(form)
    assert triangles.shape == (n - 2, 3)
    assert triangles.dtype == np.int32
    if n <= 4:
        areas = newell_normals(vertices[triangles]).sum(axis=0)
        np.testing.assert_allclose(areas, newell_normals(vertices), atol=1e-12)


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_folded_faces_are_written(suffix: str, tmp_path: Path) -> None:
    form = surface_of(np.zeros((6, 3)), [0, 1, 2], [0, 1, 2, 3], [0, 1, 2, 3, 4, 5])
    write_form(form, tmp_path / f"form{suffix}")
    assert (tmp_path / f"form{suffix}").stat().st_size > 0


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_surface_without_faces_is_refused_and_leaves_nothing(suffix: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="expected a form with faces to write, got none of three or more corners"):
        write_form(surface_of(np.zeros((2, 3)), [0, 1]), tmp_path / f"form{suffix}")
    assert list(tmp_path.iterdir()) == []


def test_refusals_of_suffix_nan_and_folder(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"a form's suffix \(\.glb, \.obj, \.ply, \.stl\), got '\.fbx'"):
        write_form(draped(), tmp_path / "form.fbx")
    with pytest.raises(InputError, match="got none; choose one of these"):
        write_form(draped(), tmp_path / "form")
    with pytest.raises(InputError, match="a file that can be written, got no such file or directory; check the folder"):
        write_form(draped(), tmp_path / "none" / "form.glb")
    (tmp_path / "form.glb").mkdir()
    with pytest.raises(InputError, match="a file that can be written, got is a directory"):
        write_form(draped(), tmp_path / "form.glb")
    bad = draped()
    bad.vertices[0, 0] = np.nan
    with pytest.raises(InputError, match="a form with finite coordinates, got NaN or infinity"):
        write_form(bad, tmp_path / "nan.obj")
    assert [p.name for p in tmp_path.iterdir()] == ["form.glb"]
