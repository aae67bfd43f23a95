"""Marks as PNG, drawn by Pillow with the font that it brings."""

from __future__ import annotations

import io
import itertools
import re
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Final

from evaluators.plans.drawings.drawing import Drawing, Point, ring_area
from evaluators.plans.drawings.marks import Fill, Paper, Stroke, Words, page

if TYPE_CHECKING:
    from PIL.Image import Image

DOTS: Final = 8.0
"""Of a millimetre."""
LARGEST: Final = 2400
"""Of a side, in dots."""
SAMPLES: Final = 2
"""The picture is drawn this many times larger in both directions, then made smaller."""


def plan_png(drawing: Drawing) -> bytes:
    """Draw a plan on a page of its own."""
    return paper_png(page(drawing))


def paper_png(paper: Paper) -> bytes:
    """Draw a page; the same page gives the same bytes."""
    stream = io.BytesIO()
    picture(paper).save(stream, format="PNG")
    return stream.getvalue()


def picture(paper: Paper) -> Image:
    """Draw a page."""
    from PIL import Image, ImageDraw

    dots = min(DOTS, LARGEST / max(paper.width, paper.height))
    scale = dots * SAMPLES
    size = (round(paper.width * dots), round(paper.height * dots))
    image = Image.new("RGB", (size[0] * SAMPLES, size[1] * SAMPLES), "#ffffff")
    pen = ImageDraw.Draw(image)
    for mark in paper.marks:
        if isinstance(mark, Fill):
            _fill(image, mark, scale)
        elif isinstance(mark, Stroke):
            _stroke(pen, mark, scale)
        else:
            _words(image, mark, scale)
    return image.reduce(SAMPLES)


def _scaled(points: tuple[Point, ...], scale: float) -> list[Point]:
    return [(x * scale, y * scale) for x, y in points]


def _fill(image: Image, mark: Fill, scale: float) -> None:
    """Fill polygons, the large ones first; those that turn the other way than the largest are holes."""
    from PIL import Image as Images
    from PIL import ImageDraw

    if len(mark.rings) == 1:
        ImageDraw.Draw(image).polygon(_scaled(mark.rings[0], scale), fill=mark.colour)
        return
    covered = Images.new("1", image.size)
    rings = sorted(mark.rings, key=lambda ring: -abs(ring_area(ring)))
    for ring in rings:
        solid = (ring_area(ring) > 0) == (ring_area(rings[0]) > 0)
        ImageDraw.Draw(covered).polygon(_scaled(ring, scale), fill=int(solid))
    image.paste(mark.colour, (0, 0), covered)


def _stroke(pen: Any, mark: Stroke, scale: float) -> None:  # noqa: ANN401 - Pillow's
    points = _scaled(mark.points, scale)
    width = max(round(mark.width * scale), 1)
    if mark.closed:
        points.append(points[0])
    for line in _dashed(points, [one * scale for one in mark.dashes]) if mark.dashes else [points]:
        pen.line(line, fill=mark.colour, width=width, joint="curve")


def _dashed(points: list[Point], dashes: list[float]) -> list[list[Point]]:
    """Cut a line into dashes; each side begins with a whole one."""
    found = []
    for (ax, ay), (bx, by) in itertools.pairwise(points):
        length = ((bx - ax) ** 2 + (by - ay) ** 2) ** 0.5
        at, which = 0.0, 0
        while at < length:
            to = min(at + dashes[which % len(dashes)], length)
            if which % 2 == 0:
                found.append([(ax + (bx - ax) * far / length, ay + (by - ay) * far / length) for far in (at, to)])
            at, which = to, which + 1
    return found


def _words(image: Image, mark: Words, scale: float) -> None:
    """Write a line; the font has no raised 2, so that it is written small."""
    from PIL import Image as Images
    from PIL import ImageDraw

    size = mark.size * scale * 1.08
    heavy = max(round(mark.size * scale / 40), 1) if mark.bold else 0
    parts: list[tuple[str, Any, float, float]] = []
    right = 0.0
    for place, text in enumerate(re.split("(\u00b2)", mark.text)):
        font = _font(max(round(0.6 * size if place % 2 else size), 6))
        parts.append(("2" if place % 2 else text, font, right, 0.34 * size if place % 2 else 0.0))
        right += font.getlength(parts[-1][0])
    edge, rise = 2 * heavy + 2, round(1.2 * size)
    mask = Images.new("L", (round(right) + 2 * edge, rise + round(0.5 * size)))
    pen = ImageDraw.Draw(mask)
    for text, font, along, up in parts:
        pen.text((edge + along, rise - up), text, 255, font, "ls", stroke_width=heavy)
    # Where the base line's anchor is in the mask, from its left and its top.
    x, y = edge + (right / 2 if mark.anchor == "middle" else 0.0), float(rise)
    if mark.turn == 90:
        x, y = y, mask.width - x
        mask = mask.transpose(Images.Transpose.ROTATE_90)
    image.paste(mark.colour, (round(mark.at[0] * scale - x), round(mark.at[1] * scale - y)), mask)


@lru_cache(maxsize=64)
def _font(size: int) -> Any:  # noqa: ANN401 - Pillow's
    from PIL import ImageFont

    return ImageFont.load_default(size)
