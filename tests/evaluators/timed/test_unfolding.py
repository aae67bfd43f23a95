"""Unfolding a system, its settings, and what every criterion of timed forms must hold to."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from animals import BODY, SPHERE, animal, drawing, placed, sequence, still, walker

from evaluators.timed import TIMED_CRITERIA, TimedForm, Unfolding, resolve, score, unfold
from genome.errors import InputError
from genome.settings import validated
from genome.timed import parse_tl
from growth.protocol import Failure
from growth.timed import derive
from growth.timed.turtle import draw

FILAMENT = parse_tl("axiom A(1)\nA(x) @ 1 -> F(x) A(x) !(0.2)\n", "test")
FORMS = {
    "one part": still(BODY),
    "something out of nothing": sequence(drawing(), drawing(BODY)),
    "an animal": animal(walker([0, 0.5])),
    "shapes": still(BODY, (SPHERE, placed(x=3))),
    "a point": still((SPHERE, placed(wide=0.0, high=0.0))),
}


def same(first, second):
    fields = ("which", "frames", "colours", "lineages", "tips", "tip_lineages")
    return all(np.array_equal(getattr(first, name), getattr(second, name)) for name in fields)


class TestUnfolding:
    def test_draws_at_even_times_both_ends_counted(self):
        seen = unfold(FILAMENT, TimedForm(since=0.5, time=4.5, samples=5))
        assert seen.times.tolist() == [0.5, 1.5, 2.5, 3.5, 4.5]
        assert [len(one) for one in seen.drawings] == [0, 1, 2, 3, 4]
        assert seen.form is seen.drawings[-1]
        for time, one in zip(seen.times.tolist(), seen.drawings, strict=True):
            assert one.time == time
            assert same(one, draw(derive(FILAMENT, time)))

    def test_one_sample_is_the_last(self):
        seen = unfold(FILAMENT, TimedForm(since=0.5, time=4.5, samples=1))
        assert seen.times.tolist() == [4.5]
        assert len(seen.form) == 4

    def test_the_seed_and_the_turtle_reach_the_form(self):
        random = parse_tl("axiom A\nA @ 1 -> F(random(1, 2))\n", "test")
        forms = [unfold(random, TimedForm(time=2.0, samples=2), seed).form for seed in (1, 1, 2)]
        assert same(forms[0], forms[1])
        assert not same(forms[0], forms[2])
        wide = unfold(random, validated(TimedForm, {"time": 2, "samples": 2, "turtle": {"radius": 3.0}}, "x"), 1).form
        assert wide.frames[0, :3, :2].max() == pytest.approx(3.0)

    @pytest.mark.parametrize(
        ("text", "growth", "reason"),
        [
            ("axiom f(1)", {}, "empty: the word draws nothing at time 1"),
            ("axiom F(1) G\nG @ 0.5 -> G G\n", {"time": 30.0, "max_modules": 99}, "budget: more modules"),
            ("axiom F(1) A(0)\nA(x) @ 0.5 -> A(1/x)\n", {}, "expression: "),
            ("axiom sphere(1, 2, 3)", {}, "rules: "),
            ("axiom F(1) F(1)", {"turtle": {"max_parts": 1}}, "budget: "),
        ],
    )
    def test_failures_are_values(self, text, growth, reason):
        found = unfold(parse_tl(text, "test"), validated(TimedForm, growth, "growth"))
        assert isinstance(found, Failure)
        assert str(found).startswith(reason)

    def test_the_clock_bounds_all_times_together(self):
        ticks = iter(range(1000))
        found = unfold(FILAMENT, TimedForm(time=4.0, samples=12, max_seconds=20.0), clock=lambda: float(next(ticks)))
        assert found == Failure("clock", "the growth and its drawings took longer than max_seconds")


class TestSettings:
    def test_usual_ones(self):
        usual = TimedForm()
        assert (usual.time, usual.since, usual.samples) == (1.0, 0.0, 12)

    @pytest.mark.parametrize(
        ("given", "message"),
        [
            ({"time": 0}, "time"),
            ({"time": 1, "since": 1.0}, "a time before time"),
            ({"since": -1}, "since"),
            ({"samples": 0}, "samples"),
            ({"turtle": {"sides": 2}}, "turtle"),
            ({"tempo": 3}, "tempo"),
        ],
    )
    def test_mistakes_are_told_by_their_key(self, given, message):
        with pytest.raises(InputError, match=message):
            validated(TimedForm, given, "growth")


@pytest.mark.parametrize("name", TIMED_CRITERIA)
class TestCriterion:
    @pytest.mark.parametrize("form", FORMS.values(), ids=FORMS)
    def test_gives_one_finite_float_every_time_and_changes_nothing(self, name, form):
        before = [replace(one, frames=one.frames.copy(), tips=one.tips.copy()) for one in form.drawings]
        first, second = TIMED_CRITERIA[name](form), TIMED_CRITERIA[name](form)
        assert type(first) is float
        assert math.isfinite(first)
        assert first == second
        assert all(same(one, other) for one, other in zip(before, form.drawings, strict=True))

    def test_is_named_like_its_file_and_documented(self, name):
        criterion = TIMED_CRITERIA[name]
        assert resolve(name) is criterion
        assert criterion.__module__ == f"evaluators.timed.{name}"
        assert criterion.__name__ == name
        assert name == "parts" or "Returns\n" in (criterion.__doc__ or "")

    def test_stands_in_the_docs(self, name):
        assert f"| `{name}` |" in Path("docs/timed-criteria.md").read_text()


class TestScore:
    def test_gives_scores_in_the_order_asked_for(self):
        found = score(still(BODY), ["size", "parts"])
        assert found == {"size": pytest.approx(1.0), "parts": 1.0}
        assert list(found) == ["size", "parts"]

    def test_an_unknown_name_is_told_with_the_nearest(self):
        with pytest.raises(InputError, match="stride"):
            resolve("strid", "islands.a.fitness.strid")

    def test_criteria_cannot_write_and_what_they_raise_is_a_failure(self):
        for spoil in (
            lambda seen: seen.form.frames.fill(0.0),
            lambda seen: seen.form.shapes[0].vertices.fill(0.0),
            lambda seen: seen.drawings[0].tips.fill(0.0),
            lambda seen: seen.times.fill(0.0),
        ):
            form = animal(walker([0, 0.5]))
            found = score(form, {"spoil": spoil})
            assert isinstance(found, Failure)
            assert found.detail.startswith("spoil: ")
            assert "read-only" in found.detail

    def test_a_plug_in_sees_the_whole_unfolding(self):
        seen = animal(walker([0, 0.5]))
        assert score(seen, {"samples": lambda one: float(len(one.times))}) == {"samples": 13.0}
        assert isinstance(seen, Unfolding)
