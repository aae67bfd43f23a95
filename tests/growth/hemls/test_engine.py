"""Growth of surfaces: the counts of semantics.md, the map's invariants, closed forms, budgets."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from maps import violations
from strategies import systems

from growth.hemls import SurfaceGrowth, derive, grow, parse_system
from growth.hemls.map import HalfEdgeMap
from growth.protocol import Failure
from growth.surface import Surface

SYSTEMS = Path(__file__).parents[3] / "experiments" / "systems"
SQUARE = (SYSTEMS / "square.hemls").read_text()
TRIANGLE = (SYSTEMS / "triangle.hemls").read_text()
COUNTS = {
    "square": (SQUARE, [(4, 4, 1), (9, 12, 4), (25, 40, 16), (81, 144, 64), (289, 544, 256)]),
    "square with Sync": (SQUARE + "Sync\n", [(4, 4, 1), (8, 9, 2), (17, 20, 4), (37, 44, 8), (81, 96, 16)]),
    "triangle": (TRIANGLE, [(3, 3, 1), (6, 9, 4), (15, 30, 16), (45, 108, 64), (153, 408, 256)]),
}


def grown(text: str, **how: object) -> Surface:
    surface = grow(parse_system(text), SurfaceGrowth.model_validate(how))
    assert isinstance(surface, Surface), surface
    return surface


@pytest.mark.parametrize("name", COUNTS)
def test_counts_of_the_table(name: str) -> None:
    text, counts = COUNTS[name]
    maps = derive(parse_system(text), SurfaceGrowth(steps=4))
    seen = []
    for m in maps:
        assert isinstance(m, HalfEdgeMap)
        assert violations(m) == []
        seen.append((m.vertices, m.edges, m.faces))
    assert seen == counts


@settings(max_examples=150, deadline=None)
@given(systems(), st.sampled_from((0.7, 1.0, 1.5)))
def test_every_map_is_sound_after_every_step(text: str, scale: float) -> None:
    how = SurfaceGrowth(steps=3, scale=scale, max_elements=3000, max_pairs=20_000)
    for m in derive(parse_system(text), how):
        if isinstance(m, Failure):
            assert m.reason == "budget"
        else:
            assert violations(m) == []


@settings(max_examples=40, deadline=None)
@given(systems())
def test_growth_is_the_same_each_time_and_moves_with_its_place(text: str) -> None:
    how = SurfaceGrowth(steps=3, max_elements=3000, max_pairs=20_000)
    first, again = (grow(parse_system(text), how) for _ in range(2))
    moved = grow(parse_system(text), how.model_copy(update={"place": (8.0, -4.0, 2.0)}))
    if isinstance(first, Failure):
        assert first == again
        return
    assert isinstance(again, Surface)
    assert isinstance(moved, Surface)
    for name in ("vertices", "edges", "labels", "face_starts", "face_vertices"):
        np.testing.assert_array_equal(getattr(first, name), getattr(again, name))
    assert moved.counts == first.counts
    np.testing.assert_allclose(moved.vertices - [8, -4, 2], first.vertices, atol=1e-9)


@pytest.mark.parametrize(("scale", "steps"), [*itertools.product((0.5, 1.0, 1.5, 2.0), (0, 1, 3))])
def test_the_square_has_the_closed_form_size_and_stays_flat(scale: float, steps: int) -> None:
    vertices = grown(SQUARE, scale=scale, steps=steps).vertices
    assert np.ptp(vertices, axis=0)[:2].sum() == pytest.approx(2 * scale**steps, rel=1e-12)
    assert np.all(vertices[:, 2] == 0)


def test_the_square_is_a_grid_of_squares() -> None:
    surface = grown(SQUARE, steps=3, scale=1.0)
    sides = np.linalg.norm(np.diff(surface.vertices[surface.edges], axis=1)[:, 0], axis=1)
    np.testing.assert_allclose(sides, 1 / 8, rtol=1e-12)
    assert set(np.diff(surface.face_starts).tolist()) == {4}


@pytest.mark.parametrize("sides", [3, 4, 5, 8])
def test_the_seed_is_regular_with_its_first_side_along_x(sides: int) -> None:
    text = " + ".join(["A"] * sides) + "\nA -> A\nAngle 30\nBranchAngle 30"
    surface = grown(text, steps=0, start_length=2.0, place=(1.0, 2.0, 3.0))
    first = surface.vertices[1] - surface.vertices[0]
    np.testing.assert_allclose(first, [2, 0, 0], atol=1e-12)
    np.testing.assert_allclose(surface.vertices.mean(axis=0), [1, 2, 3], atol=1e-12)
    lengths = np.linalg.norm(surface.vertices - np.roll(surface.vertices, 1, axis=0), axis=1)
    np.testing.assert_allclose(lengths, 2)
    a, b, c = surface.vertices[surface.face(0)[:3]]
    assert np.cross(b - a, c - b)[2] > 0


def test_a_plus_turns_to_the_inside_of_the_seed() -> None:
    text = "A + A + A + A\nA -> A [ + B ] A\nAngle 90\nBranchAngle 90\n"
    assert grown(text, steps=1).counts == (8, 9, 2)
    assert grown(text.replace("+ B", "- B"), steps=1).counts == (8, 8, 1)


def test_a_tilde_in_the_axiom_turns_the_edge_round() -> None:
    text = "A + A + A + A\nA -> A [ + B ] A\nAngle 90\nBranchAngle 90\n"
    assert grown(text.replace("A + A + A + A", "A + A + ~A + A"), steps=1).counts == (8, 9, 2)
    # Three sides reversed: their branches point outward, one branch alone finds no partner.
    assert grown(text.replace("A + A + A + A", "~A + A + ~A + ~A"), steps=1).counts == (8, 8, 1)


def test_an_angle_equal_to_branch_angle_does_not_join() -> None:
    # The branches of two neighbouring sides of a square meet at 45 degrees to the line between them.
    text = "A + A + B + B\nA -> A [ + C ] A\nAngle 90\nBranchAngle {}\n"
    assert grown(text.format(45), steps=1).counts == (6, 6, 1)
    assert grown(text.format(45.001), steps=1).counts == (6, 7, 2)


def test_the_distance_limit_counts() -> None:
    text = "A + B + A + B\nA -> A [ + C ] A\nAngle 90\nBranchAngle 30\n"
    assert grown(text, steps=1, scale=1.0, branch_distance=1.001).counts[2] == 2
    assert grown(text, steps=1, scale=1.0, branch_distance=0.999).counts[2] == 1


def test_the_best_pair_joins_first() -> None:
    # A pentagon's branches all see each other; only one pair can cross the region without splitting the others.
    text = "A + A + A + A + A\nA -> A [ + B ] A\nAngle 90\nBranchAngle 90\n"
    surface = grown(text, steps=1)
    assert surface.counts == (10, 12, 3)


def test_context_decides_and_the_richer_context_wins() -> None:
    text = "A + B + C + D\nA -> A A\nD < A -> A A A\nD < A > B -> A A A A\nAngle 90\nBranchAngle 90\n"
    assert grown(text, steps=1).counts[0] == 3 + 4
    assert grown(text.replace("D < A > B", "C < A > B"), steps=1).counts[0] == 3 + 3
    assert grown(text.replace("D < A", "B < A"), steps=1).counts[0] == 3 + 2
    # Directions are not looked at, but start and end are: reversed, A starts at B's vertex.
    assert grown(text.replace("A + B + C + D", "~A + B + C + D"), steps=1).counts[0] == 3 + 2


def test_without_sync_a_later_group_sees_joined_edges_but_no_rewritten_ones() -> None:
    text = "A + B + A + B\nA -> A [ + C ] A\nC -> C C\nAngle 90\nBranchAngle 90\n"
    assert grown(text, steps=1).counts == (4 + 2 + 1, 4 + 2 + 2, 2)
    assert grown(text + "Sync\n", steps=1).counts == (4 + 2, 4 + 2 + 1, 2)
    # The first group makes edges of the second one's label by rewriting: those wait for the next step.
    chain = "A + B + A + B\nA -> B B\nB -> B B\nAngle 90\nBranchAngle 90\n"
    assert grown(chain, steps=1).counts[0] == 8


def test_a_chain_stays_if_it_joins_and_goes_whole_if_not() -> None:
    text = "A + B + A + B\nA -> {} \nAngle 90\nBranchAngle 90\n"
    # Drawn half a side long, the two chained edges reach the opposite side, and the branches look past each other.
    assert grown(text.format("A [ + C C C ] A"), steps=1, scale=1.0).counts == (6, 6, 1)
    # Drawn a sixth of a side long, the chains end well before each other.
    short = text.format("A A A [ + C C ] A A A")
    surface = grown(short, steps=1, scale=1.0)
    assert surface.counts == (4 + 10 + 2, 4 + 10 + 2 + 1, 2)


@pytest.mark.parametrize(
    ("how", "reason"),
    [
        ({"steps": 12}, "budget"),
        ({"steps": 6, "max_pairs": 3}, "budget"),
        ({"steps": 60, "scale": 100.0, "max_elements": 20_000_000}, "budget"),
    ],
)
def test_growth_past_the_budget_is_a_result_that_says_so(how: dict[str, float], reason: str) -> None:
    if how["steps"] == 60:
        text, reason = "A + A + A\nA -> A\nAngle 30\nBranchAngle 30", "diverged"
    else:
        text = SQUARE
    failure = grow(parse_system(text), SurfaceGrowth.model_validate(how))
    assert isinstance(failure, Failure)
    assert failure.reason == reason
    assert failure.detail.startswith("step ")


def test_the_seed_counts_and_may_not_lie_beyond_all_bounds() -> None:
    text = " + ".join(["A"] * 20) + "\nA -> A\nAngle 30\nBranchAngle 30"
    failure = grow(parse_system(text), SurfaceGrowth(steps=0, max_elements=19))
    assert failure == Failure("budget", "20 edges where max_elements allows 19")
    failure = grow(parse_system(text), SurfaceGrowth(steps=0, place=(0.0, 0.0, 2e9)))
    assert failure == Failure("diverged", "a vertex lies farther out than 1e+09")


def test_a_fan_of_thousands_is_over_the_budget_before_it_is_drawn() -> None:
    fan = "[ + B B ] " * 2000
    text = f"A + A + A\nA -> A {fan} A\nAngle 30\nBranchAngle 30"
    failure = grow(parse_system(text), SurfaceGrowth(steps=1))
    assert isinstance(failure, Failure)
    assert failure.detail.startswith("step 1: 24024000 looks round the vertices of chains")


def test_the_clock_is_a_net_behind_the_budget() -> None:
    ticks = itertools.count()
    failure = grow(parse_system(SQUARE), SurfaceGrowth(max_seconds=1.5), clock=lambda: float(next(ticks)))
    assert failure == Failure("clock", "step 1: the growth took longer than max_seconds")


def test_the_2004_example_grows() -> None:
    text = """Edge0 + Edge1 + Edge2 + Edge3
    Edge0 → Edge3 [ [ + Edge0 ] - - Edge0 ] Edge1
    Edge1 → Edge1
    Edge2 → Edge1 [ [ + Edge0 ] - - Edge0 ] Edge3
    Edge3 → Edge2
    Angle 45
    Sync
    BranchAngle 45"""
    for m in derive(parse_system(text), SurfaceGrowth(steps=5)):
        assert isinstance(m, HalfEdgeMap)
        assert violations(m) == []
