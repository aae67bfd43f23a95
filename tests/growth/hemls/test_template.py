"""Successors drawn in the frame of the edge that they replace."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import successors

from growth.hemls.rules import parse_system
from growth.hemls.template import KEEP, Template, _shortest_arc, draw


def template(successor: str, angle: float = 90) -> Template:
    system = parse_system(f"A + B + C\nA -> {successor}\nAngle {angle}\nBranchAngle 90")
    return draw(system.rules[0], system.angle)


def test_branches_of_the_square_point_left_and_right_of_the_middle() -> None:
    drawn = template("A [ [ + B ] - B ] A")
    np.testing.assert_allclose(drawn.nodes, [[0, 0, 0], [0.5, 0, 0], [1, 0, 0]], atol=1e-15)
    assert drawn.branches == ((1, 1), (1, 1))
    np.testing.assert_allclose(drawn.headings, [[0, 1, 0], [0, -1, 0]], atol=1e-15)


def test_a_bend_is_fitted_by_a_similarity_and_its_branches_turn_with_it() -> None:
    # Two equal segments with a left turn of 90 degrees between them: a right triangle over the edge, to its right.
    drawn = template("A + A [ + B ]")
    np.testing.assert_allclose(drawn.nodes, [[0, 0, 0], [0.5, -0.5, 0], [1, 0, 0]], atol=1e-15)
    np.testing.assert_allclose(drawn.headings, [[-math.sqrt(0.5), math.sqrt(0.5), 0]], atol=1e-15)


def test_pitch_lifts_the_path_towards_up_and_roll_tilts_the_turn() -> None:
    assert template("^ A & & A ^", 45).nodes[1] == pytest.approx([0.5, 0, 0.5])
    # Rolled to the left, the left side dips: a turn to the left goes down, and so does its mirror image.
    half = math.sqrt(0.125)
    assert template("/ + A - - A + \\", 45).nodes[1] == pytest.approx([0.5, half, -half])
    assert template("\\ - A + + A - /", 45).nodes[1] == pytest.approx([0.5, -half, -half])
    assert template("/ / + A - - A + \\ \\", 45).nodes[1] == pytest.approx([0.5, 0, -0.5])


def test_a_path_whose_ends_coincide_divides_the_edge_evenly() -> None:
    drawn = template("A + A + A + B [ + C ]")
    np.testing.assert_allclose(drawn.nodes[:5, 0], [0, 0.25, 0.5, 0.75, 1])
    np.testing.assert_allclose(drawn.nodes[:, 1:], 0)
    # The turtle's fourth heading is the first turned thrice; the branch turns once more, to where it began.
    np.testing.assert_allclose(drawn.headings, [[1, 0, 0]], atol=1e-12)


def test_half_a_turn_goes_about_up() -> None:
    drawn = template("+ + A [ + B ] [ ^ C ] A")
    np.testing.assert_allclose(drawn.nodes, [[0, 0, 0], [0.5, 0, 0], [1, 0, 0]], atol=1e-12)
    np.testing.assert_allclose(drawn.headings, [[0, 1, 0], [0, 0, 1]], atol=1e-12)


def test_a_successor_that_draws_only_in_brackets_keeps_the_edge() -> None:
    drawn = template("[ + B ]")
    assert drawn.segments == ((KEEP, False),)
    assert drawn.branches == ((0, 1),)


def test_a_bracket_of_several_segments_makes_edges_of_all_but_the_last() -> None:
    drawn = template("A [ + B ~ C [ - A ] B ] A")
    assert drawn.chains == ((1, 3, 1, False), (3, 4, 2, True))
    assert drawn.branches == ((4, 0), (4, 1))
    np.testing.assert_allclose(drawn.nodes[3:], [[0.5, 0.5, 0], [0.5, 1, 0]], atol=1e-12)


@given(successors(), st.sampled_from((15.0, 30.0, 45.0, 60.0, 90.0)))
def test_every_drawing_runs_from_start_to_end_with_unit_headings(successor: str, angle: float) -> None:
    drawn = template(successor, angle)
    m = len(drawn.segments)
    assert drawn.nodes[0].tolist() == [0, 0, 0]
    assert drawn.nodes[m].tolist() == [1, 0, 0]
    assert len(drawn.nodes) == m + 1 + len(drawn.chains)
    np.testing.assert_allclose(np.linalg.norm(drawn.headings, axis=1), 1)
    # All segments have one length: the similarity keeps them equal.
    lengths = np.linalg.norm(np.diff(drawn.nodes[: m + 1], axis=0), axis=1)
    np.testing.assert_allclose(lengths, lengths[0], atol=1e-9)


@given(st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda v: math.hypot(*v) > 1e-3))
def test_the_shortest_arc_is_a_rotation_in_the_plane_of_both_directions(v: tuple[float, float, float]) -> None:
    d = np.array(v) / math.hypot(*v)
    turn = _shortest_arc(d)
    np.testing.assert_allclose(turn @ d, [1, 0, 0], atol=1e-6)
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-5)
    # Least angle: the trace of a rotation by it is 1 + 2 cos.
    assert np.trace(turn) == pytest.approx(1 + 2 * d[0], abs=1e-5)
