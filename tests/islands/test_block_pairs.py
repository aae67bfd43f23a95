"""Structural pairs: two skeletons in one space, merged where they meet, and what stands together and not apart."""

from __future__ import annotations

import numpy as np
import pytest
from archipelagos import spec
from block_bodies import COLUMN, FACING, FIRST, LEANING, SECOND, system
from hypothesis import given
from hypothesis import strategies as st

from genome.errors import InputError
from genome.settings import validated
from growth.blocks import BlockGrowth
from growth.blocks.lattice import CUBIC, ISOSPATIAL
from islands.kinds.block_pair import BlockPairKind, PairBiology, PairGrowth
from islands.kinds.bodies import BlockLoad
from islands.kinds.meshes import read_mesh_text
from islands.kinds.pairs import PAIR, grounded, meetings, paired, united

cells = st.lists(st.tuples(*[st.integers(-3, 3)] * 3), min_size=1, max_size=12, unique=True).map(
    lambda rows: np.array(rows, dtype=np.int64)
)


def pair(**growth) -> PairBiology:
    settings = {"starts": [[0, 0, 0], [5, 0, 0]], **growth}
    fitness = {"meet": {"goal": "maximise"}, "alone_first": {"goal": "minimise"}, "alone_second": {"goal": "minimise"}}
    made = {
        "genome": BlockPairKind.genome.model_validate({}).model_dump(mode="json"),
        "growth": validated(PairGrowth, settings, "x.yaml", ("growth",)).model_dump(mode="json"),
        "fitness": fitness,
    }
    return BlockPairKind().build(spec(kind="block_pair", **made), lambda: 0.0)


@given(cells, cells)
def test_the_union_holds_each_cell_once_and_both_grow_at_the_same_time(first, second) -> None:
    found = united(first, second)
    rows = [tuple(row) for row in found.tolist()]
    own, other = ([tuple(row) for row in one.tolist()] for one in (first, second))
    assert len(rows) == len(set(rows))
    assert set(rows) == {*own, *other}

    def time(row):
        shares = [(part.index(row) + 1) / len(part) for part in (own, other) if row in part]
        return min(shares)

    assert [time(row) for row in rows] == sorted(time(row) for row in rows)


def test_of_blocks_that_grow_at_once_the_first_body_s_come_first() -> None:
    both = [row for pair in zip(FIRST.tolist(), SECOND.tolist(), strict=True) for row in pair]
    assert united(FIRST, SECOND).tolist() == both
    assert united(SECOND, FIRST).tolist() != both


@given(cells, cells)
def test_meetings_are_as_counted_one_by_one(first, second) -> None:
    own, other = ({tuple(row) for row in one.tolist()} for one in (first, second))
    touch = any(max(abs(a - b) for a, b in zip(one, two, strict=True)) <= 1 for one in own for two in other)
    assert meetings(first, second, CUBIC) == (len(own & other), touch)


def test_on_the_iso_spatial_lattice_only_its_own_neighbours_touch() -> None:
    here = np.array([(0, 0, 0)])
    assert meetings(here, np.array([(2, 0, 0)]), ISOSPATIAL) == (0, False)
    assert meetings(here, np.array([(1, 1, 0)]), ISOSPATIAL) == (0, True)


def test_two_brackets_stand_together_and_not_apart() -> None:
    body, told = paired(FIRST, SECOND, BlockGrowth(), BlockLoad(torsion_strength=2.5))
    assert len(body.internal) == 10
    assert told == dict(zip(PAIR, (0.0, 0.0, 1.0, 0.0), strict=True))
    assert paired(FIRST, SECOND, BlockGrowth(), BlockLoad(torsion_strength=3.5))[1]["alone_first"] == 1.0
    apart = paired(FIRST, SECOND + np.array([3, 0, 0]), BlockGrowth(), BlockLoad(torsion_strength=2.5))[1]
    assert (apart["meet"], apart["shared"]) == (0.0, 0.0)
    over = paired(FIRST, SECOND - np.array([1, 0, 0]), BlockGrowth(), BlockLoad(torsion_strength=2.5))
    assert (over[1]["meet"], over[1]["shared"], len(over[0].internal)) == (1.0, 1.0, 9)


def test_alone_a_part_stands_on_the_ground_of_the_whole() -> None:
    shelf = np.array([(2, 0, 2), (3, 0, 2)])
    told = paired(FIRST, shelf, BlockGrowth(), BlockLoad())[1]
    assert (told["alone_first"], told["alone_second"], told["shared"]) == (1.0, 0.0, 1.0)
    settings = BlockGrowth()
    assert grounded(shelf, settings).ground_level == 2
    fixed = BlockGrowth(ground="fixed", ground_level=-4)
    assert grounded(shelf, fixed) is fixed


def test_a_pair_is_one_individual_scored_as_one_body(tmp_path) -> None:
    biology = pair(load={"torsion_strength": 2.5})
    genotype = (system(LEANING), system(FACING))
    found = biology.evaluate(genotype)
    told = dict(found.scores)
    assert found.error == ""
    assert [told[name] for name in PAIR] == [0.0, 0.0, 1.0, 0.0]
    assert (told["blocks"], told["ground"]) == (10.0, 2.0)
    assert found.fitness == 1.0
    assert biology.decode(biology.encode(genotype)) == genotype
    vertices, _ = read_mesh_text(biology.offer(genotype, "surroundings"), "form")
    assert (vertices.min(axis=0).tolist(), vertices.max(axis=0).tolist()) == ([-0.5, -0.5, -0.5], [5.5, 0.5, 2.5])
    files = biology.write_forms(genotype, tmp_path / "pair", (), {})
    assert [path.name for path in files] == ["pair.glb", "pair-part1.blocks", "pair-part2.blocks"]
    assert system((tmp_path / "pair-part2.blocks").read_text(encoding="utf-8")) == system(FACING)
    weak = pair(load={"axial_strength": 4}).evaluate(genotype)
    assert weak.error.startswith("unstable: joint (0,0,-1)-(0,0,0): translational 5 over 4")


def test_a_part_that_does_not_grow_is_named() -> None:
    found = pair(max_blocks=4).evaluate((system("axiom: F\niterations: 0\n"), system(COLUMN)))
    assert found.error.startswith("budget: part 2: ")


def test_parts_vary_by_themselves() -> None:
    biology = pair()
    rng = np.random.default_rng(4)
    one, other = biology.random(rng), biology.random(rng)
    assert len(one) == 2
    mutants = [biology.mutate(one, rng) for _ in range(40)]
    changed = [tuple(a != b for a, b in zip(one, two, strict=True)) for two in mutants]
    assert {(True, False), (False, True)} <= set(changed)
    children = biology.crossover(one, other, rng)
    assert all(len(child) == 2 for child in children)
    assert biology.diversity([one, other]) > 0


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"starts": [[0, 0, 0]]}, "growth.starts: expected two cells"),
        ({"starts": [[0, 0, 0], [1, 0]]}, "expected a cell of three whole numbers: [x, y, z]"),
        ({"starts": [[0, 0, 0], [0.5, 0, 0]]}, "expected a cell of three whole numbers: [x, y, z]"),
        (
            {"lattice": "isospatial", "starts": [[0, 0, 0], [1, 0, 0]]},
            "whose coordinates add up to an even number, got [1, 0, 0]",
        ),
    ],
)
def test_starts_are_checked(settings, message) -> None:
    with pytest.raises(InputError) as caught:
        pair(**settings)
    assert message in str(caught.value)
