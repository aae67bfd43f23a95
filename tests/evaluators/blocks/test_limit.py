"""The load factor: closed forms, bounds from both sides, certified by its own equilibrium."""

import math

import numpy as np
import pytest
from bodies import body, cantilever, column, walk

from evaluators.blocks.load import LoadSettings, analyse
from evaluators.blocks.load.limit import _faces

STRONG = 1e6


def limit(one, axial=None, torsion=None, **how):
    return analyse(one, LoadSettings(model="limit", axial_strength=axial, torsion_strength=torsion, **how))


@pytest.mark.parametrize("n", [1, 5, 20])
def test_a_column_bears_its_strength_over_its_weight(n):
    found = limit(body(column(n)), axial=50.0, torsion=1.0, weight=2.0)
    assert found.factor == pytest.approx(50 / (2 * n), rel=1e-6)
    assert found.residual < 1e-9


@pytest.mark.parametrize("n", [1, 5, 20])
def test_a_cantilever_breaks_at_its_root(n):
    found = limit(cantilever(n), axial=STRONG, torsion=30.0)
    assert found.factor == pytest.approx(30 / (n * n / 2), rel=1e-6)
    assert found.margin == pytest.approx(1 - 1 / found.factor)


def test_a_clamped_beam_has_three_hinges():
    """By hand: half the weight, 3.5, at each end joint, where the moment is -m, and +m at the joints beside the middle.

    From the end joint to the one before the middle block, 3 units on: 2 m = 3.5 * 3 - (2.5 + 1.5 + 0.5) = 6.
    """
    one = body([(x, 0, 0) for x in range(7)], boundary=[(-1, 0, 0), (7, 0, 0)])
    found = limit(one, axial=STRONG, torsion=10.0)
    assert found.factor == pytest.approx(10 / 3, rel=1e-6)


def test_the_limit_is_not_under_what_elastic_joints_bear_nor_over_what_equilibrium_allows():
    rng = np.random.default_rng(5)
    for count in (10, 25, 40):
        one = body(walk(rng, count, branch=0.3, straight=0.3))
        found = limit(one, axial=60.0, torsion=90.0)
        elastic = analyse(one, LoadSettings(model="frame", axial_strength=60.0, torsion_strength=90.0))
        assert found.factor >= 0.98 / (1 - elastic.margin)
        ground = found.joints[:, 0] >= count
        assert found.factor * count <= ground.sum() * 60.0
        assert found.translational.max() <= 60.0 / found.factor * (1 + 1e-9)
        assert found.torsional.max() <= 90.0 / found.factor * (1 + 1e-9)
        assert found.residual < 1e-9
        assert found.forces[ground].sum(axis=0) == pytest.approx([0, 0, -count], abs=1e-7)


def test_stable_means_a_factor_of_one_at_least():
    assert limit(body(column(10)), axial=10.0).stable
    weak = limit(body(column(10)), axial=9.9)
    assert not weak.stable
    assert weak.factor == pytest.approx(0.99)
    assert weak.failed.size == 1


def test_without_strengths_there_is_no_end():
    assert limit(body(column(3))).factor == math.inf
    assert limit(body(column(3)), torsion=1.0).factor == math.inf
    assert limit(body(column(3))).stable
    assert limit(body(column(3))).translational.max() == pytest.approx(3)


def test_what_floats_bears_nothing():
    found = limit(body([(0, 0, 0), (0, 0, 5)], boundary=[(0, 0, -1)]), axial=10.0)
    assert found.factor == 0
    assert not found.stable


def test_the_polyhedron_is_inside_the_ball_by_the_error_that_is_stated():
    faces, reach = _faces(np.array([[True, False]]))
    normals = faces.toarray()[:, :3]
    assert normals.shape == (320, 3)
    assert not faces.toarray()[:, 3:].any()
    assert np.linalg.norm(normals, axis=1) == pytest.approx(np.ones(320))
    assert 0.982 <= reach.min() <= reach.max() < 1
    turned = np.random.default_rng(1).normal(size=(2000, 3))
    turned /= np.linalg.norm(turned, axis=1)[:, None]
    assert ((turned @ normals.T / reach).max(axis=1) >= 1 - 1e-12).all()  # nothing beyond the sphere is let in
