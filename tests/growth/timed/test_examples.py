"""The paper's three examples as forms: they hold together, and do what they should."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from growth.timed import Derivation, begin
from growth.timed.drawing import Drawing
from growth.timed.turtle import draw, unknown_symbols
from tests.growth.timed.test_systems import shipped

Floats = NDArray[np.float64]


def drawings(name: str, times: list[float]) -> list[Drawing]:
    """Draw a shipped system at times that ascend."""
    reached = begin(shipped(name))
    found = []
    for time in times:
        assert isinstance(reached, Derivation)
        reached = reached.at(time)
        assert isinstance(reached, Derivation)
        drawing = draw(reached.word())  # type: ignore[arg-type]
        assert isinstance(drawing, Drawing), drawing
        found.append(drawing)
    return found


def ends(drawing: Drawing, part: int) -> tuple[Floats, Floats]:
    """Give the middles of a carrier's two ends."""
    corners = drawing.corners(part)
    return corners[-2], corners[-1]


@pytest.mark.parametrize("name", ["bush", "filament", "flower", "gait", "piston", "engine"])
def test_shipped_systems_are_drawn_whole(name: str) -> None:
    drawing = drawings(name, [5.0])[0]
    assert len(drawing) > 0
    assert unknown_symbols(shipped(name)) == ()
    if name in ("gait", "piston", "engine", "bush"):
        assert all(shape.closed for shape in drawing.shapes)


def branched(origin: complex, length: float, heading: complex, left: int) -> list[complex]:
    """Give where the segments of a bush of so many rewritings begin, in the plane of heading and left."""
    if not left:
        return [origin]
    third, places = length / 3.0, []
    for step, angle in ((0.0, 0.0), (1.0, 25.7), (1.0, 0.0), (2.0, -25.7), (2.0, 0.0)):
        turned = heading * np.exp(1j * np.radians(angle))
        places += branched(origin + step * third * heading, third, turned, left - 1)
    return places


def test_the_bush_stands_where_its_rule_says() -> None:
    drawing = drawings("bush", [5.0])[0]
    places = drawing.frames[:, :3, 3]
    np.testing.assert_allclose(places[:, 0], 0.0, atol=1e-12)
    np.testing.assert_allclose(places[:, 2] + 1j * places[:, 1], branched(0j, 3.0**5, 1.0 + 0j, 5), atol=1e-9)
    np.testing.assert_allclose(drawing.tips[-1], (0.0, 0.0, 243.0), atol=1e-9)
    assert len(drawing.tips) == 1 + 2 * (5**5 - 1) // 4


def test_the_arm_of_the_piston_ends_on_the_rim_of_its_wheel() -> None:
    for drawing in drawings("piston", np.linspace(0.04, 9.0, 60).tolist()):
        piston, arm, wheel = range(3)
        assert [drawing.shapes[which].name for which in drawing.which] == ["carrier", "carrier", "disc"]
        (low, high), (foot, head) = ends(drawing, piston), ends(drawing, arm)
        centre = drawing.frames[wheel][:3, 3]
        np.testing.assert_allclose(foot, high, atol=1e-9)
        np.testing.assert_allclose([low[:2], high[:2]], 0.0, atol=1e-9)  # it goes up and down
        np.testing.assert_allclose(centre[:2], 0.0, atol=1e-9)
        assert 303.6 < centre[2] < 310.001  # as printed the axle bobs: docs/papers/timed.md
        assert np.linalg.norm(head - centre) == pytest.approx(50.0, abs=1e-9)
        assert head[0] == pytest.approx(0.0, abs=1e-9)
        assert np.linalg.norm(drawing.frames[wheel][:3, 0]) == pytest.approx(50.0)


def test_the_axle_of_the_engine_stands_still_and_its_joints_hold() -> None:
    for drawing in drawings("engine", np.linspace(0.04, 9.0, 60).tolist()):
        assert [drawing.shapes[which].name for which in drawing.which].count("disc") == 3
        red, steel = (np.flatnonzero((np.abs(drawing.colours - shade) < 1e-9).all(axis=1))
                      for shade in ((0.82, 0.24, 0.16), (0.62, 0.65, 0.68)))  # fmt: skip
        (low, high), (foot, head) = ends(drawing, int(steel[0])), ends(drawing, int(red[1]))
        np.testing.assert_allclose([low[:2], high[:2]], 0.0, atol=1e-9)
        np.testing.assert_allclose(foot, high, atol=1e-9)
        assert np.linalg.norm(head - (0.0, 0.0, 310.0)) == pytest.approx(50.0, abs=1e-9)
        hubs = [drawing.frames[part][:3, 3] for part in range(len(drawing))
                if drawing.shapes[drawing.which[part]].name == "disc"]  # fmt: skip
        assert sum(np.allclose(hub, (-17.0, 0.0, 310.0), atol=1e-9) for hub in hubs) == 2


def test_the_wheel_turns_once_in_a_period_and_never_back() -> None:
    times = np.linspace(0.05, 4.0, 80)
    angles = []
    for drawing in drawings("piston", times.tolist()):
        x, y = drawing.frames[2][1:3, 0]
        angles.append(np.arctan2(x, y))
    steps = np.diff(np.unwrap(angles))
    np.testing.assert_allclose(steps, steps[0], atol=1e-9)
    assert abs(steps[0]) == pytest.approx(2.0 * np.pi / 4.0 * (times[1] - times[0]))


def feet(drawing: Drawing) -> Floats:
    """Give the tips of the ten legs, (10, 3)."""
    shins = [part for part in range(len(drawing)) if np.allclose(drawing.colours[part], (0.42, 0.2, 0.12))]
    assert len(shins) == 10
    return np.array([ends(drawing, part)[1] for part in shins])


def test_feet_that_stand_are_on_the_ground_and_go_back_and_those_that_go_forwards_are_lifted() -> None:
    times = np.linspace(2.0, 4.0, 41)
    places = np.array([feet(drawing) for drawing in drawings("gait", times.tolist())])
    speed, height = np.gradient(places[..., 0], times, axis=0), places[..., 2]
    low = height < 0.02
    assert height.min() > -0.05
    assert 0.3 < low.mean() < 0.7
    assert speed[low].mean() > 1.0
    assert speed[~low].mean() < -1.0
    assert (speed[low] > -0.3).mean() > 0.9
    assert (height.max(axis=0) > 0.15).all()
    assert low.sum(axis=1).min() >= 3  # never less than three on the ground


def test_the_parts_of_a_leg_are_rigid_and_shared() -> None:
    first, second = drawings("gait", [0.3, 1.1])
    assert [shape.vertices.tobytes() for shape in first.shapes] == [shape.vertices.tobytes() for shape in second.shapes]
    assert first.which.tolist() == second.which.tolist()
    assert len(first.shapes) == 5  # sphere, trunk, feeler, thigh, shin


def test_petals_open_between_three_surfaces_and_keep_their_lineages() -> None:
    early, late = drawings("flower", [14.0, 24.0])
    petals = [[part for part in range(len(one)) if one.colours[part][0] > 0.74 and
               one.shapes[one.which[part]].name == "surface"] for one in (early, late)]  # fmt: skip
    assert [len(one) for one in petals] == [16, 16]
    assert early.lineages[petals[0]].tolist() == late.lineages[petals[1]].tolist()
    upright = [np.mean([one.frames[part][2, 0] / np.linalg.norm(one.frames[part][:3, 0]) for part in parts])
               for one, parts in zip((early, late), petals, strict=True)]  # fmt: skip
    assert upright[0] > 0.7
    assert upright[1] < 0.5
