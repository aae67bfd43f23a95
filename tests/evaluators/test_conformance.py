"""What every criterion in the registry must hold to; a new one is checked here without being named."""

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from surfaces import FORMS, forms, surface

from evaluators.registry import CRITERIA
from evaluators.score import score
from growth.environment import environment_from
from growth.protocol import Failure

ARRAYS = ("vertices", "edges", "labels", "face_starts", "face_vertices")


HERE = environment_from(
    {"boundaries": [{"shape": "sphere", "at": [0, 0, 0], "radius": 2, "soft": True}]}, "site.yaml", Path()
)


@pytest.mark.parametrize("name", CRITERIA)
class TestCriterion:
    @pytest.mark.parametrize("form", FORMS.values(), ids=FORMS)
    def test_gives_one_finite_float_every_time_and_changes_nothing(self, name, form):
        before = {array: getattr(form, array).copy() for array in ARRAYS}
        first, second = CRITERIA[name](form, HERE), CRITERIA[name](form, HERE)
        assert type(first) is float
        assert math.isfinite(first)
        assert first == second
        for array in ARRAYS:
            assert np.array_equal(getattr(form, array), before[array])

    @settings(max_examples=30)
    @given(form=forms())
    def test_is_finite_for_any_form(self, name, form):
        assert math.isfinite(CRITERIA[name](form, HERE))

    def test_is_named_like_its_file_and_documented(self, name):
        criterion = CRITERIA[name]
        assert criterion.__module__ == f"evaluators.{name}"
        assert criterion.__name__ == name
        assert "Returns\n" in (criterion.__doc__ or "")

    def test_gives_a_number_or_a_failure_for_an_empty_form(self, name):
        found = score(surface([], []), HERE, [name])
        assert isinstance(found, Failure) or math.isfinite(found[name])


def test_the_six_of_genr8_are_there():
    assert sorted(CRITERIA) == ["size", "smoothness", "soft_boundaries", "subdivisions", "symmetry", "undulation"]
