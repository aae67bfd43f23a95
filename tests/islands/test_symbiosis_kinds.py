"""The kinds of enclosures, spaces and routes: who is valid, who is whose partner, sites, forms."""

from __future__ import annotations

import json

import numpy as np
import pytest
import trimesh
from block_bodies import COLUMN, blocks, system
from rooms import ROOM, SHELL, SPECIES, grid, partner, species, species_spec

from evaluators.symbiosis import LOGGED
from genome.errors import InputError
from growth.blocks import CellGrowth, grow_cells
from growth.blocks.lattice import CUBIC, ISOSPATIAL, SQUARE
from growth.environment.boundaries.mesh import PlacedSettings, placed_mesh
from islands.individual import Evaluation
from islands.kinds.blocks import FORMATS
from islands.kinds.cells import cells_text, read_cells_text
from islands.kinds.meshes import read_mesh_text
from islands.kinds.protocol import Accompanied, Situated, Symbiotic
from islands.migration.channel import Migrant
from islands.spec import IslandSpec

LONG = system("axiom: F\niterations: 3\nF -> FF\n")
"""Grows nine cells on top of each other."""

BUSY = system("axiom: F[+F|&FF]F\niterations: 2\nF -> F[^F]+F\n")


def scores(found: Evaluation) -> dict[str, float]:
    assert found.error == ""
    return dict(found.scores)


def cells_of(biology, genotype) -> list[tuple[int, ...]]:
    return [tuple(cell) for cell in biology.grown(genotype).tolist()]


@pytest.mark.parametrize("role", SPECIES)
def test_a_biology_takes_partners_and_surroundings(role) -> None:
    biology = species(role)
    assert isinstance(biology, Symbiotic)
    assert isinstance(biology, Accompanied)
    assert isinstance(biology, Situated)


@pytest.mark.parametrize("role", SPECIES)
def test_alone_shares_are_nought_and_one_s_own_cells_are_counted(role) -> None:
    told = scores(species(role).evaluate(LONG))
    assert set(told) == set(LOGGED)
    assert [told[name] for name in ("enclosure_share", "space_share", "symbiotic", "flood", "visibility")] == [0.0] * 5
    counts = {name: told[f"{name}_cells"] for name in SPECIES}
    assert counts == {name: 9.0 if name == role else 0.0 for name in SPECIES}


def test_a_room_in_its_closed_shell_is_surrounded_and_open_it_is_not() -> None:
    biology = species("space", start=(0, 0, -1), surrounded="flood", least=3)
    column = system("axiom: FF\niterations: 0\n")
    assert cells_of(biology, column) == [(0, 0, -1), (0, 0, 0), (0, 0, 1)]
    closed = scores(biology.evaluate_with(column, (partner("enclosure", SHELL),)))
    assert (closed["space_share"], closed["enclosure_share"]) == (1.0, pytest.approx(3 / 27))
    assert (closed["enclosure_cells"], closed["enclosed"]) == (98.0, 27.0)
    hole = [cell for cell in SHELL if not (cell[0] == 2 and max(map(abs, cell[1:])) <= 1)]
    assert scores(biology.evaluate_with(column, (partner("enclosure", hole),)))["space_share"] == 0.0


def test_several_partners_of_one_species_are_one() -> None:
    biology = species("space", start=(0, 0, -1), surrounded="flood", least=3)
    column = system("axiom: FF\niterations: 0\n")
    halves = [[cell for cell in SHELL if cell[2] < 1], [cell for cell in SHELL if cell[2] > -1]]
    apart = [scores(biology.evaluate_with(column, (partner("enclosure", half),))) for half in halves]
    assert [one["space_share"] for one in apart] == [0.0, 0.0]
    both = scores(biology.evaluate_with(column, tuple(partner("enclosure", half) for half in halves)))
    assert (both["space_share"], both["enclosure_cells"]) == (1.0, 98.0)


def test_three_species_are_scored_together() -> None:
    walk = system("axiom: &&FFFF\niterations: 0\n")
    route = species("route", start=(0, 0, 0))
    assert cells_of(route, walk) == [(x, 0, 0) for x in range(5)]
    told = scores(route.evaluate_with(walk, (partner("enclosure", SHELL), partner("space", ROOM, 8))))
    assert (told["enclosure_cells"], told["space_cells"], told["route_cells"]) == (98.0, 27.0, 5.0)
    assert (told["doors"], told["route_joins"], told["route_reaches"], told["flood"]) == (1.0, 1.0, 1.0, 1.0)


def test_what_is_too_little_is_invalid_with_a_reason() -> None:
    found = species("space").evaluate(system("axiom: FF\niterations: 0\n"))
    assert (found.fitness, found.error) == (None, "small: 3 of the 8 cells that it has at least")
    assert species("enclosure").evaluate(system("axiom: FF\niterations: 0\n")).error == ""
    away = species(
        "enclosure", site={"environment": {"boundaries": [{"shape": "sphere", "at": [0, 0, 5], "radius": 3}]}}
    )
    assert cells_of(away, LONG) == [(0, 0, z) for z in (0, 1, 2, 8)], "on its surface is not in it"
    assert species("enclosure", max_blocks=4).evaluate(LONG).error.startswith("budget: ")


@pytest.mark.parametrize("lattice", [CUBIC, ISOSPATIAL, SQUARE], ids=lambda lattice: lattice.name)
def test_cells_survive_their_text(lattice) -> None:
    cells = grow_cells(BUSY, CellGrowth(lattice=lattice.name))
    assert isinstance(cells, np.ndarray)
    role, found = read_cells_text(cells_text("route", lattice, cells), lattice)
    assert role == "route"
    assert found.tolist() == cells.tolist()
    biology = species("route", lattice=lattice.name)
    assert read_cells_text(biology.offer(BUSY, "partners"), lattice)[1].tolist() == cells.tolist()
    assert biology.decode(biology.offer(BUSY, "migrants")) == BUSY


BAD = [
    "", "[]", '{"role":"space","lattice":"cubic","cells":[]}',
    '{"role":"space","lattice":"isospatial","cells":[[0,0,0]]}',
    '{"role":"roof","lattice":"cubic","cells":[[0,0,0]]}', '{"role":"space","lattice":"cubic","cells":[[0,0,0.5]]}',
    '{"role":"space","lattice":"cubic","cells":[[0,0]]}', '{"role":"space","lattice":"cubic","cells":[[0,0,true]]}',
    '{"role":"space","lattice":"cubic","cells":[[0,0,9999999]]}',
    '{"role":"space","lattice":"cubic","cells":[[0,0,0]],"a":1}',
]  # fmt: skip


@pytest.mark.parametrize("text", BAD)
def test_a_partner_that_is_none_is_refused(text) -> None:
    with pytest.raises(InputError, match="expected cells of a species on the lattice cubic"):
        species("enclosure").evaluate_with(LONG, (Migrant(1, text, 1.0, (), ""),))
    with pytest.raises(InputError, match="expected one of another species than 'enclosure'"):
        species("enclosure").evaluate_with(LONG, (partner("enclosure", SHELL),))


def test_what_is_given_and_taken_names_species_and_lattice() -> None:
    made: list[IslandSpec] = [species_spec("space", lattice=name) for name in ("cubic", "square")]
    kinds = {role: kind() for role, kind in SPECIES.items()}
    assert [kinds["space"].gives(one)["partners"] for one in made] == ["space on cubic", "space on square"]
    assert kinds["space"].takes(made[0])["partners"] == ("enclosure on cubic", "route on cubic")
    assert kinds["route"].needed(made[1]) == {"partners": ("enclosure on square", "space on square")}
    assert kinds["enclosure"].needed(made[0]) == {"partners": ("space on cubic",)}
    assert kinds["space"].needed(made[0]) == {"partners": ("enclosure on cubic",)}
    assert {role: kind.gives(made[0]).get("surroundings") for role, kind in kinds.items()} == {
        "enclosure": "mesh", "space": None, "route": None
    }  # fmt: skip


def test_the_scoring_key_is_of_all_that_a_fitness_hangs_on() -> None:
    box = {"boundaries": [{"shape": "box", "at": [9, 9, 9], "size": [3, 3, 3]}]}
    keys = [
        species("space").scoring,
        species("enclosure").scoring,
        species("space", least=9).scoring,
        species("space", start=(0, 0, 2)).scoring,
        species("space", surrounded="flood").scoring,
        species("space", site={"floors": 2}).scoring,
        species("space", site={"environment": box}).scoring,
        species("space", {"economy": {"goal": "maximise"}}).scoring,
        species("space").surrounded((Migrant(4, blocks().offer(system(COLUMN), "surroundings"), 1.0, (), ""),)).scoring,
    ]
    assert len(set(keys)) == len(keys)
    assert species("space", surroundings={"scale": 2.0}).scoring == keys[0], "nothing stands around it"


# -- sites -------------------------------------------------------------------------------------------------------------


def test_a_site_keeps_cells_within_its_outline_and_storeys() -> None:
    site = {"outline": [[0, 0], [2, 0], [2, 2], [0, 2]], "floors": 2}
    found = cells_of(species("enclosure", site=site, start=(1, 1, 4)), BUSY)
    free = cells_of(species("enclosure", start=(1, 1, 4)), BUSY)
    assert found == [(x, y, z) for x, y, z in free if 0 <= x <= 2 and 0 <= y <= 2 and 4 <= z <= 5]
    assert 1 < len(found) < len(free)


SITES = [
    ({"outline": [[0.2, 0.2], [0.8, 0.2], [0.8, 0.8]]}, (0, 0, 0), "site.outline: expected an outline that holds"),
    ({"outline": [[2, 2], [4, 2], [4, 4]]}, (0, 0, 0), r"growth.start: expected a cell of the site, got \[0, 0, 0\]"),
    ({"environment": {"boundaries": [{"shape": "sphere", "at": [0, 0, 0], "radius": 2}]}}, (0, 0, 1), "growth.start"),
    ({"environment": "nowhere.yaml"}, (0, 0, 0), "growth.site.environment: expected an environment file"),
    ({"environment": {"boundaries": [{"shape": "ball"}]}}, (0, 0, 0), "growth.site.environment.boundaries.0.shape"),
]  # fmt: skip


@pytest.mark.parametrize(("site", "start", "message"), SITES)
def test_a_site_that_cannot_be_meant_is_refused(site, start, message) -> None:
    with pytest.raises(InputError, match=message):
        species("enclosure", site=site, start=start)


def test_a_form_takes_the_cells_that_lie_in_it_or_leaves_no_others() -> None:
    form = Migrant(4, blocks(start=(0, 0, 2)).offer(system(COLUMN), "surroundings"), 1.0, (), "")
    inside = [(0, 0, z) for z in range(2, 7)]
    assert cells_of(species("route").surrounded((form,)), LONG) == [(0, 0, z) for z in (0, 1, 7, 8)]
    container = species("route", surroundings={"solid": "outside"}).surrounded((form,))
    assert cells_of(container, LONG) == inside
    moved = species("route", surroundings={"at": [0.0, 0.0, -2.0]}).surrounded((form,))
    assert cells_of(moved, LONG) == [(0, 0, z) for z in (5, 6, 7, 8)]
    swallowed = species("route", surroundings={"scale": 20.0, "at": [0.0, 0.0, -40.0]}).surrounded((form,))
    assert swallowed.evaluate(LONG).error == "empty: none of 9 cells lies where cells may be placed"


def test_within_the_skin_of_a_closed_shell_lies_its_room(monkeypatch) -> None:
    biology = species("enclosure")
    monkeypatch.setattr(biology, "grown", lambda genotype: np.array(SHELL))
    vertices, triangles = read_mesh_text(biology.offer(LONG, "surroundings"), "form")
    assert (vertices.min(), vertices.max(), len(triangles)) == (-2.5, 2.5, 2 * 6 * 25)
    solid = placed_mesh(vertices, triangles, PlacedSettings())
    cells = np.array(grid(-3, 3), dtype=np.float64)
    assert solid.inside(cells).tolist() == (np.abs(cells) <= 2).all(axis=1).tolist()


# -- forms -------------------------------------------------------------------------------------------------------------


def test_forms_show_all_species_and_the_rules_are_one_s_own(tmp_path) -> None:
    biology = species("space", start=(0, 0, -1), least=3)
    column = system("axiom: FF\niterations: 0\n")
    partners = (partner("enclosure", SHELL),)
    files = biology.write_forms_with(column, partners, tmp_path / "room", FORMATS, {"id": "7"})
    assert [path.name for path in files] == [f"room.{suffix}" for suffix in FORMATS]
    scene = trimesh.load_scene(tmp_path / "room.glb")
    assert set(scene.graph.nodes_geometry) == {"enclosure", "space"}
    assert {name: mesh.visual.material.alphaMode for name, mesh in scene.geometry.items()} == {
        "enclosure": "BLEND", "space": None
    }  # fmt: skip
    assert scene.geometry["space"].volume == pytest.approx(3.0)
    assert scene.geometry["enclosure"].volume == pytest.approx(98.0)
    assert np.ptp(scene.geometry["space"].vertices, axis=0).tolist() == [1.0, 3.0, 1.0], "y is up"
    assert scene.metadata["id"] == "7"
    with np.load(tmp_path / "room.npz") as arrays:
        assert np.bincount(arrays["grid"].ravel()).tolist() == [24, 98, 3]
        assert arrays["origin"].tolist() == [-2, -2, -2]
        assert json.loads(str(arrays["extras"])) == {"title": "room", "id": "7"}
    assert trimesh.load(tmp_path / "room.stl").volume == pytest.approx(98.0)
    assert system((tmp_path / "room.blocks").read_text(encoding="utf-8")) == column
    assert (tmp_path / "room.obj").read_text(encoding="utf-8").count("\no ") == 2


def test_alone_an_individual_shows_its_own_cells(tmp_path) -> None:
    (path,) = species("route").write_forms(LONG, tmp_path / "way", ("npz",), {})
    with np.load(path) as arrays:
        assert arrays["grid"].ravel().tolist() == [4] * 9
    assert species("space", least=20).write_forms(LONG, tmp_path / "none", (), {}) == []
    with pytest.raises(InputError, match="--format: expected one of glb, obj, stl, npz, png, blocks, got 'ply'"):
        species("route").write_forms(LONG, tmp_path / "x", ("ply",), {})
