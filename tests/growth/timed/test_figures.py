"""Cross-sections and surfaces of files, as tables and as forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from genome.errors import InputError
from genome.timed import parse_tl
from growth.protocol import Failure
from growth.timed import begin, compile_system
from growth.timed.figures import CELLS
from growth.timed.turtle import unknown_symbols
from tests.growth.timed.test_turtle import drawn, names, volume

BUD = "section bud(a) = 1 + 0.3*cos(4*a)\n"


def complaint(text: str) -> str:
    """Give why a system is not compiled; growing it fails with the same words."""
    system = parse_tl(text, "x.tl")
    with pytest.raises(InputError) as caught:
        compile_system(system)
    failed = begin(system)
    assert isinstance(failed, Failure)
    assert str(failed) == f"rules: {caught.value}"
    return str(caught.value)


def test_a_section_is_a_polar_radius_from_left_to_up() -> None:
    drawing = drawn(f"{BUD}axiom bud !(2) cC(3)", corners=120)
    corners = drawing.corners(0)[:120]
    angles = np.arctan2(-corners[:, 0], corners[:, 1])  # up is -x, left is y
    np.testing.assert_allclose(np.hypot(corners[:, 0], corners[:, 1]), 2.0 + 0.6 * np.cos(4.0 * angles), atol=1e-9)
    np.testing.assert_allclose(corners[:, 2], 0.0, atol=1e-12)
    assert volume(drawing) == pytest.approx(3.0 * 4.0 * math.pi * (1.0 + 0.045), rel=2e-3)


@pytest.mark.parametrize(
    ("name", "area"),
    [("circle", 8.0 * math.sin(math.pi / 8.0)), ("square", 2.0), ("triangle", 0.75 * math.sqrt(3.0)),
     ("star", 5.0 * 0.5 * math.sin(math.pi / 5.0))],
)  # fmt: skip
def test_shipped_sections_are_prisms_of_their_area(name: str, area: float) -> None:
    assert volume(drawn(f"{name} !(2) cC(3)", corners=120)) == pytest.approx(12.0 * area, rel=1e-9)


def test_an_equiv_chooses_a_section_and_the_circle_comes_back() -> None:
    drawing = drawn(f"equiv bud open\nequiv star mine\n{BUD}axiom [ bud cC(1) ] [ open cC(1) ] [ open circle cC(1) ] "
                    "[ cC(1) ] [ mine cC(1) ] [ star cC(1) ]")  # fmt: skip
    assert drawing.which.tolist() == [0, 0, 1, 1, 2, 2]


def test_a_system_inside_has_sections_of_its_own() -> None:
    text = f"{BUD}#define W 3\naxiom [ bud cC(1) ] [ part ] [ other ]\n" + "".join(
        f"system {name}\n{line}axiom bud !(1) cC(1)\nend\n"
        for name, line in (("part", "#define W 0.5\nsection bud(a) = W\n"), ("other", ""))
    )
    drawing = drawn(text)
    widths = [float(np.hypot(*drawing.corners(part)[:40, :2].T).max()) for part in range(3)]
    assert widths == pytest.approx([0.13, 0.5, 1.3])


def test_surfaces_are_mixed_by_weight_and_forgotten() -> None:
    text = (
        "surface flat(u, v) = u, v, 0\nsurface bent(u, v) = u, v, 4*u*u\naxiom flat(1) bent(3) ~(2) ~ bent ~ flat(-1) ~"
    )
    drawing = drawn(text)
    assert names(drawing) == ["surface", "surface"]
    steps = np.arange(CELLS + 1) / CELLS
    u, v = (part.reshape(-1) for part in np.meshgrid(steps, steps, indexing="ij"))
    for part, (scale, share) in enumerate(((2.0, 0.75), (1.0, 1.0))):
        along_heading, left, up = (scale * one for one in (u, v, share * 4.0 * u * u))
        expected = np.stack([-up, left, along_heading], axis=1)
        np.testing.assert_allclose(drawing.corners(part), expected, atol=1e-12)
    assert not any(shape.closed for shape in drawing.shapes)


def test_weights_under_0_count_as_0() -> None:
    surfaces = "surface flat(u, v) = u, v, 0\nsurface bent(u, v) = u, v, 4*u*u\n"
    drawing = drawn(surfaces + "axiom bent ~ bent(2) flat(-1) ~")
    assert drawing.which.tolist() == [0, 0]


def test_weights_are_part_of_the_state() -> None:
    text = "surface a(u, v) = u, v, 0\nsurface b(u, v) = u, v, 1\naxiom a [ b ~ ~ ] ~"
    drawing = drawn(text)
    heights = [-drawing.corners(part)[:, 0].mean() for part in range(len(drawing))]
    assert heights == pytest.approx([0.5, 0.0])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            "axiom A\nsection b(a) = cos(a)",
            "x.tl:2:9: expected a radius of b over 0 at every angle, got -1 at a = 3.14159; see docs/formats/tl.md",
        ),
        ("axiom A\n  section b(a) = 1/a", "x.tl:2:11: expected values of b, got division by zero, at a = 0"),
        (
            "axiom A\nsurface b(u, v) = u, v, exp(1000*v)",
            "x.tl:2:9: expected values of b, got overflow: a value that is not finite, at u = 0, v = 0.75",
        ),
    ],
)
def test_what_is_no_shape_is_told_with_line_and_column(text: str, said: str) -> None:
    assert complaint(text) == said


def test_symbols_that_the_turtle_passes_over_are_named() -> None:
    text = f"""equiv F limb
equiv wing blade
{BUD}surface leaf(u, v) = u, v, 0
axiom A limb(1) bud leaf square tail part odd blade odd ' $ [ cC(1) ]
A -> A Z
ignore far
system part
axiom limb(1) tail inner B
B -> C
end
"""
    assert unknown_symbols(parse_tl(text)) == ("tail", "odd", "blade", "Z", "inner", "C")
