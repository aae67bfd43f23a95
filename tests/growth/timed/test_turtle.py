"""The turtle: where it goes, what it draws, and what it refuses."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import ValidationError

from genome.timed import Equiv, TimedSystem, parse_tl
from genome.timed.commands import TURTLE
from growth.forms import to_trimesh
from growth.protocol import Failure
from growth.timed import TimedGrowth, Word, derive
from growth.timed.drawing import Drawing
from growth.timed.turtle import TurtleSettings, draw
from tests.support.reference_drawing import walk
from tests.support.timed_strategies import systems

NUMBERS = st.one_of(st.sampled_from((0.0, 90.0, 1.0, 30.0)), st.floats(-400.0, 400.0).map(lambda x: round(x, 3)))
COMMANDS = st.builds(
    lambda command, value: f"{command}({value!r})",
    st.sampled_from(["f", "F", "+", "-", "^", "&", "/", "\\", "!", "sphere"]),
    NUMBERS,
)
MANY = "too many parameters; a symbol that has an equiv may have others of its own behind them"
BARE = st.sampled_from(["f", "F", "+", "-", "^", "&", "/", "\\", "|", "$", "Unknown"])
WORDS = st.recursive(
    st.lists(st.one_of(COMMANDS, BARE), max_size=12).map(" ".join),
    lambda inner: st.lists(st.one_of(inner, inner.map(lambda text: f"[ {text} ]")), max_size=4).map(" ".join),
    max_leaves=8,
)


def word_of(text: str, time: float = 0.0) -> Word:
    """Give the word of a system, or of an axiom."""
    word = derive(parse_tl(text if "axiom" in text else f"axiom A\nA @ 0 -> {text}"), time)
    assert isinstance(word, Word), word
    return word


def drawn(text: str, time: float = 0.0, **settings: float) -> Drawing:
    """Draw a system, or a word."""
    drawing = draw(word_of(text, time), TurtleSettings.model_validate(settings))
    assert isinstance(drawing, Drawing), drawing
    return drawing


def refused(text: str, **settings: float) -> str:
    """Give why a word is not drawn."""
    failure = draw(word_of(text), TurtleSettings.model_validate(settings))
    assert isinstance(failure, Failure)
    return str(failure)


def volume(drawing: Drawing) -> float:
    """Give the volume of a drawing whose surface is closed."""
    mesh = to_trimesh(drawing.surface())
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    return float(mesh.volume)


def names(drawing: Drawing) -> list[str]:
    """Give the name of each part's shape."""
    return [drawing.shapes[which].name for which in drawing.which.tolist()]


@given(WORDS)
def test_the_kernel_goes_where_a_plain_turtle_goes(text: str) -> None:
    word = word_of(text)
    stops, tips = walk(word)
    drawing = draw(word)
    assert isinstance(drawing, Drawing)
    np.testing.assert_allclose(drawing.tips, np.array(tips), atol=1e-8)
    assert names(drawing) == [{"F": "cylinder", "sphere": "sphere"}[stop.command] for stop in stops]
    assert drawing.lineages.tolist() == [int(word.lineages[stop.module]) for stop in stops]
    for frame, stop in zip(drawing.frames, stops, strict=True):
        turtle, size = stop.turtle, np.linalg.norm(frame[:3, :3], axis=0)
        expected = np.column_stack([turtle.left, turtle.up, turtle.heading])
        np.testing.assert_allclose(frame[:3, :3] / size, expected, atol=1e-9)
        assert frame[3].tolist() == [0.0, 0.0, 0.0, 1.0]
        if stop.command == "F":
            np.testing.assert_allclose(size[:2], turtle.radius)
            ahead = turtle.place if frame[:3, 3].tolist() == pytest.approx(list(turtle.place), abs=1e-8) else None
            back = np.array(turtle.place) - size[2] * np.array(turtle.heading)
            assert ahead is not None or np.allclose(frame[:3, 3], back, atol=1e-8)


@pytest.mark.parametrize(
    ("text", "heading"),
    [("&(90)", (1, 0, 0)), ("^(90)", (-1, 0, 0)), ("+(90)", (0, 1, 0)), ("-(90)", (0, -1, 0)), ("|", (0, 0, -1)),
     ("/(90) +(90)", (-1, 0, 0)), ("\\(90) +(90)", (1, 0, 0)), ("+(30) &(70) $ ^(90) +(90)", (-1, 0, 0))],
)  # fmt: skip
def test_turns_are_those_of_the_paper(text: str, heading: tuple[float, float, float]) -> None:
    tip = drawn(f"{text} f(2)").tips[-1]
    if "$" in text:  # with a level left, a pitch keeps what is left and right
        assert drawn(f"{text[: text.index('$') + 1]} +(90) f(2)").tips[-1][2] == pytest.approx(0.0, abs=1e-12)
    else:
        np.testing.assert_allclose(tip, 2.0 * np.array(heading, dtype=float), atol=1e-12)


def test_a_heading_pitched_down_has_its_up_upwards() -> None:
    np.testing.assert_allclose(drawn("&(90) ^(90) f").tips[-1], (0.0, 0.0, 1.0), atol=1e-12)
    np.testing.assert_allclose(drawn("&(90) f ^(90) f").tips[-1], (1.0, 0.0, 1.0), atol=1e-12)


def test_radians_are_for_turns_with_a_parameter() -> None:
    text = "angles radians\naxiom +(pi/2) f(1) + f(1)"
    turned = (0.0, 1.0 + math.cos(math.radians(30.0)), -0.5)
    np.testing.assert_allclose(drawn(text, angle=30.0).tips[-1], turned, atol=1e-12)


def test_frames_stay_orthonormal_for_long() -> None:
    word = drawn("axiom A(50000)\nA(n) @ 0 : n > 0 -> +(17.3) ^(29.1) A(n - 1)\nA(n) @ 0 -> sphere(1)")
    rotation = word.frames[0, :3, :3]
    np.testing.assert_allclose(rotation.T @ rotation, np.eye(3), atol=1e-14)
    assert np.linalg.det(rotation) == pytest.approx(1.0, abs=1e-14)


def test_solids_are_closed_and_as_large_as_they_should_be() -> None:
    prism = 8.0 * math.sin(math.pi / 8.0)  # the area of a polygon of 16 sides within a circle of radius 1
    assert volume(drawn("!(2) F(3)")) == pytest.approx(prism * 4.0 * 3.0, rel=1e-12)
    assert volume(drawn("!(2) F(-3)")) == pytest.approx(prism * 4.0 * 3.0, rel=1e-12)
    assert volume(drawn("sphere(2)", sides=200)) == pytest.approx(4.0 / 3.0 * math.pi * 8.0, rel=1e-3)
    plate = 32.0 * math.sin(math.pi / 32.0)
    assert volume(drawn("!(0.5) disc(3)")) == pytest.approx(plate * 9.0, rel=1e-12)
    assert volume(drawn("!(0.5) disc(1, 3)")) == pytest.approx(plate * 8.0, rel=1e-12)
    assert drawn("!(0.5) disc(3, 1)").frames.tolist() == drawn("!(0.5) disc(1, 3)").frames.tolist()


def test_a_disc_lies_in_the_plane_of_heading_and_left() -> None:
    corners = drawn("f(5) !(0.5) disc(1, 3)").corners(0)
    np.testing.assert_allclose(np.ptp(corners, axis=0), (1.0, 6.0, 6.0), atol=1e-12)
    np.testing.assert_allclose(corners.mean(axis=0), (0.0, 0.0, 5.0), atol=1e-12)


def test_what_has_no_size_is_not_drawn() -> None:
    text = "F(0) sphere(0) disc(0) disc(2, 2) ~(1) cC(0) !(0) F(1) cC(1) disc(1) { f } } { f f } { f [ { f +(90) f ] }"
    assert names(drawn(text)) == []


def test_equal_shapes_are_one() -> None:
    drawing = drawn("F(1) F(2) !(3) F(1) sphere(1) sphere(2) disc(1) disc(2) disc(1, 2) [ cC(1) ] +(80) [ cC(1) ]")
    assert [shape.name for shape in drawing.shapes] == ["cylinder", "sphere", "disc", "disc", "carrier"]


def test_polygons_have_the_places_as_corners() -> None:
    drawing = drawn("f(1) { f(1) +(90) F(1) [ +(90) f(1) ] f(0) }")
    assert names(drawing) == ["polygon"]
    expected = [(0, 0, 1), (0, 0, 2), (0, 1, 2), (0, 1, 1)]
    np.testing.assert_allclose(drawing.corners(0)[:4], expected, atol=1e-12)
    assert len(drawing.shapes[0].triangles) == len(drawing.corners(0)) - 2
    assert not drawing.shapes[0].closed
    nested = drawn("{ f { +(90) f ^(90) f } +(90) f }")
    assert sorted(len(nested.corners(part)) for part in range(2)) == [3, 3]


def test_a_polygon_that_is_dented_is_cut_within() -> None:
    drawing = drawn("{ f(4) +(90) f(4) +(90) f(1) +(90) f(3) -(90) f(2) -(90) f(3) +(90) f(1) }")
    mesh = to_trimesh(drawing.surface())
    assert mesh.area == pytest.approx(10.0, rel=1e-12)


def test_colours_are_part_of_the_state() -> None:
    drawing = drawn("[ colour(2, 0.5, -1) F ] F ' F ' F '(0) F '(9) F '(1) F")
    shades = drawing.colours.tolist()
    assert shades[0] == [1.0, 0.5, 0.0]
    assert shades[2] == shades[4] != shades[1]
    assert shades[3] == shades[5] == shades[6]


def test_tips_know_who_moved_there() -> None:
    word = word_of("[ F +(90) ] F [ + ] [ ^ f ]")
    drawing = draw(word)
    assert isinstance(drawing, Drawing)
    assert drawing.tip_lineages.tolist() == [int(word.lineages[at]) for at in (1, 4, 10, 4)]
    np.testing.assert_allclose(drawing.tips[:2], [(0, 0, 1), (0, 0, 1)], atol=1e-12)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("!", "rules: too few parameters, at ! at time 0"),
        ("disc", "rules: too few parameters, at disc at time 0"),
        ("$(1)", f"rules: {MANY}, at $(1) at time 0"),
        ("F(1, 2)", f"rules: {MANY}, at F(1, 2) at time 0"),
        ("colour(1, 1)", "rules: too few parameters, at colour(1, 1) at time 0"),
        ("f(10^9) f(1)", "diverged: a coordinate, radius or scale of more than 1e9, at f(1) at time 0"),
        ("!(10^10)", "diverged: a coordinate, radius or scale of more than 1e9, at !(1e+10) at time 0"),
        ("sphere(10^10)", "diverged: a coordinate, radius or scale of more than 1e9, at sphere(1e+10) at time 0"),
    ],
)  # fmt: skip
def test_what_cannot_be_drawn_is_told(text: str, told: str) -> None:
    assert refused(text) == told


def test_budgets_are_exact() -> None:
    assert len(drawn("F F F", max_parts=3)) == 3
    assert refused("F F F", max_parts=2) == "budget: more parts at time 0 than the 2 that max_parts allows"
    assert len(drawn("F F", max_vertices=68)) == 2
    assert refused("F F", max_vertices=67) == "budget: more vertices at time 0 than the 67 that max_vertices allows"
    with pytest.raises(ValidationError):
        TurtleSettings(sides=2)


def test_a_carrier_that_is_too_large_is_not_made() -> None:
    text = "axiom A(20000)\nA(n) @ 0 : n > 0 -> cC(1, 0) +(1) A(n - 1)"
    assert refused(text, rings=100, sides=720).startswith("budget: more vertices at time 0 than the 10000000")
    sweep = "cC(1, 0) cC(1)"
    assert len(drawn(sweep, max_vertices=13 * 16 + 2)) == 1
    assert refused(sweep, max_vertices=13 * 16 + 1).startswith("budget: more vertices")


COMMANDED = st.sampled_from([name for name in TURTLE if name not in "[]"])


@settings(max_examples=120)
@given(systems(random=True), st.lists(COMMANDED, min_size=3, max_size=3), st.integers(0, 9))
def test_any_word_is_drawn_or_refused(system: TimedSystem, commands: list[str], seed: int) -> None:
    equivs = tuple(Equiv(command, symbol) for command, symbol in zip(commands, "ABC", strict=True))
    word = derive(replace(system, equivs=equivs), 2.0, seed, TimedGrowth(max_modules=500, max_events=5000))
    if isinstance(word, Failure):
        return
    drawing = draw(word)
    if isinstance(drawing, Failure):
        assert drawing.reason in ("rules", "diverged", "budget")
        return
    surface = drawing.surface()
    assert np.isfinite(surface.vertices).all()
    assert np.isfinite(drawing.tips).all()
    assert len(drawing.tips) == [word.names[code] for code in word.codes.tolist()].count("]") + 1
    for which in np.unique(drawing.which).tolist():
        shape = drawing.shapes[which]
        mesh = trimesh.Trimesh(shape.vertices, shape.triangles, process=False)
        assert mesh.is_watertight == shape.closed
        assert mesh.is_winding_consistent
    assert np.linalg.det(drawing.frames[:, :3, :3]).min(initial=1.0) > -1e-300 or "~" in commands


def test_a_symbol_by_an_equiv_may_have_parameters_of_its_own() -> None:
    drawing = drawn("equiv F limb\naxiom limb(2, 7)")
    np.testing.assert_allclose(drawing.tips, [(0.0, 0.0, 2.0)])


def test_a_surface_has_each_edge_once_in_ascending_order() -> None:
    surface = drawn("F sphere(1) [ +(40) cC(1, 0) ^(30) cC(1) ] { f +(90) f +(90) f }").surface()
    rings = surface.face_vertices.reshape(-1, 3)
    pairs = {(min(a, b), max(a, b)) for ring in rings.tolist() for a, b in zip(ring, (*ring[1:], ring[0]), strict=True)}
    assert surface.edges.tolist() == [list(pair) for pair in sorted(pairs)]
