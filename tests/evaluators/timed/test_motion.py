"""Criteria of development and motion: closed forms for growths and gaits made by hand, and the shipped animal."""

from pathlib import Path

import numpy as np
import pytest
from animals import BODY, CYLINDER, animal, drawing, placed, sequence, still, walker
from hypothesis import given, settings
from hypothesis import strategies as st

from evaluators.timed import TIMED_CRITERIA, TimedForm, Unfolding, unfold
from evaluators.timed.steadiness import steadiness
from genome.timed import parse_tl

SYSTEMS = Path("experiments/systems")
GAIT = (SYSTEMS / "gait.tl").read_text()


def motion(tracks, lineages=None):
    seen = animal(tracks, lineages)
    return tuple(TIMED_CRITERIA[name](seen) for name in ("stride", "evenness", "lift"))


def growing(*scales):
    return sequence(*(drawing((CYLINDER, placed(wide=scale, high=scale))) for scale in scales))


def smoothness(*scales):
    return TIMED_CRITERIA["smoothness"](growing(*scales))


class TestSteadiness:
    @pytest.mark.parametrize(
        ("values", "expected"),
        [([2, 2, 2], 1), ([5], 1), ([0, 0, 4], 0), ([3, 3, 0, 0, 0], 0.25), ([0, 0], 0), ([], 0), ([1, -1], 0),
         ([-1, -1], 0), ([1, 3], 0.5)],
    )  # fmt: skip
    def test_closed_forms(self, values, expected):
        assert steadiness(np.array(values, dtype=float)) == pytest.approx(expected, abs=1e-12)

    @settings(max_examples=50)
    @given(st.lists(st.floats(-1e3, 1e3), min_size=1, max_size=20), st.floats(1e-3, 1e3))
    def test_is_a_share_and_knows_no_unit(self, values, factor):
        numbers = np.array(values)
        assert 0 <= steadiness(numbers) <= 1
        if numbers.mean() > 1e-6 * np.abs(numbers).max():
            assert steadiness(numbers * factor) == pytest.approx(steadiness(numbers), abs=1e-6)


class TestSmoothness:
    def test_even_growth_is_smooth_up_and_down(self):
        assert smoothness(1, 2, 3, 4, 5) == pytest.approx(1, abs=1e-9)
        assert smoothness(1, 2, 3, 2, 1) == pytest.approx(1, abs=1e-9)
        assert smoothness(4, 3, 2, 1) == pytest.approx(1, abs=1e-9)
        assert smoothness(1, 2, 3, 2) == pytest.approx(1, abs=1e-9)

    def test_no_change_and_one_sample_are_smooth(self):
        assert smoothness(2, 2, 2) == 1
        assert smoothness(2) == 1

    def test_a_jump_is_not(self):
        assert smoothness(1, 1, 1, 3, 3) == pytest.approx(0, abs=1e-9)

    def test_growth_in_three_of_five_intervals_is_half_smooth(self):
        assert smoothness(1, 2, 3, 4, 4, 4) == pytest.approx(0.5, abs=1e-9)

    def test_a_part_that_comes_in_at_once_is_a_jump(self):
        one, two = drawing(BODY), drawing(BODY, (CYLINDER, placed(z=1, wide=0.1, high=0.1)))
        assert TIMED_CRITERIA["smoothness"](sequence(drawing(), drawing(), one, one)) == pytest.approx(0, abs=1e-9)
        assert TIMED_CRITERIA["smoothness"](sequence(one, one, two)) == pytest.approx(0, abs=1e-9)

    def test_the_clock_s_unit_does_not_matter(self):
        grown = growing(1, 2, 4)
        slower = Unfolding(grown.times * 7, grown.drawings)
        assert TIMED_CRITERIA["smoothness"](slower) == TIMED_CRITERIA["smoothness"](grown)


class TestGait:
    @pytest.mark.parametrize("cycles", [1, 3])
    @pytest.mark.parametrize("heading", [0.0, 90.0, 217.0])
    def test_two_legs_by_turns(self, cycles, heading):
        # Each goes 2 x 0.5 back in half a cycle of 12 samples, while the other is in the air.
        tracks = walker([0, 0.5], cycles=cycles, heading=heading)
        assert motion(tracks) == pytest.approx((1.0, 1.0, 0.25), rel=1e-9)

    @pytest.mark.parametrize("legs", [3, 4, 6])
    def test_a_wheel_of_legs_rolls_evenly(self, legs):
        assert motion(walker(np.arange(legs) / legs, duty=1 / 3 if legs == 3 else 0.5)) == pytest.approx(
            (1.0, 1.0, 0.25), rel=1e-9
        )

    def test_legs_that_hop_together_are_uneven(self):
        # They push in 6 of 12 intervals: ((6 - 1) / (12 - 1))^2.
        stride, evenness, lift = motion(walker([0, 0, 0]))
        assert (stride, evenness) == pytest.approx((1.0, (5 / 11) ** 2), rel=1e-9)
        assert lift == pytest.approx(0.25)

    def test_one_speed_on_a_changing_number_of_feet(self):
        # Two and one by turns, all at one speed: in 12 intervals 12 x 0.5 / 2 of (12 - 1) x 1.5 would have to move.
        assert motion(walker([0, 0, 0.5]))[1] == pytest.approx(1 - 3 / 16.5, rel=1e-9)

    def test_lift_is_from_a_foot_s_own_lowest_place(self):
        tracks = walker([0, 0.5])
        tracks[:, 1, 2] += 0.002  # of a body of size 1: still on the ground
        assert motion(tracks) == pytest.approx((1.0, 1.0, 0.25), rel=1e-9)

    def test_a_longer_reach_is_a_longer_stride(self):
        assert motion(walker([0, 0.5], reach=0.8))[0] == pytest.approx(1.6)

    def test_who_stands_still_gets_nowhere(self):
        assert motion(np.zeros((9, 2, 3)) + np.eye(3)[:2]) == (0, 0, 0)

    def test_who_shuffles_gets_nowhere(self):
        there_and_back = np.zeros((9, 2, 3))
        there_and_back[:, :, 0] = np.sin(np.linspace(0, 2 * np.pi, 9))[:, None]
        stride, evenness, lift = motion(there_and_back)
        assert stride == pytest.approx(0, abs=1e-12)
        assert (evenness, lift) == (0, 0)

    def test_legs_that_push_against_each_other_get_nowhere(self):
        tracks = walker([0, 0])
        tracks[:, 1, 0] *= -1
        stride, evenness, lift = motion(tracks)
        assert stride == pytest.approx(0, abs=1e-12)
        assert evenness == 0
        assert lift == pytest.approx(0.25)

    def test_legs_that_swing_across_take_no_part(self):
        forward, across = walker([0, 0.5]), walker([0, 0.5], heading=90.0)
        across[:, 1] = across[:, 0] * [1, -1, 1]
        # What the two go sideways cancels, and they count as feet that push nothing: (1 + 1 + 0 + 0) / 4.
        assert motion(np.concatenate([forward, across], axis=1))[0] == pytest.approx(0.5)

    def test_a_dragged_tail_shares_the_stride_and_has_no_lift(self):
        tail = np.full((13, 1, 3), [-2, 0, 0])
        stride, _, lift = motion(np.concatenate([walker([0, 0.5]), tail], axis=1))
        assert stride == pytest.approx(2 / 3)
        assert lift == pytest.approx(0.5 / 3)

    def test_what_grows_along_the_ground_takes_no_steps(self):
        runner = np.zeros((13, 1, 3))
        runner[:, 0, 0] = -np.arange(13)
        assert motion(runner) == (0, 0, 0)
        # Beside two legs it is a third foot that pushes nothing, and does not turn the heading.
        sideways = runner[:, :, [1, 0, 2]]
        assert motion(np.concatenate([walker([0, 0.5]), sideways], axis=1)) == pytest.approx((2 / 3, 1.0, 0.5 / 3))

    def test_tips_at_random_places_get_nowhere(self):
        tracks = np.random.default_rng(0).uniform(0, 1, (25, 10, 3))
        stride, evenness, _ = motion(tracks)
        assert (stride, evenness) == (0, 0)

    def test_what_stays_above_the_ground_is_no_foot(self):
        feelers = walker([0.3, 0.9]) + np.array([0, 5, 0.7])
        assert motion(np.concatenate([walker([0, 0.5]), feelers], axis=1)) == pytest.approx((1.0, 1.0, 0.25))

    def test_a_step_in_the_window_s_middle_counts_as_one_that_it_cuts(self):
        assert motion(walker([0.25, 0.75]))[0] == pytest.approx(1.0)

    def test_feet_are_told_by_lineage_and_not_by_place_in_the_list(self):
        tracks = walker([0, 0.5, 0.25])
        mixed = []
        for at, places in enumerate(tracks):
            order = np.roll(np.arange(3), at)
            mixed.append(drawing(BODY, tips=places[order], lineages=np.array([7, -3, 9])[order]))
        seen = sequence(*mixed)
        assert TIMED_CRITERIA["stride"](seen) == pytest.approx(motion(tracks)[0], rel=1e-12)
        assert TIMED_CRITERIA["evenness"](seen) == pytest.approx(motion(tracks)[1], rel=1e-12)

    def test_tips_that_do_not_live_throughout_or_never_moved_are_no_feet(self):
        low = [0, 0, -1]  # would be the ground
        drawings = [drawing(BODY, tips=[*places, low, low], lineages=[1, 2, 0, 50 + (at > 4)])
                    for at, places in enumerate(walker([0, 0.5]))]  # fmt: skip
        found = tuple(TIMED_CRITERIA[name](sequence(*drawings)) for name in ("stride", "evenness", "lift"))
        assert found == pytest.approx((1.0, 1.0, 0.25))

    def test_without_tips_or_with_one_sample_nothing_moves(self):
        for seen in (still(BODY), sequence(drawing(BODY), drawing(BODY)), animal(walker([0, 0.5])[:1])):
            assert [TIMED_CRITERIA[name](seen) for name in ("stride", "evenness", "lift")] == [0, 0, 0]

    @settings(max_examples=40)
    @given(st.lists(st.floats(0, 1), min_size=1, max_size=6), st.floats(0, 360), st.floats(0.1, 100))
    def test_neither_heading_nor_unit_matters(self, phases, heading, unit):
        first = motion(walker(phases))
        turned = animal(
            unit * walker(phases, heading=heading), body=(CYLINDER, placed(z=unit, wide=0.2 * unit, high=unit))
        )
        again = tuple(TIMED_CRITERIA[name](turned) for name in ("stride", "evenness", "lift"))
        assert (again[0] / unit, again[1], again[2] / unit) == pytest.approx(first, rel=1e-6, abs=1e-9)
        assert 0 <= first[0] <= 1 + 1e-9
        assert 0 <= first[1] <= 1


def walked(text, samples=25, seed=0, since=2.0, until=4.0):
    seen = unfold(parse_tl(text, "gait"), TimedForm(since=since, time=until, samples=samples), seed)
    assert isinstance(seen, Unfolding)
    return [TIMED_CRITERIA[name](seen) for name in ("stride", "evenness", "lift")]


def without(text, *names):
    for name in names:
        assert f"#define {name} " in text
        text = text.replace(f"#define {name} ", f"#define {name} 0*")
    return text


class TestTheShippedAnimal:
    def test_walks(self):
        stride, evenness, lift = walked(GAIT)
        assert stride > 2.2
        assert evenness > 0.85
        assert lift > 0.1

    def test_gets_nowhere_when_its_legs_do_not_swing(self):
        stride, evenness, lift = walked(without(GAIT, "ASW"))
        assert (stride, evenness) == (0, 0)
        assert lift > 0.1

    def test_gets_nowhere_when_it_lifts_no_foot(self):
        stride, evenness, lift = walked(without(GAIT, "ASU", "ASK", "RSK", "AST"))
        assert (stride, evenness) == (0, 0)
        assert lift < 1e-9

    def test_hops_when_all_legs_have_one_phase(self):
        together = GAIT.replace("leg(phi + pi, LEG, -1)", "leg(phi, LEG, -1)").replace("STEP pi/2.5", "STEP 0")
        assert together != GAIT
        assert walked(together)[1] < 0.5 * walked(GAIT)[1]

    def test_is_more_even_than_with_legs_at_random(self):
        haphazard = GAIT
        for own_phase in ("[ +(pi/2) leg(phi,", "[ -(pi/2) leg(phi + pi,"):
            assert own_phase in haphazard
            haphazard = haphazard.replace(own_phase, f"{own_phase[:14]}random(0, 2*pi),")
        own = walked(GAIT)
        for seed in range(6):
            stride, evenness, _ = walked(haphazard, seed=seed)
            assert stride == pytest.approx(own[0], rel=0.02)
            assert evenness < own[1] - 0.05

    def test_a_gait_is_the_same_whenever_it_is_watched_and_however_often(self):
        own = walked(GAIT)
        assert walked(GAIT, since=2.25, until=4.25) == pytest.approx(own, rel=0.01)
        assert walked(GAIT, samples=49, until=6.0) == pytest.approx(own, rel=0.01)
        assert walked(GAIT, samples=97) == pytest.approx(own, rel=0.04)
