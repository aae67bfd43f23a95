"""Skins and files of block bodies, read back."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from genome.errors import InputError
from genome.lsystem import LSystem, parse_word
from growth.blocks import BlockGrowth, Body, body_surface, grow, stand
from growth.blocks.body import BOUNDARY, ENVELOPE, INTERNAL, SYSTEMS
from growth.blocks.forms import WRITERS, write_form
from growth.blocks.lattice import LATTICES
from growth.blocks.parts import ramp
from growth.blocks.pictures import body_picture
from growth.environment.boundaries.files import read_mesh
from growth.forms import to_trimesh

CELLS = st.lists(st.tuples(*[st.integers(-2, 2)] * 3), min_size=1, max_size=25, unique=True)


def body_of(word: str, **growth: object) -> Body:
    body = grow(LSystem(parse_word(word), (), 0, 0), BlockGrowth(**growth))
    assert isinstance(body, Body)
    return body


WRAPPED = body_of("FF[&FF|+^F]F", envelope=True)


@pytest.mark.parametrize("lattice", sorted(LATTICES))
@settings(max_examples=150, deadline=None)
@given(cells=CELLS)
def test_a_skin_is_closed_and_holds_the_cells(lattice: str, cells: list) -> None:
    of = LATTICES[lattice]
    cells = [cell for cell in cells if not of.parity or sum(cell) % 2 == 0]
    if not cells:
        return
    body = stand(np.array(cells), BlockGrowth(lattice=lattice))
    surface = body_surface(body, [INTERNAL])
    rings = surface.face_vertices.reshape(-1, 4)
    runs = Counter(pair for ring in rings.tolist() for pair in zip(ring, ring[1:] + ring[:1], strict=True))
    assert all(runs[a, b] == runs[b, a] for a, b in runs)
    assert len(surface.edges) == len({frozenset(pair) for pair in runs})
    assert len(np.unique(surface.vertices, axis=0)) == len(surface.vertices) == len(np.unique(rings))
    mesh = to_trimesh(surface)
    assert mesh.volume == pytest.approx(of.volume * len(cells))
    ways = [tuple(of.offsets[of.contacts == 0][k].tolist()) for k in range((of.contacts == 0).sum())]
    bare = sum((x + a, y + b, z + c) not in cells for x, y, z in cells for a, b, c in ways)
    assert len(rings) == bare
    if max(runs.values()) == 1:
        assert mesh.is_watertight


def test_the_skin_of_a_block_a_bar_and_a_ring_is_a_manifold_of_its_genus() -> None:
    assert body_surface(body_of("Z"), [INTERNAL]).counts == (8, 12, 6)
    assert body_surface(body_of("FF"), [INTERNAL]).counts == (16, 28, 14)
    ring = body_of("FF&&FF&&FF&&F")
    mesh = to_trimesh(body_surface(ring, [INTERNAL]))
    assert (mesh.is_watertight, mesh.euler_number) == (True, 0)
    assert body_surface(body_of("Z", lattice="isospatial"), [INTERNAL]).counts == (14, 24, 12)
    whole = body_of("Z")
    assert body_surface(whole).counts == (12, 20, 10)
    assert body_surface(whole, [ENVELOPE]).counts == (0, 0, 0)


@pytest.mark.parametrize("suffix", [".glb", ".obj", ".stl"])
@pytest.mark.parametrize("with_forces", [False, True])
def test_a_file_is_read_back_with_its_systems(suffix: str, with_forces: bool, tmp_path: Path) -> None:
    forces = np.linspace(0.0, 1.0, len(WRAPPED.cells)) if with_forces else None
    path = tmp_path / f"body{suffix}"
    write_form(WRAPPED, path, "A body", {"height": 3.0}, forces)
    scene = trimesh.load_scene(path, process=False, **({"split_objects": True} if suffix == ".obj" else {}))
    if suffix != ".stl":
        assert sorted(scene.geometry) == sorted(SYSTEMS)
    for name, mesh in scene.geometry.items():
        chosen = (INTERNAL, ENVELOPE, BOUNDARY) if suffix == ".stl" else [SYSTEMS.index(name)]
        expected = to_trimesh(body_surface(WRAPPED, chosen))
        vertices = np.array(mesh.vertices)
        if suffix == ".glb":
            vertices = np.stack([vertices[:, 0], -vertices[:, 2], vertices[:, 1]], axis=1)
        assert sorted(map(tuple, vertices[mesh.faces].mean(axis=1).round(6))) == sorted(
            map(tuple, expected.triangles.mean(axis=1).round(6))
        )
        assert abs(mesh.volume) == pytest.approx(expected.volume)
    if suffix == ".obj" and not with_forces:
        text = path.read_text(encoding="utf-8")
        assert text.startswith("# title: A body\n# height: 3.0\no internal\nv ")
        assert text.count("\nf ") == sum(len(body_surface(WRAPPED, [s]).face_starts) - 1 for s in range(3))
    if suffix == ".glb":
        assert scene.metadata["title"] == "A body"
        assert scene.metadata["height"] == 3.0


def test_a_glb_has_three_materials_and_shows_forces(tmp_path: Path) -> None:
    forces = np.zeros(len(WRAPPED.cells))
    forces[0] = 1.0
    write_form(WRAPPED, tmp_path / "plain.glb")
    write_form(WRAPPED, tmp_path / "forces.glb", forces=forces)
    materials = [m.visual.material for m in trimesh.load_scene(tmp_path / "plain.glb").geometry.values()]
    assert [material.name for material in materials] == list(SYSTEMS)
    assert [material.alphaMode for material in materials] == [None, "BLEND", None]
    assert [material.baseColorFactor[3] for material in materials] == [255, 70, 255]
    assert len({tuple(material.baseColorFactor) for material in materials}) == 3
    internal = trimesh.load_scene(tmp_path / "forces.glb", process=False).geometry["internal"]
    vertices, colours = np.array(internal.vertices), internal.visual.vertex_attributes["color"]
    assert internal.visual.material.baseColorFactor.tolist() == [255, 255, 255, 255]
    lowest = vertices[:, 1] < 0.0
    light = np.rint(255.0 * ramp(np.array([0.0, 1.0])) ** 2.2)
    assert lowest.any()
    assert (colours[lowest, :3] == light[1]).all()
    assert (colours[vertices[:, 1] > 0.6][:, :3] == light[0]).all()


def test_an_obj_shows_forces_as_colours_of_vertices(tmp_path: Path) -> None:
    body = body_of("F")
    write_form(body, tmp_path / "x.obj", forces=np.array([0.0, 1.0, 0.5]))
    rows = [
        line.split()[1:] for line in (tmp_path / "x.obj").read_text(encoding="utf-8").splitlines() if line[0] == "v"
    ]
    assert {len(row) for row in rows} == {6}
    shades = {tuple(float(value) for value in row[3:]) for row in rows}
    assert shades == {tuple(shade) for shade in ramp(np.array([0.0, 0.5, 1.0])).round(3).tolist()}


@pytest.mark.parametrize("lattice", sorted(LATTICES))
def test_a_grid_holds_every_cell_and_its_system(lattice: str, tmp_path: Path) -> None:
    body = body_of("F[&FF|+^F]F", envelope=True, lattice=lattice)
    forces = np.linspace(0.0, 1.0, len(body.cells))
    write_form(body, tmp_path / "x.npz", "A body", {"height": 3.0}, forces)
    with np.load(tmp_path / "x.npz") as data:
        cells = np.argwhere(data["grid"] > 0)
        assert (cells + data["origin"]).tolist() == sorted(body.cells.tolist())
        assert [data["grid"][tuple(cell - data["origin"])] for cell in body.cells] == (body.systems + 1).tolist()
        assert [data["forces"][tuple(cell - data["origin"])] for cell in body.cells] == forces.astype(
            np.float32
        ).tolist()
        assert str(data["lattice"]) == lattice
        assert json.loads(str(data["extras"])) == {"title": "A body", "height": 3.0}


@pytest.mark.parametrize("suffix", sorted(WRITERS))
def test_the_same_body_gives_the_same_bytes(suffix: str, tmp_path: Path) -> None:
    paths = [tmp_path / f"{name}{suffix}" for name in "ab"]
    for path in paths:
        write_form(WRAPPED, path, forces=np.linspace(0, 1, len(WRAPPED.cells)))
    assert paths[0].read_bytes() == paths[1].read_bytes()


@pytest.mark.parametrize("suffix", [".glb", ".obj", ".stl"])
def test_a_body_is_a_boundary_that_surfaces_can_grow_against(suffix: str, tmp_path: Path) -> None:
    """Cells that touch in an edge alone too: every file is closed, whatever the body."""
    body = body_of("F&FF+F^F[&&F]F")
    write_form(body, tmp_path / f"x{suffix}")
    vertices, triangles = read_mesh(tmp_path / f"x{suffix}", "here")
    corners = vertices[triangles]
    volume = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6.0
    assert volume == pytest.approx(len(body.cells))


def test_what_cannot_be_written_is_told(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"expected a block body's suffix \(\.glb, \.obj, \.stl, \.npz\), got '\.ply'"):
        write_form(WRAPPED, tmp_path / "x.ply")
    with pytest.raises(InputError, match="expected forces from 0 to 1, one a cell"):
        write_form(WRAPPED, tmp_path / "x.glb", forces=np.zeros(3))
    with pytest.raises(InputError, match="expected forces from 0 to 1, one a cell"):
        write_form(WRAPPED, tmp_path / "x.glb", forces=np.full(len(WRAPPED.cells), np.nan))
    far = stand(np.array([[0, 0, 0], [4000, 4000, 4000]]))
    with pytest.raises(InputError, match="expected a body within a grid of 67108864 voxels, got 4001 by 4001 by 4002"):
        write_form(far, tmp_path / "x.npz")
    none = stand(np.empty((0, 3), dtype=np.int64))
    with pytest.raises(InputError, match="expected a body with cells to write, got none"):
        write_form(none, tmp_path / "x.glb")
    assert list(tmp_path.iterdir()) == []


def test_a_picture_shows_clay_on_stone_glass_around_it_and_forces() -> None:
    def seen(body: Body, forces: np.ndarray | None = None) -> np.ndarray:
        return np.asarray(body_picture(body, forces, size=(120, 120)), dtype=float)

    def reddish(pixels: np.ndarray) -> float:
        return float((pixels[..., 0] > 1.25 * pixels[..., 2]).mean())

    bare = body_of("FFF")
    clay = reddish(seen(bare))
    assert 0.02 < clay < 0.3
    assert 0.0 < reddish(seen(body_of("FFF", envelope=True))) < clay
    forces = np.zeros(len(bare.cells))
    assert reddish(seen(bare, forces)) < 0.001
    forces[:] = 1.0
    assert reddish(seen(bare, forces)) > clay  # the foundation is red too
