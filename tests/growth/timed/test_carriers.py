"""Generalised cylinders: closed, of the right volume, along Hermite curves; frames turn as little as can be."""

from __future__ import annotations

import math

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

from growth.timed.drawing import Drawing
from growth.timed.turtle import _carriers
from tests.growth.timed.test_turtle import drawn, names, volume

Floats = NDArray[np.float64]

PRISM = 8.0 * math.sin(math.pi / 8.0)
"""The area of a polygon of 16 sides in a circle of radius 1."""

PIECES = st.lists(
    st.tuples(
        st.sampled_from((0.0, 1.0, 2.5, 0.7)),
        st.sampled_from((0.3, 0.2, 0.1, 0.0)),
        st.sampled_from(("", "circle", "star", "square")),
        st.sampled_from(("", "+(20)", "-(35)", "^(25)", "&(10)", "/(60)", "$", "[ cC(1) ]", "[ F(1) +(40) cC(1, 0) ]")),
    ),
    min_size=1,
    max_size=6,
)


def rings(drawing: Drawing, sides: int, part: int = 0) -> Floats:
    """Give the rings of a carrier, (n, sides, 3), in the world."""
    return drawing.corners(part)[:-2].reshape(-1, sides, 3)


@settings(max_examples=80)
@given(PIECES)
def test_carriers_are_closed(pieces: list[tuple[float, float, str, str]]) -> None:
    text = " ".join(f"!({radius}) {shape} {turn} cC({length}, 0)" for length, radius, shape, turn in pieces)
    drawing = drawn(f"!(0.25) {text}")
    for part, name in enumerate(names(drawing)):
        shape = drawing.shapes[drawing.which[part]]
        assert shape.closed
        if name == "carrier":
            mesh = trimesh.Trimesh(shape.vertices, shape.triangles, process=False)
            assert mesh.is_watertight
            assert mesh.is_winding_consistent
            # A needle that ends in a plate without thickness has no volume but for rounding.
            needle = any(radius == 0.0 for _, radius, _, _ in pieces)
            assert mesh.volume > (-1e-6 if needle else 0.0)


@pytest.mark.parametrize(
    "text",
    ["cC(6, TRUE)", "cC(6)", "cC(2, 0) cC(4)", "cC(6, FALSE)", "[ cC(6, FALSE) ] f(0)", "cC(-6)", "cC(6, 0) f(3)",
     "cC(2, 0) cC(0, 0) cC(4)", "/(50) cC(3, 0) /(70) cC(3)"],
)  # fmt: skip
def test_a_straight_one_is_a_prism(text: str) -> None:
    drawing = drawn(f"!(1.5) +(33) ^(12) {text}")
    assert names(drawing) == ["carrier"]
    assert volume(drawing) == pytest.approx(PRISM * 2.25 * 6.0, rel=1e-9)


def test_a_straight_one_may_taper_to_a_point() -> None:
    assert volume(drawn("!(2) cC(0, 0) !(0) cC(6)")) == pytest.approx(PRISM * 4.0 * 6.0 / 3.0, rel=1e-9)
    assert volume(drawn("!(0) cC(0, 0) !(2) cC(6)")) == pytest.approx(PRISM * 4.0 * 6.0 / 3.0, rel=1e-9)


def test_a_step_of_no_length_is_a_shoulder() -> None:
    drawing = drawn("!(2) cC(3, 0) !(1) cC(0, 0) cC(4)")
    assert volume(drawing) == pytest.approx(PRISM * (4.0 * 3.0 + 4.0), rel=1e-9)


def test_a_bend_is_nearly_a_torus() -> None:
    piece = 2.0 * 5.0 * math.sin(math.radians(5.0))
    text = f"!(1) cC({piece}, 0) " + f"+(10) cC({piece}, 0) " * 17
    drawing = drawn(text, sides=64)
    length = float(np.linalg.norm(np.diff(rings(drawing, 64).mean(axis=1), axis=0), axis=1).sum())
    assert length == pytest.approx(18.0 * piece, rel=5e-3)
    assert volume(drawing) == pytest.approx(math.pi * length, rel=5e-3)


def test_the_carrier_curve_is_cubic_and_hermite() -> None:
    drawing = drawn("cC(2, 0) +(50) cC(3, 0) -(20) cC(1)", rings=8)
    seen = rings(drawing, 16).mean(axis=1)
    angles = np.radians([0.0, 0.0, 50.0, 30.0])
    headings = np.stack([0.0 * angles, np.sin(angles), np.cos(angles)], axis=1)
    lengths = np.array([2.0, 3.0, 1.0])
    places = np.concatenate([np.zeros((1, 3)), np.cumsum(headings[1:] * lengths[:, None], axis=0)])
    steps = np.arange(1, 9) / 8.0
    expected = [places[:1]]
    for k, length in enumerate(lengths):
        curve = CubicHermiteSpline([0.0, 1.0], places[k : k + 2], length * headings[k : k + 2])
        expected.append(curve(steps))
    np.testing.assert_allclose(seen, np.concatenate(expected), atol=1e-12)


def test_radii_change_smoothly_and_never_bulge() -> None:
    drawing = drawn("!(1) cC(1, 0) !(0.5) cC(2, 0) !(0.4) cC(1, 0) !(0.9) cC(1)", rings=10)
    ring = rings(drawing, 16)
    heights = ring[..., 2].mean(axis=1)
    radii = np.linalg.norm(ring[:, 0] - ring.mean(axis=1), axis=1)
    curve = PchipInterpolator([0.0, 1.0, 3.0, 4.0, 5.0], [1.0, 1.0, 0.5, 0.4, 0.9])
    inner = (heights >= 1.0) & (heights <= 4.0)
    np.testing.assert_allclose(radii[inner], curve(heights[inner]), atol=1e-9)
    assert radii.min() == pytest.approx(0.4)
    assert radii.max() == pytest.approx(1.0)


def test_frames_turn_as_little_as_can_be() -> None:
    text = "!(0.1) cC(1, 0) " + "+(9) ^(4) cC(1, 0) &(13) cC(1, 0) -(2) cC(1, 0) " * 6
    drawing = drawn(text, rings=60)
    ring = rings(drawing, 16)
    first = ring[:, 0] - ring.mean(axis=1)
    spokes = first / np.linalg.norm(first, axis=1, keepdims=True)
    normals = np.cross(ring[:, 4] - ring.mean(axis=1), first)
    tangents = -normals / np.linalg.norm(normals, axis=1, keepdims=True)
    about = np.einsum("nj,nj->n", np.cross(spokes[:-1], spokes[1:]), 0.5 * (tangents[:-1] + tangents[1:]))
    turned = np.arccos(np.clip(np.einsum("nj,nj->n", tangents[:-1], tangents[1:]), -1.0, 1.0)).sum()
    assert turned > 1.5  # it bends a good deal,
    assert np.abs(about.sum()) < 1e-3  # and does not roll


def test_rolls_twist_sections_that_are_not_round() -> None:
    straight, rolled = drawn("square !(1) cC(4)"), drawn("square !(1) cC(0, 0) /(30) cC(4)")
    ends = [rings(drawing, 40)[[0, -1], 0, :2] for drawing in (straight, rolled)]
    np.testing.assert_allclose(ends[1][0], ends[0][0], atol=1e-12)
    angle = math.radians(30.0)
    turned = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]]) @ ends[0][1]
    np.testing.assert_allclose(ends[1][1], turned, atol=1e-12)
    round_one, same = drawn("cC(4)"), drawn("cC(0, 0) /(30) cC(4)")
    np.testing.assert_allclose(rings(round_one, 16), rings(same, 16), atol=1e-12)


def test_sections_change_smoothly_from_one_to_the_next() -> None:
    drawing = drawn("!(1) cC(0, 0) square cC(2, 0) cC(1)", rings=10, corners=40)
    ring = rings(drawing, 40)
    flats = np.linalg.norm(ring[:, 0, :2], axis=1)  # from the circle's 1 to the square's shortest radius
    assert flats[0] == pytest.approx(1.0)
    assert (np.diff(flats[:11]) < 0.0).all()
    steps = np.arange(11) / 10.0
    eased = steps * steps * (3.0 - 2.0 * steps)
    np.testing.assert_allclose(flats[:11], 1.0 + eased * (math.sqrt(0.5) - 1.0))


def test_a_run_ends_where_it_is_told_to() -> None:
    assert len(drawn("cC(1, 0) cC(1, 0) cC(1, 0)")) == 1
    assert len(drawn("cC(1) cC(1) cC(1)")) == 3
    assert len(drawn("cC(1, 0) cC(1) cC(1)")) == 2
    assert len(drawn("cC(1, 0) f(1) cC(1, 0) F(1) cC(1)")) == 4
    branched = drawn("cC(1, 0) [ cC(1, 0) +(30) cC(1, 0) ] cC(1, 0) [ +(9) cC(1, 0) ] cC(1)")
    assert [len(branched.corners(part)) for part in range(3)] == [16 * 19 + 2, 16 * 13 + 2, 16 * 7 + 2]


def test_an_equal_run_is_one_shape_wherever_it_stands() -> None:
    limb = "cC(1, 0) +(20) !(0.05) cC(1.3, 0) ^(10) cC(0.7)"
    drawing = drawn(f"[ {limb} ] f(3) /(77) &(31) colour(0, 0, 0) [ {limb} ] +(45) f(0.1) {limb}")
    assert drawing.which.tolist() == [0, 0, 0]


def swept_by_numpy(centres: Floats, headings: Floats) -> Floats:
    """Carry the first left along by the double reflection, as Wang 2008 has it in Table I."""
    lefts = [np.array([1.0, 0.0, 0.0])]
    for n in range(len(centres) - 1):
        v1 = centres[n + 1] - centres[n]
        c1 = v1 @ v1
        left = lefts[n] - (2.0 / c1) * (v1 @ lefts[n]) * v1
        heading = headings[n] - (2.0 / c1) * (v1 @ headings[n]) * v1
        v2 = headings[n + 1] - heading
        c2 = v2 @ v2
        lefts.append(left - (2.0 / c2) * (v2 @ left) * v2 if c2 else left)
    return np.array(lefts)


def test_the_kernel_transports_as_the_plain_one() -> None:
    t = np.linspace(0.0, 9.0, 200)
    centres = np.stack([np.cos(t) - 1.0, np.sin(t), 0.3 * t], axis=1)
    headings = np.stack([-np.sin(t), np.cos(t), np.full_like(t, 0.3)], axis=1) / math.hypot(1.0, 0.3)
    seen = _carriers.transported(centres, headings)
    np.testing.assert_allclose(seen, swept_by_numpy(centres, headings), atol=1e-12)
