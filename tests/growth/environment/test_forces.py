"""Forces against their formula."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from solids import points

from growth.environment import Environment, environment_from
from growth.environment._kernels import LEAST_DISTANCE


def _environment(**keys: object) -> Environment:
    return environment_from(keys, "test.yaml", Path())


def test_the_sum_of_all_forces_equals_the_formula_of_section_4_7() -> None:
    attractors = [{"at": [0, 0, 3]}, {"at": [1.5, -2, 0.25], "strength": 0.7, "exponent": 1}]
    repellers = [{"at": [-1, 2, -0.5], "strength": 2.5, "exponent": 3}, {"at": [4, 4, 4], "exponent": 0}]
    at = points(1)
    expected = np.tile([0.1, -0.2, -0.3], (len(at), 1))
    for sign, sources in ((1, attractors), (-1, repellers)):
        for source in sources:
            away = np.array(source["at"], dtype=float) - at
            distance = np.linalg.norm(away, axis=1, keepdims=True)
            expected += sign * source.get("strength", 1) / distance ** source.get("exponent", 2) * away / distance
    got = _environment(gravity=[0.1, -0.2, -0.3], attractors=attractors, repellers=repellers).forces(at)
    np.testing.assert_allclose(got, expected, rtol=1e-12, atol=1e-13)


def test_an_attractor_at_distance_two_pulls_with_a_quarter() -> None:
    force = _environment(attractors=[{"at": [0, 0, 3]}]).forces([[0, 0, 1]])
    np.testing.assert_array_equal(force, [[0, 0, 0.25]])


@pytest.mark.parametrize("kind", ["attractors", "repellers"])
def test_a_point_at_the_source_feels_nothing_and_one_near_it_a_finite_force(kind: str) -> None:
    environment = _environment(**{kind: [{"at": [1, 2, 3], "exponent": 16}]})
    force = environment.forces([[1, 2, 3], [1, 2, 3 + 1e-9], [1, 2, 3 + 1e-160]])
    np.testing.assert_array_equal(force[0], 0.0)
    sign = -1 if kind == "attractors" else 1
    np.testing.assert_allclose(force[1], [0, 0, sign / LEAST_DISTANCE**16], rtol=1e-12)
    assert np.isfinite(force).all()


def test_empty_space_pulls_on_nothing_stops_nothing_and_counts_nothing() -> None:
    empty = Environment.empty()
    at = points(2)
    np.testing.assert_array_equal(empty.forces(at), 0.0)
    np.testing.assert_array_equal(empty.move(at, at[::-1]), at[::-1])
    np.testing.assert_array_equal(empty.release(at), at)
    assert not empty.inside(at).any()
    assert empty.wrong_side(at) == 0
    assert not empty.has_hard


def test_no_points_are_no_trouble() -> None:
    environment = _environment(gravity=[0, 0, -1], boundaries=[{"shape": "sphere", "at": [0, 0, 0], "radius": 1}])
    none = np.empty((0, 3))
    assert environment.forces(none).shape == environment.move(none, none).shape == (0, 3)
    released = environment.release(none)
    assert released is not None
    assert released.shape == (0, 3)
