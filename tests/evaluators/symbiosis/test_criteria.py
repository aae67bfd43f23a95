"""Criteria of symbiotic species: against a plain reference, and what all of them must hold to."""

import gc
import math
import weakref

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from partners import CUBIC, SQUARE, ball, mapped, partners, random_partners, shell, symmetries
from reference_symbiosis import Reference

from evaluators.symbiosis import LOGGED, SYMBIOSIS_CRITERIA, Surroundings, resolve, score, surroundings
from evaluators.symbiosis.grid import LARGEST
from genome.errors import InputError
from growth.protocol import Failure

WALKED = {"route", "route_joins", "route_reaches", "doors"}
"""Those that know which way is up."""


class TestAll:
    @settings(max_examples=150)
    @given(one=random_partners())
    def test_equal_the_plain_reference(self, one):
        assert score(one, LOGGED) == pytest.approx(Reference(one).scores(), rel=1e-12, abs=1e-12)

    @settings(max_examples=25)
    @given(one=random_partners(), far=st.tuples(*[st.integers(-(2**40), 2**40)] * 3), data=st.data())
    def test_move_turn_and_mirror_with_the_partners(self, one, far, data):
        before = score(one, LOGGED)
        shift = 2 * np.array(far)  # even: within the iso-spatial lattice
        assert score(mapped(one, lambda cells: cells + shift), LOGGED) == before
        upright = data.draw(st.booleans()) or one.lattice is SQUARE
        turn = data.draw(st.sampled_from(list(symmetries(upright))))
        after = score(mapped(one, lambda cells: cells @ turn), LOGGED)
        kept = {name for name in LOGGED if upright or name not in WALKED}
        assert {name: after[name] for name in kept} == pytest.approx({name: before[name] for name in kept}, rel=1e-12)

    @settings(max_examples=25)
    @given(one=random_partners())
    def test_stay_in_their_ranges_and_change_nothing(self, one):
        kept = [array.copy() for array in (one.enclosure, one.space, one.route)]
        first = score(one, SYMBIOSIS_CRITERIA)
        assert score(one, SYMBIOSIS_CRITERIA) == first
        assert all((a == b).all() for a, b in zip(kept, (one.enclosure, one.space, one.route), strict=True))
        shares = {
            "enclosure_share",
            "space_share",
            "symbiotic",
            "flood",
            "visibility",
            "economy",
            "overlap",
            "evenness",
        }
        assert all(0 <= first[name] <= 1 for name in shares | WALKED - {"doors"})
        assert all(math.isfinite(value) for value in first.values())

    @pytest.mark.parametrize("name", SYMBIOSIS_CRITERIA)
    def test_give_a_float_and_are_documented(self, name):
        criterion = SYMBIOSIS_CRITERIA[name]
        assert criterion.__name__ == name
        assert "Returns\n" in (criterion.__doc__ or "")
        for one in (partners(), partners(ball(CUBIC, 1)), partners(space=[(0, 0, 0)]), partners(route=[(0, 0, 0)])):
            assert type(criterion(one)) is float


class TestNobody:
    def test_without_anybody_all_is_0_but_i(self):
        assert score(partners(), LOGGED) == {name: 1.0 if name == "i_value" else 0.0 for name in LOGGED}

    def test_one_cell_in_nothing_wins_nothing(self):
        scores = score(partners(space=[(3, 4, 5)]), LOGGED)
        assert scores["symbiotic"] == scores["economy"] == 0
        assert scores["i_value"] == 1


class TestMeasuring:
    def test_what_several_use_is_measured_once(self):
        one = partners(shell(CUBIC, 2), ball(CUBIC, 1))
        assert one.surroundings is one.surroundings
        assert one.surroundings.outside is one.surroundings.outside
        assert isinstance(surroundings(one), Surroundings)

    def test_grids_are_given_back_without_the_collector(self):
        """Hosts keep the collector from their work, so that what holds itself would stay."""
        gc.disable()
        try:
            one = partners(shell(CUBIC, 2), ball(CUBIC, 1), [(2, 0, 0)])
            score(one, LOGGED)
            assert [SYMBIOSIS_CRITERIA[name](one) for name in LOGGED]
            kept = weakref.ref(one.surroundings)
            del one
            assert kept() is None
        finally:
            gc.enable()

    def test_boxes_without_end_are_a_failure(self):
        wide = partners([(0, 0, 0)], [(2**62, 5, 0)])
        found = score(wide, ["flood"])
        box = "4611686018427387907 x 8 x 3"
        told = f"a box of {box} cells around the partners has more than the {LARGEST} that are measured"
        assert found == Failure("evaluation", told)

    def test_unknown_names_are_refused(self):
        with pytest.raises(
            InputError, match=r"^fitness: expected a criterion, got 'symbiosis'; did you mean 'symbiotic'"
        ):
            resolve("symbiosis")

    def test_a_criterion_that_fails_is_named(self):
        found = score(partners(), {"broken": lambda one: math.nan})
        assert found == Failure("evaluation", "broken: nan is not a finite number")
