"""Marks as SVG: real text, no outside references, a millimetre a unit."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final
from xml.sax.saxutils import escape, quoteattr

from evaluators.plans.drawings.drawing import Drawing, Point
from evaluators.plans.drawings.marks import Fill, Paper, Stroke, Words, page

FONT: Final = "Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif"


def plan_svg(drawing: Drawing) -> bytes:
    """Write a plan on a page of its own."""
    return paper_svg(page(drawing))


def paper_svg(paper: Paper) -> bytes:
    """Write a page; the same page gives the same bytes."""
    size = f"{paper.width:.2f} {paper.height:.2f}"
    width, height = size.split()
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}mm" height="{height}mm" viewBox="0 0 {size}" '
        f"font-family={quoteattr(FONT)}>"
    )
    lines = ['<?xml version="1.0" encoding="UTF-8"?>', head, f"<title>{escape(paper.title)}</title>"]
    return ("\n".join([*lines, *_elements(paper), "</svg>"]) + "\n").encode()


def _elements(paper: Paper) -> Iterator[str]:
    for mark in paper.marks:
        kind = f"class={quoteattr(mark.kind)}"
        if isinstance(mark, Fill):
            path = " ".join(f"M{' L'.join(map(_point, ring))} Z" for ring in mark.rings)
            name = f"<title>{escape(mark.name)}</title></path>" if mark.name else ""
            yield f'<path {kind} d="{path}" fill="{mark.colour}" fill-rule="evenodd"' + (f">{name}" if name else "/>")
        elif isinstance(mark, Stroke):
            shape = "polygon" if mark.closed else "polyline"
            dashes = f' stroke-dasharray="{" ".join(f"{one:g}" for one in mark.dashes)}"' if mark.dashes else ""
            points = " ".join(map(_point, mark.points))
            yield (
                f'<{shape} {kind} points="{points}" fill="none" stroke="{mark.colour}" '
                f'stroke-width="{mark.width:g}"{dashes}/>'
            )
        else:
            yield _words(mark, kind)


def _words(mark: Words, kind: str) -> str:
    x, y = _point(mark.at).split(",")
    turn = f' transform="rotate({-mark.turn} {x} {y})"' if mark.turn else ""
    weight = ' font-weight="600"' if mark.bold else ""
    return (
        f'<text {kind} x="{x}" y="{y}" font-size="{mark.size:.2f}" text-anchor="{mark.anchor}" '
        f'fill="{mark.colour}"{weight}{turn}>{escape(mark.text)}</text>'
    )


def _point(point: Point) -> str:
    return ",".join(f"{round(one, 3) + 0.0:.10g}" for one in point)
