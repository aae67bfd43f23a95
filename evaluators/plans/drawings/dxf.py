"""A drawing as DXF by ezdxf: in metres, with a layer each for walls, doors, windows, rooms, dimensions and the site."""

from __future__ import annotations

import io
import math
from typing import TYPE_CHECKING, Any, Final

from evaluators.plans.drawings.draw import plain
from evaluators.plans.drawings.drawing import Drawing, Opening
from evaluators.plans.drawings.poche import poche

if TYPE_CHECKING:
    from ezdxf.document import Drawing as Document
    from ezdxf.layouts.layout import Modelspace

LAYERS: Final = {
    "WALLS": (7, 35),
    "DOORS": (30, 25),
    "WINDOWS": (5, 18),
    "ROOMS": (8, 18),
    "DIMENSIONS": (1, 13),
    "SITE": (94, 25),
}
"""Colours (AutoCAD's index) and widths of lines (hundredths of a millimetre)."""
STYLE: Final = "PLAN"
LETTERS: Final = 0.2
"""Height of a dimension's figures in metres."""


def plan_dxf(drawing: Drawing) -> bytes:
    """Write a plan; the same drawing gives the same bytes.

    ROOMS has a closed polyline for each room along the axes of its walls, and its name and area inside; WALLS the walls
    cut by the openings, closed and hatched; DOORS leaf and swing of each door; DIMENSIONS dimension lines.
    """
    from ezdxf._options import options

    # What ezdxf else writes of the moment: times and random identities.
    before = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True
    try:
        document = _document()
        space = document.modelspace()
        _rooms(space, drawing)
        _walls(space, drawing)
        for opening in drawing.openings:
            (_door if opening.kind == "door" else _window)(space, drawing, opening)
        _dimensions(space, drawing)
        _site(space, drawing)
        text = io.StringIO()
        document.write(text)
    finally:
        options.write_fixed_meta_data_for_testing = before
    return text.getvalue().encode(document.output_encoding)


def _document() -> Document:
    from ezdxf import units
    from ezdxf.filemanagement import new

    document = new("R2010", units=units.M)
    document.header["$MEASUREMENT"] = 1
    document.header["$LUNITS"] = 2
    for name, (colour, width) in LAYERS.items():
        document.layers.add(name, color=colour, lineweight=width)
    document.styles.add(STYLE, font="arial.ttf")
    dims: Any = document.dimstyles.duplicate_entry("STANDARD", STYLE)
    dims.set_dxf_attrib("dimtxsty", STYLE)
    for key, value in (("dimtxt", LETTERS), ("dimtsz", 0.08), ("dimexe", 0.12), ("dimexo", 0.3), ("dimgap", 0.06),
                       ("dimdec", 2), ("dimtad", 1), ("dimdle", 0.1), ("dimtih", 0), ("dimtoh", 0), ("dimzin", 0),
                       ("dimlunit", 2), ("dimdsep", ord("."))):  # fmt: skip
        dims.set_dxf_attrib(key, value)
    return document


def _rooms(space: Modelspace, drawing: Drawing) -> None:
    for room in drawing.rooms:
        space.add_lwpolyline(room.outline, close=True, dxfattribs={"layer": "ROOMS"})
        size = 0.9 * room.label.size
        x, y = room.label.at
        for text, down in ((plain(room.name), -0.6 * size), (f"{room.area:.1f} m²", 0.9 * size)):
            words = space.add_text(text, height=size, rotation=90 if room.label.upright else 0,
                                   dxfattribs={"layer": "ROOMS", "style": STYLE})  # fmt: skip
            at = (x + down, y) if room.label.upright else (x, y - down)
            words.set_placement(at, align=_middle())


def _middle() -> Any:  # noqa: ANN401 - ezdxf's
    from ezdxf.enums import TextEntityAlignment

    return TextEntityAlignment.MIDDLE_CENTER


def _walls(space: Modelspace, drawing: Drawing) -> None:
    hatch = space.add_hatch(color=9, dxfattribs={"layer": "WALLS"})
    for ring in poche(drawing, ("door", "window")):
        space.add_lwpolyline(ring, close=True, dxfattribs={"layer": "WALLS"})
        hatch.paths.add_polyline_path(ring, is_closed=True)


def _door(space: Modelspace, drawing: Drawing, door: Opening) -> None:
    leaf = drawing.leaf(door)
    space.add_line(leaf.hinge, leaf.tip, dxfattribs={"layer": "DOORS"})
    turns = [_turn(leaf.hinge, point) for point in (leaf.jamb, leaf.tip)]
    if (turns[1] - turns[0]) % 360.0 > 180.0:
        turns.reverse()
    space.add_arc(leaf.hinge, door.width, turns[0], turns[1], dxfattribs={"layer": "DOORS"})


def _turn(middle: tuple[float, float], point: tuple[float, float]) -> float:
    return math.degrees(math.atan2(point[1] - middle[1], point[0] - middle[0]))


def _window(space: Modelspace, drawing: Drawing, window: Opening) -> None:
    wall = drawing.walls[window.wall]
    half, end = wall.thickness / 2, window.start + window.width
    corners = [
        wall.at(far, aside) for far, aside in ((window.start, half), (window.start, -half), (end, -half), (end, half))
    ]
    space.add_lwpolyline(corners, close=True, dxfattribs={"layer": "WINDOWS"})
    space.add_line(wall.at(window.start), wall.at(end), dxfattribs={"layer": "WINDOWS"})


def _dimensions(space: Modelspace, drawing: Drawing) -> None:
    for one in drawing.dimensions:
        angle = 0 if one.side in ("south", "north") else 90
        made = space.add_linear_dim(base=one.first, p1=one.first, p2=one.last, angle=angle, dimstyle=STYLE,
                                    dxfattribs={"layer": "DIMENSIONS"})  # fmt: skip
        made.render()


def _site(space: Modelspace, drawing: Drawing) -> None:
    if drawing.ground.outline is not None:
        space.add_lwpolyline(drawing.ground.outline, close=True, dxfattribs={"layer": "SITE"})
