"""Growth under load: what stands at its end may not have stood on the way."""

import pytest
from bodies import body, column
from hypothesis import given, settings
from hypothesis import strategies as st

from evaluators.blocks.load import LoadSettings, analyse, grown_under_load
from evaluators.blocks.load.stages import why_unstable
from growth.blocks import BlockGrowth, stand
from growth.protocol import Failure

HERE = BlockGrowth()
CLIFFS = BlockGrowth(supports=((-1, 0, 0), (5, 0, 0)))
BRIDGE = [(x, 0, 0) for x in range(5)]
"""It grows from one cliff to the other: a cantilever till its last block."""


def under(cells, growth=HERE, **how):
    one = stand(body(cells, boundary=[]).cells, growth)
    return one, grown_under_load(one, growth, LoadSettings(**how))


def test_one_stage_is_the_body_itself():
    one, found = under(column(5), axial_strength=10.0)
    assert found.margins == (0.5,)
    assert found.forces == pytest.approx(analyse(one, LoadSettings()).forces)


def test_a_column_leaves_less_with_every_stage():
    _, found = under(column(8), axial_strength=16.0, stages=4)
    assert found.margins == pytest.approx((1 - 2 / 16, 1 - 4 / 16, 1 - 6 / 16, 1 - 8 / 16))
    assert found.margin == found.margins[-1]


def test_a_bridge_that_would_stand_falls_while_it_is_a_cantilever():
    _, whole = under(BRIDGE, CLIFFS, model="frame", torsion_strength=5.0)
    assert whole.stable
    _, staged = under(BRIDGE, CLIFFS, model="frame", torsion_strength=5.0, stages=5)
    assert staged == Failure("unstable", "joint (-1,0,0)-(0,0,0): torsional 8 over 5 at stage 4 of 5")


def test_the_first_stage_that_falls_is_told():
    _, found = under(column(9), axial_strength=4.0, stages=3)
    told = "joint (0,0,-1)-(0,0,0): translational 6 over 4 (and 1 more joint) at stage 2 of 3"
    assert found == Failure("unstable", told)


def test_both_strengths_are_told():
    _, found = under(BRIDGE, BlockGrowth(supports=((-1, 0, 0),)), axial_strength=4.5, torsion_strength=12.0)
    told = "joint (-1,0,0)-(0,0,0): translational 5 over 4.5, torsional 12.5 over 12 at stage 1 of 1"
    assert found == Failure("unstable", told)


def test_floating_parts_are_told():
    _, found = under([(0, 0, 0), (0, 0, 3), (0, 0, 4)], stages=3)
    assert found == Failure("unstable", "block (0,0,3) joined to no ground at stage 2 of 3")
    _, found = under([(0, 0, 0), (0, 0, 3), (0, 0, 4)])
    assert found == Failure("unstable", "block (0,0,3) (and 1 more block) joined to no ground at stage 1 of 1")


def test_a_body_that_misses_the_ground_is_told():
    _, found = under([(0, 0, 3), (0, 0, 4)], BlockGrowth(ground="fixed"))
    assert found == Failure("unstable", "the body touches no ground: all its 2 blocks float at stage 1 of 1")


def test_a_load_factor_under_one_is_told_by_its_joint():
    _, found = under(column(4), model="limit", axial_strength=2.0)
    told = "joint (0,0,-1)-(0,0,0): translational 4 over 2 (and 1 more joint) at stage 1 of 1"
    assert found == Failure("unstable", told)


def test_a_body_out_of_its_plane_is_a_failure():
    _, found = under([(0, 0, 0), (0, 1, 0)], dimensions=2)
    assert found.reason == "load"


def test_more_stages_than_blocks_repeat_a_stage():
    _, found = under(column(2), axial_strength=4.0, stages=4)
    assert found.margins == (0.75, 0.75, 0.5, 0.5)


@settings(max_examples=20, deadline=None)
@given(count=st.integers(1, 12), stages=st.integers(1, 15))
def test_each_stage_has_its_share_of_the_blocks(count, stages):
    _, found = under(column(count), axial_strength=100.0, stages=stages)
    assert found.margins == pytest.approx(tuple(1 - -(-count * k // stages) / 100 for k in range(1, stages + 1)))


def test_why_names_the_factor_where_no_joint_is_over():
    one = body(column(2))
    load = analyse(one, LoadSettings(model="limit", axial_strength=1.0))
    assert "translational 2 over 1" in why_unstable(one, load, LoadSettings(axial_strength=1.0))
    assert why_unstable(one, load, LoadSettings()).startswith("joint (0,0,-1)-(0,0,0)")
