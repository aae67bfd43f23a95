"""The kind of block bodies: who is valid and why not, what is measured, and what it gives to channels."""

from __future__ import annotations

import json

import numpy as np
import pytest
from block_bodies import COLUMN, FACING, FIRST, LEANING, SECOND, block_spec, blocks, system

from evaluators.blocks import BLOCK_CRITERIA
from genome.errors import InputError
from islands.individual import Evaluation
from islands.kinds.blocks import FORMATS, BlocksKind
from islands.kinds.bodies import COSTLY, read_body_text
from islands.kinds.meshes import read_mesh_text
from islands.kinds.pairs import PAIR
from islands.migration.channel import Migrant
from islands.spec import IslandSpec


def scores(found: Evaluation) -> dict[str, float]:
    assert found.error == ""
    return dict(found.scores)


def shown(biology, text: str, identity: int = 9) -> Migrant:
    return Migrant(identity, biology.offer(system(text), "partners"), 1.0, (), "")


def test_a_column_is_measured_by_every_criterion_and_stands() -> None:
    found = blocks(load={"axial_strength": 5, "torsion_strength": 1}).evaluate(system(COLUMN))
    told = scores(found)
    assert set(told) == {*BLOCK_CRITERIA, *PAIR} - {*COSTLY}
    goals = {name: {"goal": "maximise"} for name in COSTLY}
    assert set(scores(blocks(fitness=goals).evaluate(system(COLUMN)))) == {*BLOCK_CRITERIA, *PAIR}
    assert (told["height"], told["blocks"], told["ground"], told["span_x"]) == (5.0, 5.0, 1.0, 1.0)
    assert told["stability"] == pytest.approx(0.0, abs=1e-12), "its foot carries five blocks, and could no more"
    assert (told["alone_first"], told["alone_second"], told["meet"], told["shared"]) == (1.0, 0.0, 0.0, 0.0)
    assert found.fitness == 5.0


def test_a_body_that_fails_is_invalid_and_says_which_joint() -> None:
    found = blocks(load={"axial_strength": 4.5}).evaluate(system(COLUMN))
    assert (found.fitness, found.scores) == (None, ())
    assert found.error == "unstable: joint (0,0,-1)-(0,0,0): translational 5 over 4.5 at stage 1 of 1"
    leaning = blocks(load={"torsion_strength": 2.5}).evaluate(system(LEANING))
    assert leaning.error == ("unstable: joint (0,0,0)-(0,0,1): torsional 3 over 2.5 (and 1 more joint) at stage 1 of 1")


def test_a_body_that_fails_while_it_grows_is_invalid_though_it_would_stand_in_the_end() -> None:
    # An arch: after two thirds of its growth it is a bracket.
    arch = "axiom: FF&&FFF&&FF\niterations: 0\n"
    assert blocks(load={"torsion_strength": 2.5}).evaluate(system(arch)).error == ""
    found = blocks(load={"torsion_strength": 2.5, "stages": 8}).evaluate(system(arch))
    assert found.error == "unstable: joint (0,0,0)-(0,0,1): torsional 3 over 2.5 (and 1 more joint) at stage 5 of 8"


def test_where_a_body_need_not_stand_it_is_scored_as_it_is() -> None:
    found = blocks(load={"axial_strength": 4, "required": False}).evaluate(system(COLUMN))
    assert scores(found)["alone_first"] == 0.0
    assert scores(found)["stability"] == pytest.approx(1 - 5 / 4)


INVALID = [
    ({}, "axiom: +F-\niterations: 1\nF -> +\n", "", "single: a body of 1 block, at least two make a structure"),
    ({"ground": "fixed", "ground_level": -1}, COLUMN, "", "ground: the body touches no ground"),
    ({"ground": "fixed", "ground_level": -1, "load": {"required": False}}, COLUMN, "", "ground: the body touches no"),
    ({"max_blocks": 4}, COLUMN, "", "budget: "),
]


@pytest.mark.parametrize(("growth", "text", "_", "error"), INVALID)
def test_what_is_no_structure_is_invalid_with_a_reason(growth, text, _, error) -> None:
    from genome.lsystem import LSystem, Word

    made = LSystem(Word(("+",)), (), 0, 0) if error.startswith("single") else system(text)
    found = blocks(**growth).evaluate(made)
    assert found.fitness is None
    assert found.error.startswith(error)


def test_floating_parts_are_told() -> None:
    biology = blocks(ground="fixed")
    aloft = Migrant(9, json.dumps({"lattice": "cubic", "cells": [[9, 9, 5], [9, 9, 6]]}), 1.0, (), "")
    found = biology.evaluate_with(system(COLUMN), (aloft,))
    assert found.error == "floating: 2 blocks are joined to no ground, one at (9,9,5)"


def test_a_start_moves_the_body() -> None:
    text = "axiom: F\niterations: 0\n"
    still, moved = blocks(), blocks(start=[3, -2, 1])
    cells = [read_body_text(one.offer(system(text), "partners"), "cubic") for one in (still, moved)]
    assert (cells[1] - cells[0]).tolist() == [[3, -2, 1]] * 2
    assert cells[0].dtype == np.int64


def test_partners_are_scored_as_one_body_with_it() -> None:
    first, second = blocks(load={"torsion_strength": 2.5}), blocks(start=[5, 0, 0], load={"torsion_strength": 2.5})
    assert read_body_text(first.offer(system(LEANING), "partners"), "cubic").tolist() == FIRST.tolist()
    assert read_body_text(second.offer(system(FACING), "partners"), "cubic").tolist() == SECOND.tolist()
    assert first.evaluate(system(LEANING)).fitness is None
    assert second.evaluate(system(FACING)).fitness is None
    told = scores(first.evaluate_with(system(LEANING), (shown(second, FACING),)))
    assert [told[name] for name in PAIR] == [0.0, 0.0, 1.0, 0.0]
    assert (told["blocks"], told["span_x"], told["ground"]) == (10.0, 6.0, 2.0)
    both = scores(first.evaluate_with(system(LEANING), (shown(second, FACING), shown(blocks(start=[9, 9, 0]), COLUMN))))
    assert both["blocks"] == 15.0


def test_a_partner_that_is_no_body_of_this_lattice_is_refused() -> None:
    for text in ("", "[]", '{"lattice":"cubic","cells":[]}', '{"lattice":"isospatial","cells":[[0,0,0]]}'):
        with pytest.raises(InputError, match="expected a body on the lattice cubic"):
            read_body_text(text, "cubic")
    with pytest.raises(InputError, match="expected a cell of three whole numbers"):
        read_body_text('{"lattice":"cubic","cells":[[0,0,0.5]]}', "cubic")


def test_surroundings_get_its_outer_faces_above_ground() -> None:
    vertices, triangles = read_mesh_text(blocks().offer(system(COLUMN), "surroundings"), "form")
    assert (vertices.min(axis=0).tolist(), vertices.max(axis=0).tolist()) == ([-0.5, -0.5, -0.5], [0.5, 0.5, 4.5])
    corners = vertices[triangles]
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    assert volume == pytest.approx(5.0)
    with pytest.raises(InputError, match="expected a genotype that grows to a body, got budget"):
        blocks(max_blocks=4).offer(system(COLUMN), "surroundings")


def test_scoring_tells_islands_apart_that_score_otherwise() -> None:
    keys = [
        blocks().scoring,
        blocks(load={"axial_strength": 4}).scoring,
        blocks(load={"required": False}).scoring,
        blocks(start=[2, 0, 0]).scoring,
        blocks(lattice="isospatial").scoring,
        blocks(fitness={"height": {"goal": "maximise", "weight": 2}}).scoring,
    ]
    assert len(set(keys)) == len(keys)
    assert blocks().scoring == keys[0]
    varied = BlocksKind().build(block_spec(genome={"crossover": "common_region"}), lambda: 0.0)
    assert varied.scoring == keys[0]


def test_a_start_off_the_lattice_is_refused() -> None:
    with pytest.raises(
        InputError, match=r"islands.isle.growth.start: expected cells of the isospatial lattice, whose coord"
    ):
        blocks(lattice="isospatial", start=[1, 0, 0])
    assert blocks(lattice="isospatial", start=[1, 0, 1]).scoring


def test_species_on_different_lattices_are_no_partners() -> None:
    made: list[IslandSpec] = [block_spec(growth={"lattice": name}) for name in ("cubic", "isospatial")]
    kind = BlocksKind()
    assert kind.gives(made[0])["partners"] in kind.takes(made[0])["partners"]
    assert kind.gives(made[0])["partners"] not in kind.takes(made[1])["partners"]


def test_forms_are_written_in_every_format(tmp_path) -> None:
    biology = blocks(load={"axial_strength": 9})
    files = biology.write_forms(system(COLUMN), tmp_path / "tower", FORMATS, {"id": "7"})
    assert [path.name for path in files] == [f"tower.{suffix}" for suffix in FORMATS]
    assert all(path.stat().st_size > 0 for path in files)
    assert system((tmp_path / "tower.blocks").read_text(encoding="utf-8")) == system(COLUMN)
    assert [path.name for path in biology.write_forms(system(COLUMN), tmp_path / "b", (), {})] == ["b.glb", "b.blocks"]
    assert blocks(max_blocks=4).write_forms(system(COLUMN), tmp_path / "none", (), {}) == []
    with pytest.raises(InputError, match="--format: expected one of glb, obj, stl, npz, png, blocks, got 'ply'"):
        biology.write_forms(system(COLUMN), tmp_path / "c", ("ply",), {})
