"""Goals, weights and the total."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from evaluators.fitness import Goal, term, total
from genome.errors import InputError
from genome.settings import validated

FINITE = st.floats(allow_nan=False, allow_infinity=False)
GOALS = st.one_of(
    st.builds(Goal, goal=st.just("target"), value=FINITE, weight=FINITE.map(abs)),
    st.builds(
        Goal,
        goal=st.sampled_from(["maximise", "minimise"]),
        weight=FINITE.map(abs),
        scale=st.floats(5e-324, 1.7e308),
    ),
)


@pytest.mark.parametrize(
    ("goal", "score", "expected"),
    [
        (Goal(goal="target", value=6), 6.0, 0.0),
        (Goal(goal="target", value=6, weight=2), 9.5, -2 * 3.5 / 7),
        (Goal(goal="target", value=-4), 1.0, -1.0),
        (Goal(goal="target", value=0), -3.0, -3.0),
        (Goal(goal="maximise", weight=0.5, scale=2), 8.0, 2.0),
        (Goal(goal="minimise", weight=0.5, scale=4), 8.0, -1.0),
        (Goal(goal="minimise"), -8.0, 8.0),
        (Goal(goal="maximise", weight=0), 8.0, 0.0),
    ],
)
def test_each_goal_adds_its_term(goal, score, expected):
    assert term(score, goal) == expected


def test_the_total_adds_the_terms_of_those_that_have_goals():
    goals = {"size": Goal(goal="target", value=6), "undulation": Goal(goal="maximise", weight=0.5, scale=2)}
    assert total({"size": 13.0, "undulation": 4.0, "symmetry": 1.0}, goals) == -1 + 1
    assert total({"size": 13.0}, {}) == 0
    with pytest.raises(KeyError):
        total({"size": 13.0}, goals)


@given(st.dictionaries(st.sampled_from("abcdef"), st.tuples(FINITE, GOALS)))
def test_the_total_is_finite_and_the_order_does_not_matter(drawn):
    scores = {name: score for name, (score, _) in drawn.items()}
    goals = {name: goal for name, (_, goal) in drawn.items()}
    found = total(scores, goals)
    assert math.isfinite(found)
    assert total(scores, dict(reversed(goals.items()))) == found


@given(FINITE, FINITE, FINITE)
def test_nothing_is_better_than_the_target(target, score, other):
    goal = Goal(goal="target", value=target)
    assert term(target, goal) == 0 >= term(score, goal)
    if abs(score - target) < abs(other - target):
        assert term(score, goal) >= term(other, goal)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ({"goal": "target"}, "x.yaml: size: expected a value for the goal 'target', got none; add value: ..."),
        (
            {"goal": "target", "value": 1, "scale": 2},
            "x.yaml: size: expected no scale with the goal 'target', got 2.0; use the weight",
        ),
        (
            {"goal": "minimise", "value": 3},
            "x.yaml: size: expected no value with the goal 'minimise', got 3.0; did you mean goal: target?",
        ),
        ({"goal": "max"}, "x.yaml: size.goal: expected 'target', 'maximise' or 'minimise', got 'max'"),
        ({}, "x.yaml: size.goal: expected a value for 'goal', got nothing; add the key"),
        ({"goal": "maximise", "scale": 0}, "x.yaml: size.scale: expected greater than 0, got 0"),
        ({"goal": "maximise", "weight": -1}, "x.yaml: size.weight: expected greater than or equal to 0, got -1"),
        ({"goal": "maximise", "weight": True}, "x.yaml: size.weight: expected a number, got True"),
        ({"goal": "maximise", "weight": "1"}, "x.yaml: size.weight: expected a number, got '1'"),
        ({"goal": "target", "value": math.nan}, "x.yaml: size.value: expected a finite number, got nan"),
        ({"goal": "target", "value": math.inf}, "x.yaml: size.value: expected a finite number, got inf"),
        (
            {"goal": "maximise", "wieght": 1},
            "x.yaml: size.wieght: expected a known key, got 'wieght'; did you mean 'weight'?",
        ),
    ],
)
def test_bad_goals_are_refused_by_key(data, message):
    with pytest.raises(InputError) as caught:
        validated(Goal, data, "x.yaml", ("size",))
    assert str(caught.value) == message


def test_a_goal_written_out_with_its_defaults_is_read_again():
    for goal in (Goal(goal="target", value=2), Goal(goal="maximise", scale=3), Goal(goal="minimise")):
        assert validated(Goal, goal.model_dump(), "x.yaml") == goal
