"""Criteria of block bodies: closed forms, invariances, and what all of them must hold to."""

import itertools
import math
import subprocess
import sys
from dataclasses import replace

import numpy as np
import plugin_criteria
import pytest
from bodies import bodies, body, cantilever, column, grid, mirrored, walk
from hypothesis import given, settings
from hypothesis import strategies as st

from evaluators.blocks import BLOCK_CRITERIA, Structure, resolve, score
from evaluators.blocks._kernels import first_hits, touching
from evaluators.blocks.load import LoadSettings, analyse
from evaluators.blocks.rays import cells_at, spread
from evaluators.blocks.sun import open_faces, suns
from genome.errors import InputError
from growth.blocks.body import Body
from growth.blocks.lattice import FACE, ISOSPATIAL, LATTICES
from growth.protocol import Failure


def structure(one, **how):
    return Structure(one, analyse(one, LoadSettings(**how)))


def value(name, one, **how):
    return BLOCK_CRITERIA[name](structure(one, **how))


def turned(one):
    """The body turned by a quarter about the vertical."""
    return Body(one.lattice, one.cells @ np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]]), one.systems)


HELIX = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)]
FORMS = {
    "one block": body([(0, 0, 0)]),
    "column": body(column(7)),
    "cantilever": cantilever(5),
    "wrapped": body(column(3), envelope=[(1, 0, 2), (-1, 0, 2)]),
    "floating": body([(0, 0, 0), (0, 0, 9)]),
    "without ground": body([(0, 0, 0)], boundary=[]),
    "nothing": body([], boundary=[]),
    "iso-spatial": body([(0, 0, 0), (0, 1, 1), (0, 0, 2)], lattice=ISOSPATIAL),
    "walk": body(walk(np.random.default_rng(0), 80)),
}


@pytest.mark.parametrize("name", BLOCK_CRITERIA)
class TestEvery:
    @pytest.mark.parametrize("form", FORMS)
    def test_gives_one_finite_float_every_time_and_changes_nothing(self, name, form):
        one = structure(FORMS[form])
        before = one.body.cells.copy()
        first = BLOCK_CRITERIA[name](one)
        assert type(first) is float
        assert math.isfinite(first)
        assert BLOCK_CRITERIA[name](one) == first
        assert score(one, [name]) == {name: first}  # through arrays that cannot be written to
        assert (one.body.cells == before).all()

    @settings(max_examples=15, deadline=None)
    @given(one=bodies(), far=st.tuples(*[st.integers(-1000, 1000)] * 3))
    def test_does_not_care_where_the_body_stands(self, name, one, far):
        moved = Body(one.lattice, one.cells + np.array(far), one.systems)
        assert value(name, moved) == pytest.approx(value(name, one), rel=1e-9, abs=1e-9)

    def test_is_named_like_its_file_and_documented(self, name):
        criterion = BLOCK_CRITERIA[name]
        assert criterion.__module__ == f"evaluators.blocks.{name.removesuffix('_x').removesuffix('_y')}"
        assert criterion.__name__ == name
        assert "Returns\n" in (criterion.__doc__ or "")


class TestExtents:
    @pytest.mark.parametrize("n", [1, 4, 30])
    def test_columns_and_rows(self, n):
        tall, wide = body(column(n)), body([(x, 0, 0) for x in range(n)])
        assert value("height", tall) == n
        assert value("height", wide) == 1
        assert value("rise", tall) == n * (n + 1) / 2
        assert value("rise", wide) == n
        assert value("span_x", wide) == n
        assert value("span_x", tall) == 1
        assert value("span_y", turned(wide)) == n
        assert value("span_y", wide) == 1
        assert value("blocks", tall) == n

    def test_the_envelope_and_the_ground_do_not_count(self):
        wrapped = body(column(3), envelope=[(x, y, 3) for x in (-1, 0, 1) for y in (-1, 0, 1)])
        assert [value(name, wrapped) for name in ("height", "span_x", "span_y", "blocks", "rise")] == [3, 1, 1, 3, 6]


class TestGround:
    def test_counts_the_blocks_that_stand_on_it(self):
        assert value("ground", body(column(5))) == 1
        assert value("ground", body(grid(3, 2, 4))) == 6
        assert value("ground", cantilever(4)) == 1
        assert value("ground", body([(0, 0, 0)], boundary=[(1, 1, -1)])) == 1
        assert value("ground", body([(0, 0, 0)], boundary=[])) == 0

    def test_an_arch_has_two(self):
        assert value("ground", body([*column(4, -2), *column(4, 2), *[(x, 0, 3) for x in (-1, 0, 1)]])) == 2


class TestAccessibility:
    def test_a_neighbour_over_a_face_counts_twice_one_over_an_edge(self):
        scores = [value("accessibility", body([(0, 0, 0), cell])) for cell in ((0, 0, 1), (0, 1, 1), (1, 1, 1))]
        assert scores == pytest.approx([1 / 14, 0.5 / 14, 0.25 / 14])

    def test_a_column_and_a_block_all_round(self):
        n = 9
        assert value("accessibility", body(column(n))) == pytest.approx(2 * (n - 1) / (14 * n))
        cube = grid(3, 3, 3)
        # by kind: 54 pairs over faces, 72 over edges, 32 over corners; each counts for both blocks
        assert value("accessibility", body(cube)) == pytest.approx(2 * (54 + 72 / 2 + 32 / 4) / (14 * 27))

    def test_large_solid_bodies_come_near_to_one(self):
        assert value("accessibility", body(grid(12, 12, 12))) > 0.85

    def test_iso_spatial_neighbours_all_share_faces(self):
        assert value("accessibility", body([(0, 0, 0), (0, 1, 1)], lattice=ISOSPATIAL)) == pytest.approx(1 / 12)

    def test_one_block_has_none(self):
        assert value("accessibility", body([(0, 0, 0)])) == 0


class TestMargins:
    def test_stability_is_what_is_left_of_the_worst_joint(self):
        assert value("stability", body(column(6)), axial_strength=8.0) == pytest.approx(0.25)
        assert value("stability", body(column(6)), axial_strength=3.0) == pytest.approx(-1)
        assert value("stability", cantilever(4), torsion_strength=16.0, axial_strength=100.0) == pytest.approx(0.5)
        assert value("stability", body(column(6))) == 1
        assert value("stability", body([(0, 0, 0), (0, 0, 3)]), axial_strength=100.0) == -1

    def test_self_support_is_the_worst_stage(self):
        one = structure(body(column(6)), axial_strength=8.0)
        assert BLOCK_CRITERIA["self_support"](one) == pytest.approx(0.25)
        staged = Structure(one.body, replace(one.load, margins=(0.5, 0.1, 0.25)))
        assert BLOCK_CRITERIA["self_support"](staged) == 0.1
        assert BLOCK_CRITERIA["stability"](staged) == 0.25


class TestExposedSurface:
    def test_columns_cubes_and_envelopes(self):
        assert value("exposed_surface", body([(0, 0, 0)])) == 5
        assert value("exposed_surface", body([(0, 0, 0)], boundary=[])) == 6
        assert value("exposed_surface", body(column(9))) == 4 * 9 + 1
        assert value("exposed_surface", body(grid(4, 4, 4))) == 5 * 16
        assert value("exposed_surface", body([(0, 0, 0)], envelope=[(0, 0, 1)])) == 9

    def test_a_rhombic_dodecahedron(self):
        alone = body([(0, 0, 0)], boundary=[], lattice=ISOSPATIAL)
        assert value("exposed_surface", alone) == pytest.approx(12 * math.sqrt(2) / 2)

    @settings(max_examples=20, deadline=None)
    @given(bodies())
    def test_equals_the_open_faces(self, one):
        assert value("exposed_surface", one) == len(open_faces(one)[0])


class TestSymmetry:
    @pytest.mark.parametrize("axis", [0, 1])
    @settings(max_examples=15, deadline=None)
    @given(one=bodies(most=25), gap=st.integers(0, 5))
    def test_a_body_beside_its_image_is_symmetric(self, axis, one, gap):
        cells = {tuple(cell) for cell in one.internal.tolist()}
        image = {tuple(gap - v if k == axis else v for k, v in enumerate(cell)) for cell in cells}
        assert value("symmetry", body(sorted(cells | image))) == 1
        swapped = {(gap + y, x - gap, z) for x, y, z in cells}
        assert value("symmetry", body(sorted(cells | swapped))) == 1

    def test_by_hand(self):
        # an L of 3 + 1: its best plane keeps the row of three
        assert value("symmetry", body([(0, 0, 0), (1, 0, 0), (2, 0, 0), (2, 0, 1)])) == 1  # in the plane of y
        skew = [(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 0, 1), (1, 1, 2)]
        assert value("symmetry", body(skew)) == 4 / 6  # four lie in the plane y = 0; the fifth misses its image

    @settings(max_examples=25, deadline=None)
    @given(bodies(most=15))
    def test_equals_a_search_over_all_planes(self, one):
        cells = {tuple(cell) for cell in one.internal.tolist()}
        reach = range(-40, 41)
        images = [
            *[{(c - x, y, z) for x, y, z in cells} for c in reach],
            *[{(x, c - y, z) for x, y, z in cells} for c in reach],
            *[{(y + c, x - c, z) for x, y, z in cells} for c in reach],
            *[{(c - y, c - x, z) for x, y, z in cells} for c in reach],
        ]
        assert value("symmetry", one) == max(len(cells & image) / len(cells | image) for image in images)

    @settings(max_examples=15, deadline=None)
    @given(bodies(most=25))
    def test_turns_and_mirror_images_are_as_symmetric(self, one):
        assert value("symmetry", turned(one)) == value("symmetry", one) == value("symmetry", mirrored(one))


class TestHelicity:
    def helix(self, levels, hand=1):
        return [(x, hand * y, z) for z, (x, y) in enumerate(itertools.islice(itertools.cycle(HELIX), levels))]

    def test_columns_straight_leaning_and_planar_have_none(self):
        assert value("helicity", body(column(20))) == 0
        assert value("helicity", body([(z, 0, z) for z in range(20)])) == 0
        assert value("helicity", body([(z, z, z) for z in range(21)])) == 0
        assert value("helicity", body([(abs(z % 8 - 4), 0, z) for z in range(40)])) == 0
        assert value("helicity", body([(0, 0, 0)])) == 0

    @pytest.mark.parametrize("levels", [16, 24, 80])
    def test_a_helix_has_all_whichever_its_sense(self, levels):
        assert value("helicity", body(self.helix(levels))) == pytest.approx(1)
        assert value("helicity", body(self.helix(levels, hand=-1))) == pytest.approx(1)

    def test_half_a_turn_has_less_than_a_whole_one(self):
        half, whole = (value("helicity", body(self.helix(levels))) for levels in (5, 9))
        assert 0 < half < whole <= 1

    def test_a_helix_that_turns_back_loses_it(self):
        there = self.helix(17)
        back = [(x, y, 32 - z) for x, y, z in there[:16]]
        assert value("helicity", body([*there, *sorted(back, key=lambda cell: cell[2])])) < 0.05

    @settings(max_examples=20, deadline=None)
    @given(bodies())
    def test_mirror_images_and_turns_have_the_same(self, one):
        assert value("helicity", mirrored(one)) == pytest.approx(value("helicity", one), abs=1e-9)
        assert value("helicity", turned(one)) == pytest.approx(value("helicity", one), abs=1e-9)
        assert 0 <= value("helicity", one) <= 1


class TestSun:
    def test_a_cube_on_the_ground(self):
        """Top and two sides are lit at any hour; its shadow off its foot is (|x| + |y|) / z of the sun's direction."""
        x, y, z = np.abs(suns()).T
        assert value("sun", body([(0, 0, 0)])) == pytest.approx(3 / 5 - ((x + y) / z).mean() / 5)

    def test_a_row_across_the_sun_is_lit_as_its_faces_say(self):
        n = 10
        x, y, z = np.abs(suns()).T
        lit = (2 * n + 1) / (4 * n + 1 + 0 * n - n + 1)
        row = body([(k, 0, 0) for k in range(n)])
        exposed = 3 * n + 2
        assert lit == (2 * n + 1) / exposed
        assert value("sun", row) == pytest.approx(lit - ((x + n * y) / z).mean() / exposed)

    def test_what_stands_behind_a_wall_is_not_lit(self):
        behind = body([(0, 0, 0)], boundary=[(x, -1, z) for x in range(-30, 31) for z in range(-1, 30)])
        assert value("sun", behind) == pytest.approx(0)

    def test_morning_and_afternoon_are_alike(self):
        assert suns() * (-1, 1, 1) == pytest.approx(suns()[::-1])
        assert np.linalg.norm(suns(), axis=1) == pytest.approx(np.ones(6))

    @settings(max_examples=15, deadline=None)
    @given(bodies())
    def test_a_body_and_its_image_east_to_west_are_alike(self, one):
        assert value("sun", mirrored(one)) == pytest.approx(value("sun", one), abs=1e-9)
        assert value("sun", one) < 1


class TestParticles:
    @pytest.mark.parametrize("size", [(1, 1, 1), (3, 3, 3), (1, 1, 20), (6, 2, 1)])
    def test_a_convex_body_offers_a_quarter_of_its_surface(self, size):
        a, b, c = size
        free = body(grid(*size), boundary=[])
        assert value("particles", free) == pytest.approx((a * b + b * c + a * c) / 2, rel=0.01)

    def test_a_rhombic_dodecahedron(self):
        free = body([(0, 0, 0)], boundary=[], lattice=ISOSPATIAL)
        assert value("particles", free) == pytest.approx(12 * math.sqrt(2) / 2 / 4, rel=0.02)

    def test_two_far_apart_offer_twice_as_much(self):
        free = body([(0, 0, 0), (9, 9, 9)], boundary=[])
        assert value("particles", free) == pytest.approx(3, rel=0.1)

    def test_a_well_catches_less_than_what_stands_free(self):
        well = [(x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in range(9) if (x, y) != (0, 0)]
        assert 0 < value("particles", body([(0, 0, 0)], boundary=well)) < 0.2


class TestKernels:
    @pytest.mark.parametrize("name", LATTICES)
    @settings(max_examples=20, deadline=None)
    @given(seed=st.integers(0, 2**32 - 1), count=st.integers(1, 60), far=st.integers(-(2**20), 2**20))
    def test_touching(self, name, seed, count, far):
        lattice = LATTICES[name]
        cells = np.array(walk(np.random.default_rng(seed), count, lattice)) + 2 * far
        pairs, kinds = touching(cells, lattice.offsets, lattice.contacts)
        offsets = [tuple(offset) for offset in lattice.offsets.tolist()]
        expected = {}
        for i, j in itertools.combinations(range(count), 2):
            step = tuple((cells[j] - cells[i]).tolist())
            if step in offsets:
                expected[frozenset((i, j))] = lattice.contacts[offsets.index(step)]
        assert {frozenset(pair): kind for pair, kind in zip(pairs.tolist(), kinds.tolist(), strict=True)} == expected
        assert len(pairs) == len(expected)

    @pytest.mark.parametrize("name", LATTICES)
    @settings(max_examples=20, deadline=None)
    @given(seed=st.integers(0, 2**32 - 1), count=st.integers(1, 40))
    def test_first_hits_against_small_steps_to_the_nearest_centre(self, name, seed, count):
        lattice, rng = LATTICES[name], np.random.default_rng(seed)
        cells = np.array(walk(rng, count, lattice))
        starts = rng.normal(size=(20, 3)) * 8
        ways = cells[rng.integers(count, size=20)] + rng.normal(size=(20, 3)) * 0.4 - starts
        sides = np.ascontiguousarray(lattice.offsets[lattice.contacts == FACE])
        met = first_hits(cells, sides, starts, cells_at(starts, lattice), ways)
        steps = np.linspace(0, 3, 6001)
        place = {tuple(cell): k for k, cell in enumerate(cells.tolist())}
        for ray in range(20):
            passed = cells_at(starts[ray] + steps[:, None] * ways[ray], lattice)
            found = next((place[c] for c in map(tuple, passed.tolist()) if c in place), -1)
            if found != met[ray]:  # only a corner cut shorter than a step may be missed by the steps
                assert met[ray] >= 0
                centre = cells[met[ray]]
                near = starts[ray] + steps[:, None] * ways[ray] - centre
                inside = (near @ sides.T <= (sides**2).sum(axis=1) / 2 + 0.02).all(axis=1)
                assert inside.any()

    @pytest.mark.parametrize("name", LATTICES)
    def test_points_lie_in_the_cell_with_the_nearest_centre(self, name):
        lattice, rng = LATTICES[name], np.random.default_rng(1)
        points = rng.uniform(-3, 3, size=(500, 3))
        every = np.array(
            [c for c in itertools.product(range(-5, 6), repeat=3) if not lattice.parity or sum(c) % 2 == 0]
        )
        nearest = every[((points[:, None] - every) ** 2).sum(axis=2).argmin(axis=1)]
        assert (cells_at(points, lattice) == nearest).all()

    def test_the_spread_is_even(self):
        points = spread(4096)
        assert points.min() >= 0
        assert points.max() < 1
        for a, b in itertools.combinations(range(4), 2):
            counts, _, _ = np.histogram2d(points[:, a], points[:, b], bins=8, range=[[0, 1]] * 2)
            assert np.abs(counts - 64).max() <= 16


class TestScore:
    def test_gives_the_scores_in_order(self):
        assert list(score(structure(body(column(3))), ["rise", "height"]).items()) == [("rise", 6.0), ("height", 3.0)]

    def test_a_plug_in_that_raises_or_gives_no_number_is_a_failure(self, monkeypatch):
        monkeypatch.setattr(plugin_criteria, "odd", lambda structure: math.nan, raising=False)
        found = score(structure(body(column(3))), ["height", "plugin_criteria:odd"])
        assert found == Failure("evaluation", "plugin_criteria:odd: nan is not a finite number")
        monkeypatch.setattr(plugin_criteria, "odd", lambda structure: structure.body.cells.fill(0))
        found = score(structure(body(column(3))), ["plugin_criteria:odd"])
        assert found == Failure("evaluation", "plugin_criteria:odd: ValueError: assignment destination is read-only")

    def test_names_are_resolved_as_everywhere(self):
        assert resolve("height") is BLOCK_CRITERIA["height"]
        assert resolve("plugin_criteria:vertices") is plugin_criteria.vertices
        with pytest.raises(InputError, match="fitness: expected a criterion, got 'hight'; did you mean 'height'"):
            resolve("hight")


def test_scipy_waits_until_a_model_needs_it():
    code = "import sys, evaluators.blocks.load as _; print('scipy.sparse' in sys.modules, 'trimesh' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "False"]
