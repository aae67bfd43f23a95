"""Criteria of form: closed forms, trimesh as a peer, and what moves or mirrors a form."""

import math
from pathlib import Path

import numpy as np
import pytest
import trimesh
from animals import BASE, BODY, CYLINDER, GIRTH, RINGED, SIDES, SPHERE, SQUARE, drawing, placed, sequence, still
from hypothesis import given, settings
from hypothesis import strategies as st

from evaluators.timed import TIMED_CRITERIA, TimedForm, Unfolding, unfold
from genome.timed import parse_tl
from growth.timed import derive
from growth.timed.turtle import draw

SYSTEMS = Path("experiments/systems")


def value(name, *parts):
    return TIMED_CRITERIA[name](still(*parts))


def grown(name, time):
    word = derive(parse_tl((SYSTEMS / f"{name}.tl").read_text(), name), time)
    return draw(word)


def test_a_cylinder_is_as_large_as_it_is():
    upright = (CYLINDER, placed(wide=0.5, high=3))
    found = {name: value(name, upright) for name in ("size", "height", "spread", "surface", "volume", "parts")}
    assert found == pytest.approx({"size": 3, "height": 3, "spread": 1 / 3, "surface": 2 * BASE / 4 + 1.5 * GIRTH,
                                   "volume": 3 * BASE / 4, "parts": 1}, rel=1e-12)  # fmt: skip


def test_extents_are_of_all_parts_wherever_they_stand():
    far = [(CYLINDER, placed(x=5, z=-1)), (SPHERE, placed(y=-2, z=9))]
    assert value("size", *far) == pytest.approx(11)
    assert value("height", *far) == pytest.approx(11)
    assert value("spread", *far) == pytest.approx((7 + 4) / 2 / 11)


def test_what_lies_level_has_a_spread_and_no_height():
    assert value("height", (SQUARE, placed())) == 0
    assert value("spread", (SQUARE, placed())) == 1e6


def test_areas_and_volumes_add_up_hidden_or_not():
    inside = (SPHERE, placed(z=0.5, wide=0.1, high=0.1))
    whole, outer = (CYLINDER, placed()), value("surface", (CYLINDER, placed()))
    assert value("surface", whole, inside) == pytest.approx(outer + value("surface", inside), rel=1e-12)
    assert value("volume", whole, whole) == pytest.approx(2 * BASE, rel=1e-12)


def test_a_polygon_counts_once_and_has_no_volume():
    assert value("surface", (SQUARE, placed(wide=3))) == pytest.approx(9)
    assert value("volume", (SQUARE, placed(wide=3))) == 0


def test_a_mirrored_frame_has_the_same_area_and_volume():
    mirror = np.diag([-1.0, 1, 1, 1]) @ placed(wide=2)
    for name in ("surface", "volume"):
        assert value(name, (RINGED, mirror)) == pytest.approx(value(name, (RINGED, placed(wide=2))), rel=1e-12)


def test_a_flat_frame_keeps_its_area():
    flat = placed()
    flat[2, 2] = 0.0
    assert value("surface", (CYLINDER, flat)) == pytest.approx(2 * BASE)


@pytest.mark.parametrize(("name", "time"), [("flower", 11.0), ("gait", 1.3), ("piston", 1.04)])
def test_trimesh_measures_the_same(name, time):
    form = grown(name, time)
    meshes = [trimesh.Trimesh(form.corners(part), form.shapes[which].triangles, process=False)
              for part, which in enumerate(form.which.tolist())]  # fmt: skip
    closed = [mesh for mesh, which in zip(meshes, form.which.tolist(), strict=True) if form.shapes[which].closed]
    seen = Unfolding(np.array([time]), (form,))
    assert TIMED_CRITERIA["surface"](seen) == pytest.approx(sum(mesh.area for mesh in meshes), rel=1e-9)
    assert TIMED_CRITERIA["volume"](seen) == pytest.approx(sum(abs(mesh.volume) for mesh in closed), rel=1e-9)
    bounds = trimesh.util.concatenate(meshes).extents
    assert TIMED_CRITERIA["size"](seen) == pytest.approx(bounds.max(), rel=1e-12)
    assert TIMED_CRITERIA["height"](seen) == pytest.approx(bounds[2], rel=1e-12)
    assert TIMED_CRITERIA["spread"](seen) == pytest.approx((bounds[0] + bounds[1]) / 2 / bounds[2], rel=1e-12)


def mirror(angle):
    """The reflection in the upright plane through the origin that stands at an angle."""
    c, s = math.cos(2 * angle), math.sin(2 * angle)
    return np.array([[c, s, 0, 0], [s, -c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])


places = st.floats(-3, 3, allow_nan=False)


@settings(max_examples=40)
@given(
    st.floats(0, math.pi),
    st.lists(st.tuples(places, places, places, st.sampled_from([0.3, 0.5])), min_size=1, max_size=6),
    st.tuples(places, places),
)
def test_a_form_and_its_mirror_image_together_are_symmetric(angle, spots, shift):
    half = [placed(x, y, z, wide) for x, y, z, wide in spots]
    moved = placed(*shift)
    both = [(SPHERE, moved @ turn @ frame) for frame in half for turn in (np.eye(4), mirror(angle))]
    # Where the form has more planes nearly, another fold than its own may be the strongest: half a sector then.
    assert value("symmetry", *both) > 0.9
    leaning = [(SPHERE, moved @ frame) for frame in half]
    assert value("symmetry", *leaning) <= 1.0


@pytest.mark.parametrize("fold", [1, 2, 3, 4, 5, 6, 7, 8])
@pytest.mark.parametrize("angle", [0.0, 0.7, 31.0])
def test_a_wreath_is_wholly_symmetric_however_it_is_turned(fold, angle):
    turns = np.radians(angle + 360 * np.arange(fold) / fold)
    wreath = [(SPHERE, placed(2 * math.cos(turn), 2 * math.sin(turn), 0.3, wide=0.2)) for turn in turns]
    assert value("symmetry", *wreath, (CYLINDER, placed(wide=0.1))) > (1 - 1e-9 if angle == 0 else 0.97)


def test_one_part_alone_is_its_own_mirror_image():
    assert value("symmetry", (CYLINDER, placed())) == pytest.approx(1, abs=1e-9)
    assert value("symmetry", (SPHERE, placed(x=9, y=-4))) == pytest.approx(1, abs=1e-9)


def test_four_of_six_that_have_images_overlap_by_a_half():
    # At these angles no plane maps more than four of the six onto one another: 4 / (6 + 2).
    turns = np.radians([30, 330, 150, 210, 60, 240])
    six = [(SPHERE, placed(math.cos(turn), math.sin(turn), wide=1e-3, high=1e-3)) for turn in turns]
    assert value("symmetry", *six) == pytest.approx(0.5, abs=0.02)


def test_a_helix_is_no_mirror_image_and_height_counts():
    helix = [(SPHERE, placed(math.cos(k), math.sin(k), 0.3 * k, wide=0.2)) for k in np.arange(0, 6, 0.5)]
    level = [(SPHERE, placed(math.cos(k), math.sin(k), 0, wide=0.2)) for k in np.arange(0, 6, 0.5)]
    assert value("symmetry", *helix) < 0.5
    assert value("symmetry", *level) > 0.85


def test_the_shipped_animal_stands_symmetrically_when_no_leg_swings():
    text = (SYSTEMS / "gait.tl").read_text()
    for name in ("ASW", "ASU", "AST", "ASK", "RSK"):
        text = text.replace(f"#define {name} ", f"#define {name} 0*")
    standing = unfold(parse_tl(text, "gait"), TimedForm(time=1.0, samples=1))
    walking = unfold(parse_tl((SYSTEMS / "gait.tl").read_text(), "gait"), TimedForm(time=1.0, samples=1))
    assert TIMED_CRITERIA["symmetry"](standing) > 0.95
    assert TIMED_CRITERIA["symmetry"](walking) < 0.8


def test_nothing_is_no_larger_than_nothing():
    empty = Unfolding(np.zeros(1), (drawing(),))
    found = {name: criterion(empty) for name, criterion in TIMED_CRITERIA.items()}
    assert found == {"evenness": 0, "height": 0, "lift": 0, "parts": 0, "size": 0, "smoothness": 1, "spread": 0,
                     "stride": 0, "surface": 0, "symmetry": 1, "volume": 0}  # fmt: skip


def test_the_sides_of_the_measured_shapes_are_what_the_closed_forms_say():
    assert len(CYLINDER.vertices) == 2 * SIDES + 2


@pytest.mark.parametrize("name", ["height", "parts", "size", "spread", "surface", "symmetry", "volume"])
def test_criteria_of_form_judge_the_last_time_alone(name):
    first = drawing(BODY)
    last = drawing(
        (CYLINDER, placed(wide=2.0, high=3.0)),
        (CYLINDER, placed(x=5.0, y=1.0)),
        (CYLINDER, placed(x=1.0, y=7.0, z=4.0, high=2.0)),
        (SPHERE, placed(x=-3.0, y=2.0, z=9.0)),
    )
    criterion = TIMED_CRITERIA[name]
    assert criterion(sequence(first, first, last)) == criterion(sequence(last))
    assert criterion(sequence(last)) != pytest.approx(criterion(sequence(first)), rel=0.01)
