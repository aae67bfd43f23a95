"""Load on block bodies: closed forms, equilibrium, mirror images, and the kernels against plain references."""

import math

import numpy as np
import pytest
from bodies import bodies, body, cantilever, column, grid, mirrored, walk
from hypothesis import given, settings
from hypothesis import strategies as st
from reference_loads import reference_depths, reference_galasyn, reference_parts, reference_rigid

from evaluators.blocks.load import LoadSettings, analyse
from evaluators.blocks.load._kernels import parts_above
from evaluators.blocks.load.frame import frame
from evaluators.blocks.load.layers import layers
from genome.errors import InputError
from genome.settings import validated
from growth.blocks.lattice import CUBIC, ISOSPATIAL

MODELS = ("galasyn", "rigid", "frame")
BALANCED = ("rigid", "frame")
WALL = {"boundary": [(-1, 0, 0)]}


def load(one, model="rigid", **how):
    return analyse(one, LoadSettings(model=model, **how))


def at(one, found, first, second):
    """The place of the joint between two cells, the first in the lower layer."""
    cells = [tuple(cell) for cell in one.cells.tolist()]
    return found.joints.tolist().index([cells.index(first), cells.index(second)])


@pytest.mark.parametrize("model", MODELS)
class TestEveryModel:
    @pytest.mark.parametrize("n", [1, 2, 7, 60])
    def test_a_column_presses_on_its_lowest_joint_with_all_its_weight(self, model, n):
        one = body(column(n))
        found = load(one, model, weight=2.5)
        lowest = at(one, found, (0, 0, -1), (0, 0, 0))
        assert found.forces[lowest] == pytest.approx([0, 0, -2.5 * n], rel=1e-12, abs=1e-9)
        assert found.torsional == pytest.approx(np.zeros(n), abs=1e-9)
        assert sorted(found.translational) == pytest.approx([2.5 * k for k in range(1, n + 1)])
        assert found.residual < 1e-9

    @pytest.mark.parametrize("n", [1, 2, 7, 60])
    def test_a_cantilever_shears_and_bends_its_root(self, model, n):
        one = cantilever(n)
        found = load(one, model, weight=3)
        root = at(one, found, (-1, 0, 0), (0, 0, 0))
        assert found.translational[root] == pytest.approx(3 * n)
        assert found.torsional[root] == pytest.approx(3 * n * n / 2)
        assert found.forces[root] == pytest.approx([0, 0, -3 * n], abs=1e-8)
        assert found.moments[root] == pytest.approx([0, 3 * n * n / 2, 0], abs=1e-8)  # tips over towards +x
        assert found.residual < 1e-9

    @settings(max_examples=25, deadline=None)
    @given(one=bodies(), axis=st.sampled_from([0, 1]))
    def test_mirror_images_have_mirrored_loads(self, model, one, axis):
        image = mirrored(one, axis)
        here, there = load(one, model), load(image, model)
        key = {frozenset(pair): k for k, pair in enumerate(there.joints.tolist())}
        order = [key[frozenset(pair)] for pair in here.joints.tolist()]
        sign = np.where((there.joints[order] == here.joints).all(axis=1), 1.0, -1.0)[:, None]
        flip = np.ones(3)
        flip[axis] = -1
        scale = max(here.translational.max(), here.torsional.max())
        assert there.forces[order] * sign * flip == pytest.approx(here.forces, abs=1e-7 * scale)
        assert there.moments[order] * sign * -flip == pytest.approx(here.moments, abs=1e-7 * scale)

    def test_a_body_that_is_its_own_image_has_equal_reactions(self, model):
        arch = body([*column(4, -2), *column(4, 2), *[(x, 0, 3) for x in (-1, 0, 1)]])
        found = load(arch, model)
        left, right = (found.forces[at(arch, found, (x, 0, -1), (x, 0, 0))] for x in (-2, 2))
        assert left * (-1, 1, 1) == pytest.approx(right, abs=1e-9)
        if model != "galasyn":
            assert left[2] == pytest.approx(-5.5)

    def test_two_towers_do_not_lean_on_each_other(self, model):
        tall, low = column(9), [(2, 0, z) for z in range(4)]
        together, alone = body([*tall, *low]), body(tall)
        found = load(together, model)
        assert found.translational[at(together, found, (0, 0, -1), (0, 0, 0))] == pytest.approx(9)
        assert found.translational[at(together, found, (2, 0, -1), (2, 0, 0))] == pytest.approx(4)
        assert load(alone, model).translational.max() == pytest.approx(9)

    def test_what_is_joined_to_no_ground_is_named_and_carries_nothing(self, model):
        one = body([(0, 0, 0), (0, 0, 4), (0, 0, 1), (0, 0, 5)], boundary=[(0, 0, -1)])
        found = load(one, model)
        assert found.floating.tolist() == [1, 3]
        assert not found.stable
        assert found.margin <= -1
        assert len(found.joints) == 2
        assert found.translational.max() == pytest.approx(2)

    def test_a_body_without_ground_floats_as_a_whole(self, model):
        found = load(body([(0, 0, 0), (0, 0, 1)], boundary=[]), model)
        assert found.floating.tolist() == [0, 1]
        assert not found.stable
        assert found.joints.shape == (0, 2)

    def test_a_body_of_no_blocks_stands(self, model):
        found = load(body([], boundary=[(0, 0, -1), (1, 0, -1)]), model)
        assert found.stable
        assert found.joints.shape == (0, 2)
        assert found.residual == 0

    @settings(max_examples=10, deadline=None)
    @given(one=bodies(most=20))
    def test_weight_scales_all_that_is_carried(self, model, one):
        light, heavy = load(one, model), load(one, model, weight=7)
        assert heavy.forces == pytest.approx(7 * light.forces, rel=1e-9, abs=1e-9)
        assert heavy.moments == pytest.approx(7 * light.moments, rel=1e-9, abs=1e-9)

    def test_joints_over_a_strength_fail_the_worst_first(self, model):
        one = body(column(10))
        found = load(one, model, axial_strength=7.5)
        assert [found.translational[k] for k in found.failed] == pytest.approx([10, 9, 8])
        assert found.margin == pytest.approx(1 - 10 / 7.5)
        assert not found.stable
        assert load(one, model, axial_strength=10).stable
        assert load(one, model).margin == 1

    def test_moments_are_bounded_by_the_other_strength(self, model):
        found = load(cantilever(4), model, torsion_strength=4, axial_strength=1000)
        root = at(cantilever(4), found, (-1, 0, 0), (0, 0, 0))
        assert found.failed[0] == root
        assert found.margin == pytest.approx(1 - 8 / 4)
        assert load(cantilever(4), model, torsion_strength=8).stable

    def test_the_envelope_weighs_and_bears_when_it_counts(self, model):
        wrapped = body(column(2), envelope=[(0, 0, 2), (0, 0, 3)])
        assert load(wrapped, model).translational.max() == pytest.approx(4)
        bare = load(wrapped, model, envelope_counts=False)
        assert bare.translational.max() == pytest.approx(2)
        assert sorted({place for pair in bare.joints.tolist() for place in pair}) == [0, 1, 4]

    def test_two_dimensions_want_a_body_in_one_plane(self, model):
        flat = body([(0, 3, 0), (1, 3, 1), (2, 3, 1)])
        assert load(flat, model, dimensions=2).forces == pytest.approx(load(flat, model).forces)
        with pytest.raises(InputError, match="expected a body in one plane of x and z"):
            load(body([(0, 0, 0), (0, 1, 0)]), model, dimensions=2)

    def test_the_iso_spatial_lattice(self, model):
        one = body([(0, 0, 0), (0, 0, 2), (1, 0, 1), (-1, 0, 1)], lattice=ISOSPATIAL)
        found = load(one, model)
        ground = [k for k, (low, _) in enumerate(found.joints.tolist()) if low >= 4]
        assert len(ground) == 4
        if model != "galasyn":
            assert found.forces[ground].sum(axis=0) == pytest.approx([0, 0, -4], abs=1e-9)


@pytest.mark.parametrize("model", BALANCED)
class TestEquilibrium:
    @pytest.mark.parametrize("seed", range(6))
    @pytest.mark.parametrize("lattice", [CUBIC, ISOSPATIAL], ids=["cubic", "isospatial"])
    def test_large_bodies_are_in_balance_to_a_billionth(self, model, seed, lattice):
        rng = np.random.default_rng(seed)
        one = body(walk(rng, 300, lattice, branch=0.05 + 0.05 * seed), lattice=lattice)
        found = load(one, model)
        assert found.residual < 1e-9
        ground = found.joints[:, 0] >= 300
        assert found.forces[ground].sum(axis=0) == pytest.approx([0, 0, -300], abs=300e-9)

    @pytest.mark.parametrize("seed", range(4))
    def test_the_residual_is_what_plain_sums_find(self, model, seed):
        one = body(walk(np.random.default_rng(seed), 50))
        found = load(one, model)
        cells = one.cells
        depth = layers(one).depth
        points = (cells[found.joints[:, 0]] + cells[found.joints[:, 1]]) / 2
        for k in range(1, depth.max() + 1):  # the whole of what lies at depth k and deeper hangs on the joints below it
            above = depth >= k
            cut = above[found.joints[:, 1]] & ~above[found.joints[:, 0]]
            weight = np.stack([0 * cells[above, 0], 0 * cells[above, 0], -np.ones(above.sum())], axis=1)
            force = found.forces[cut].sum(axis=0)
            moment = (np.cross(points[cut], found.forces[cut]) + found.moments[cut]).sum(axis=0)
            assert force == pytest.approx(weight.sum(axis=0), abs=1e-9 * above.sum())
            assert moment == pytest.approx(np.cross(cells[above], weight).sum(axis=0), abs=1e-8 * above.sum())

    def test_stiffer_joints_take_more(self, model):
        bridge = body([(0, 0, 0)], boundary=[(-1, 0, 0), (0, 1, 1)])  # one joint over a face, one over an edge
        even, faces = (load(bridge, model, stiffness=(s, 1.0, 1.0)) for s in (1.0, 100.0))
        face = int(np.flatnonzero([low == 1 for low, _ in even.joints.tolist()])[0])
        assert faces.translational[face] > even.translational[face]
        assert faces.residual < 1e-9


class TestGalasyn:
    def test_the_one_block_problem(self):
        """By hand from Figures 18 to 20, weight 3: one block on three, joints at its two corners and between them.

        Each joint's share is (0, -1). At the left corner, direction (-1, -1) / sqrt 2 from the centre, (-1/2, -1/2) is
        along it and (1/2, -1/2) across. The latter's moment about the joint, of lever (1/2, 1/2), is 1/2 clockwise; at
        the right corner, one to the right of the left, a force of 1/2 down meets it. In the middle all is along. So
        each corner has 1 down and 1/2 outwards, the middle 1 down, together 3: here galasyn is in balance.
        """
        one = body([(0, 0, 0)], boundary=[(-1, 0, -1), (0, 0, -1), (1, 0, -1)])
        found = load(one, "galasyn", weight=3, dimensions=2)
        forces = {x: found.forces[at(one, found, (x, 0, -1), (0, 0, 0))] for x in (-1, 0, 1)}
        assert forces[-1] == pytest.approx([-0.5, 0, -1])
        assert forces[0] == pytest.approx([0, 0, -1])
        assert forces[1] == pytest.approx([0.5, 0, -1])
        assert found.torsional == pytest.approx(np.zeros(3), abs=1e-12)
        assert found.residual < 1e-12

    def test_two_joints_one_of_them_in_line(self):
        """By hand, weight 2: joints straight beneath and at the right corner, each with a share of 1 down.

        Beneath: (0, -1) along. Right corner: along (1/2, -1/2); the part across has the moment 1/2 about it,
        anticlockwise, which beneath, 1/2 to the left, meets with 1 down. Sum (1/2, -5/2): out of balance by
        sqrt(1/2 squared + 1/2 squared), over a weight of 2.
        """
        one = body([(0, 0, 0)], boundary=[(0, 0, -1), (1, 0, -1)])
        found = load(one, "galasyn", weight=2, dimensions=2)
        assert found.forces[at(one, found, (0, 0, -1), (0, 0, 0))] == pytest.approx([0, 0, -2])
        assert found.forces[at(one, found, (1, 0, -1), (0, 0, 0))] == pytest.approx([0.5, 0, -0.5])
        assert found.residual >= math.sqrt(0.5) / 2 - 1e-12

    @settings(max_examples=30, deadline=None)
    @given(seed=st.integers(0, 2**32 - 1), count=st.integers(1, 40))
    def test_in_two_dimensions_only_a_lone_joint_has_a_moment(self, seed, count):
        cells = walk(np.random.default_rng(seed), count)
        flat = body(list(dict.fromkeys((x, 0, z) for x, _, z in cells)))
        found = load(flat, "galasyn", dimensions=2)
        layer = layers(flat)
        part, _, _ = parts_above(flat.cells, layer.depth, layer.joints)
        spots = {}
        for place, p in enumerate(part.tolist()):
            spots.setdefault(p, set()).add(tuple(layer.points[place]))
        alone = np.array([p >= 0 and len(spots[p]) == 1 for p in part.tolist()])
        assert found.torsional[~alone] == pytest.approx(np.zeros((~alone).sum()), abs=1e-9)

    def test_joints_that_cross_in_one_point_share_without_a_lever(self):
        cross = body([(0, 0, 0), (1, 0, 0), (0, 0, 1), (1, 0, 1)], boundary=[(0, 0, -1)])
        found = load(cross, "galasyn")
        assert np.isfinite(found.forces).all()
        assert np.isfinite(found.residual)

    def test_is_out_of_balance_and_says_by_how_much(self):
        found = load(body(walk(np.random.default_rng(1), 60)), "galasyn")
        assert found.residual > 0.01


class TestKernels:
    @settings(max_examples=40, deadline=None)
    @given(bodies(most=30))
    def test_layers_and_parts(self, one):
        found = layers(one)
        assert found.depth.tolist() == reference_depths(one)
        part, counts, centres = parts_above(one.cells, found.depth, found.joints)
        expected = reference_parts(one, found)
        for place, p in enumerate(part.tolist()):
            low, high = found.depth[found.joints[place]].tolist()
            assert (p >= 0) == (high == low + 1)
            if p >= 0:
                members = expected[place]
                assert counts[p] == len(members)
                assert centres[p] == pytest.approx(one.cells[members].mean(axis=0), abs=1e-12)

    @settings(max_examples=40, deadline=None)
    @given(bodies(most=30), st.sampled_from([(1.0, 1.0, 1.0), (1.0, 0.5, 0.25)]))
    def test_rigid(self, one, stiffness):
        found = load(one, stiffness=stiffness)
        forces, moments = reference_rigid(one, layers(one), stiffness)
        scale = max(1.0, np.abs(moments).max())
        assert found.forces == pytest.approx(forces, abs=1e-10 * scale)
        assert found.moments == pytest.approx(moments, abs=1e-10 * scale)

    @settings(max_examples=40, deadline=None)
    @given(bodies(most=30), st.sampled_from([(1.0, 1.0, 1.0), (1.0, 0.5, 0.25)]))
    def test_galasyn(self, one, stiffness):
        found = load(one, "galasyn", stiffness=stiffness)
        forces, moments = reference_galasyn(one, layers(one), stiffness)
        scale = max(1.0, np.abs(moments).max(), np.abs(forces).max())
        assert found.forces == pytest.approx(forces, abs=1e-9 * scale)
        assert found.moments == pytest.approx(moments, abs=1e-9 * scale)


class TestFrame:
    def test_a_beam_clamped_at_both_ends(self):
        """A clamped beam under even load, L = 8 between its walls' centres: w n / 2 at each, and a joint's moment."""
        one = body([(x, 0, 0) for x in range(7)], boundary=[(-1, 0, 0), (7, 0, 0)])
        found = load(one, "frame")
        ends = [at(one, found, (-1, 0, 0), (0, 0, 0)), at(one, found, (7, 0, 0), (6, 0, 0))]
        assert found.forces[ends, 2] == pytest.approx([-3.5, -3.5])
        # fixed-end moment of point loads at 1..7 on a span of 8: sum of a b^2 / L^2, less half a unit's shear
        fixed = sum(a * (8 - a) ** 2 for a in range(1, 8)) / 64
        assert found.torsional[ends] == pytest.approx([fixed - 3.5 / 2] * 2)

    def test_bending_stiffness_does_not_matter_to_a_tree_of_blocks(self):
        one = cantilever(9)
        soft, stiff = (frame(one, LoadSettings(model="frame"), bending=factor) for factor in (1, 2))
        assert soft.forces == pytest.approx(stiff.forces, abs=1e-8)


class TestSettings:
    @pytest.mark.parametrize(
        ("key", "value"),
        [
            ("axial_strength", 0.0), ("axial_strength", -1.0), ("torsion_strength", 0.0), ("torsion_strength", -2.0),
            ("axial_strength", math.nan), ("weight", math.nan), ("weight", 0.0), ("weight", math.inf), ("stages", 0),
            ("model", "magic"), ("dimensions", 4), ("stiffness", [1.0, 0.0, 1.0]),
        ],
    )  # fmt: skip
    def test_what_makes_no_sense_is_bad_input(self, key, value):
        with pytest.raises(InputError, match=f"load.yaml: {key}: expected .*, got"):
            validated(LoadSettings, {key: value}, "load.yaml")

    def test_a_strength_of_zero_is_told_in_one_line(self):
        with pytest.raises(InputError) as caught:
            validated(LoadSettings, {"axial_strength": 0.0}, "load.yaml")
        assert str(caught.value) == "load.yaml: axial_strength: expected greater than 0, got 0.0"


def test_a_block_of_grid_is_carried_by_all_that_it_stands_on():
    slab = body(grid(4, 4, 1))
    found = load(slab)
    assert found.forces.sum(axis=0) == pytest.approx([0, 0, -16], abs=1e-9)
