"""Species that share a space as files and pictures, read back."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import trimesh
from rooms import ROOM, SHELL, grid

from genome.errors import InputError
from growth.blocks.cohabitants import WRITERS, Cohabitants, body_of, without, write_cohabitants
from growth.blocks.cutaway import CUT, WALL, _walls, cutaway
from growth.blocks.lattice import CUBIC, ISOSPATIAL, SQUARE

NONE = np.empty((0, 3), dtype=np.int64)
DOOR = [(x, 0, 0) for x in range(1, 5)]
HOUSE = Cohabitants(CUBIC, np.array(SHELL), np.array(ROOM), np.array(DOOR))


def test_space_carves_walls_and_a_route_goes_before_both() -> None:
    solid = Cohabitants(CUBIC, np.array(grid(-2, 2)), np.array(ROOM), np.array(DOOR))
    shown = {species: {tuple(cell) for cell in cells.tolist()} for species, cells in solid.shown().items()}
    assert shown["route"] == set(DOOR)
    assert shown["space"] == set(ROOM) - set(DOOR)
    assert shown["enclosure"] == set(SHELL) - set(DOOR)
    assert set(HOUSE._replace(route=NONE).shown()) == {"enclosure", "space"}
    assert without(np.array(ROOM), np.array([(0, 0, 0)])).tolist() == [list(one) for one in ROOM if any(one)]


def test_a_glb_has_a_node_and_a_material_for_each_species_and_walls_are_seen_through(tmp_path: Path) -> None:
    write_cohabitants(HOUSE, tmp_path / "a.glb", "a house", {"fitness": 0.5})
    scene = trimesh.load_scene(tmp_path / "a.glb")
    assert set(scene.graph.nodes_geometry) == set(scene.geometry) == {"enclosure", "space", "route"}
    for name, mesh in scene.geometry.items():
        assert mesh.is_watertight
        assert mesh.visual.material.name == name
        clear = name == "enclosure"
        assert mesh.visual.material.alphaMode == ("BLEND" if clear else None)
        assert (mesh.visual.material.baseColorFactor[3] < 255) == clear
    assert {name: round(mesh.volume) for name, mesh in scene.geometry.items()} == {
        "enclosure": 97, "space": 26, "route": 4
    }  # fmt: skip
    assert scene.geometry["route"].bounds.tolist() == [[0.5, -0.5, -0.5], [4.5, 0.5, 0.5]]
    assert (scene.metadata["title"], scene.metadata["fitness"]) == ("a house", 0.5)
    turned = Cohabitants(CUBIC, np.array([(0, 1, 2)]), NONE, NONE)
    write_cohabitants(turned, tmp_path / "b.glb")
    assert trimesh.load_scene(tmp_path / "b.glb").bounds.tolist() == [[-0.5, 1.5, -1.5], [0.5, 2.5, -0.5]]


def test_the_same_cells_give_the_same_bytes(tmp_path: Path) -> None:
    for suffix in WRITERS:
        paths = [tmp_path / f"{name}{suffix}" for name in "ab"]
        for path in paths:
            write_cohabitants(HOUSE, path, "title", {"id": "3"})
        assert paths[0].read_bytes() == paths[1].read_bytes()


def test_a_voxel_says_who_has_a_cell_there(tmp_path: Path) -> None:
    many = Cohabitants(
        CUBIC, np.array([(0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0, 0)]),
        np.array([(4, 0, 0), (1, 0, 0), (3, 0, 0)]), np.array([(5, 0, 0), (2, 0, 0), (3, 0, 0), (7, 0, 0)]),
    )  # fmt: skip
    write_cohabitants(many, tmp_path / "a.npz", "t")
    with np.load(tmp_path / "a.npz") as arrays:
        assert arrays["grid"].ravel().tolist() == [1, 3, 5, 7, 2, 4, 0, 4]
        assert (arrays["grid"].dtype, arrays["origin"].tolist()) == (np.uint8, [0, 0, 0])
        assert (str(arrays["lattice"]), json.loads(str(arrays["extras"]))) == ("cubic", {"title": "t"})


def test_stl_holds_the_walls_and_obj_all(tmp_path: Path) -> None:
    write_cohabitants(HOUSE, tmp_path / "a.stl")
    assert trimesh.load(tmp_path / "a.stl").volume == pytest.approx(97.0)
    write_cohabitants(HOUSE._replace(enclosure=NONE), tmp_path / "b.stl")
    assert trimesh.load(tmp_path / "b.stl").volume == pytest.approx(30.0), "a room and the route that leads out"
    write_cohabitants(HOUSE, tmp_path / "a.obj", extras={"id": 3.0})
    lines = (tmp_path / "a.obj").read_text(encoding="utf-8").splitlines()
    assert [line for line in lines if line.startswith(("#", "o "))] == [
        "# id: 3.0",
        "o enclosure",
        "o space",
        "o route",
    ]


def test_what_cannot_be_written_is_told(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="expected cells to write, got none"):
        write_cohabitants(Cohabitants(CUBIC, NONE, NONE, NONE), tmp_path / "a.glb")
    with pytest.raises(InputError, match=r"expected a suffix of cells \(.glb, .obj, .stl, .npz\), got '.ply'"):
        write_cohabitants(HOUSE, tmp_path / "a.ply")
    far = Cohabitants(CUBIC, np.array([(0, 0, 0), (4000, 4000, 4000)]), NONE, NONE)
    with pytest.raises(InputError, match="a grid of 67108864 voxels"):
        write_cohabitants(far, tmp_path / "a.npz")
    assert list(tmp_path.iterdir()) == []


def test_the_walls_are_cut_at_the_middle_of_the_space_and_the_cut_is_dark() -> None:
    part, shades = _walls(np.array(SHELL), HOUSE, flat=False)
    left = [cell for cell in SHELL if cell[1] >= 0]
    kept = body_of(np.array(left), CUBIC)
    assert sorted(map(tuple, kept.cells[np.unique(part.owners)].tolist())) == sorted(left)
    dark = (shades == CUT).all(axis=1)
    assert set(map(tuple, shades.tolist())) == {CUT, WALL}
    centres = part.surface.vertices[part.surface.face_vertices.reshape(-1, 4)].mean(axis=1)
    assert dark.sum() == 16, "a ring of walls around nine cells of space"
    assert (centres[dark][:, 1] == -0.5).all()
    assert not dark[centres[:, 1] > -0.5].any()


def test_of_walls_beside_the_space_a_part_stays_and_alone_they_are_halved() -> None:
    away = Cohabitants(CUBIC, np.array([(0, y, 0) for y in range(4)]), np.array([(0, 9, 0)]), NONE)
    part, shades = _walls(away.enclosure, away, flat=False)
    assert sorted(set(part.owners.tolist())) == [0]
    assert (shades == CUT).all(axis=1).sum() == 1
    alone = away._replace(space=NONE)
    assert sorted(set(_walls(alone.enclosure, alone, flat=False)[0].owners.tolist())) == [0, 1]


def test_pictures_of_every_lattice_show_who_is_there() -> None:
    def seen(company: Cohabitants) -> np.ndarray:
        return np.asarray(cutaway(company, (120, 90)), dtype=np.float64)

    def warm(image: np.ndarray) -> float:
        return float((image[..., 0] - image[..., 2] > 60).mean())

    even = [cell for cell in grid(-3, 3) if sum(cell) % 2 == 0]
    ball = [cell for cell in even if np.square(cell).sum() <= 4]
    shell = [cell for cell in even if 4 < np.square(cell).sum() <= 9]
    plan = Cohabitants(
        SQUARE, np.array([cell for cell in grid(-2, 2, (0, 0)) if max(map(abs, cell)) == 2]),
        np.array(grid(-1, 1, (0, 0))), NONE,
    )  # fmt: skip
    pictures = [
        seen(company) for company in (HOUSE, Cohabitants(ISOSPATIAL, np.array(shell), np.array(ball), NONE), plan)
    ]
    assert all(warm(picture) > 0.02 for picture in pictures), "the space is seen"
    assert warm(seen(plan._replace(space=NONE))) == 0.0
    image = pictures[2]
    dark = image.max(axis=2) < 90
    rows, columns = np.nonzero(dark)
    middle = image[(rows.min() + rows.max()) // 2, (columns.min() + columns.max()) // 2]
    assert middle[0] - middle[2] > 60, "from above walls stand around the space"
    with pytest.raises(InputError, match="a form with faces to draw"):
        cutaway(Cohabitants(CUBIC, NONE, NONE, NONE))
