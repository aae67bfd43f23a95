"""Drawings of figures as SVG, by matplotlib: text stays text, and the same numbers give the same bytes."""

from __future__ import annotations

import hashlib
import io
import re
from collections.abc import Callable
from typing import Any, Final

WIDTH: Final = 4.6
HEIGHT: Final = 2.7
"""Inches of a small figure: its text is readable on a phone."""

GRID: Final = "#dddddd"


def drawn(name: str, draw: Callable[[Any], None], size: tuple[float, float] = (WIDTH, HEIGHT)) -> str:
    """Draw a figure.

    Parameters
    ----------
    name
        Of the figure, unique on the page: what it refers to within itself is named by it.
    draw
        Draws on matplotlib's axes.
    size
        Inches.

    Returns
    -------
    An ``svg`` element, with a title and without what only files have.
    """
    import matplotlib as mpl
    from matplotlib.figure import Figure

    salt = hashlib.sha256(name.encode()).hexdigest()[:12]
    settings: dict[Any, Any] = {
        "svg.hashsalt": salt,
        "svg.fonttype": "none",
        "font.size": 9,
        "font.family": "sans-serif",
    }
    with mpl.rc_context(settings):
        figure = Figure(figsize=size, layout="constrained")
        axes = figure.add_subplot()
        axes.grid(visible=True, color=GRID, linewidth=0.6)
        axes.spines[["top", "right"]].set_visible(False)
        draw(axes)
        stream = io.StringIO()
        figure.savefig(stream, format="svg", metadata={"Date": None, "Creator": None})
    return _bare(stream.getvalue(), salt)


def _bare(text: str, salt: str) -> str:
    """Cut a file down to its ``svg`` element; ids that would stand twice on a page are made its own."""
    element = re.sub(r"<metadata>.*?</metadata>\s*", "", text[text.index("<svg") :], flags=re.DOTALL)
    for name in dict.fromkeys(re.findall(r'\bid="([^"]+)"', element)):
        own = f"{salt}-{name}"
        element = element.replace(f'id="{name}"', f'id="{own}"').replace(f'"#{name}"', f'"#{own}"')
        element = element.replace(f"url(#{name})", f"url(#{own})")
    return element.strip()
