"""Drawings as files: a form, an animation, a GIF, a contact sheet, or one file for each time."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from genome.errors import InputError
from genome.files import write_together
from growth.forms import form_bytes
from growth.timed.animation.glb import animated_glb
from growth.timed.animation.pictures import SIZE, contact_sheet, gif, pictures
from growth.timed.drawing import Drawing

if TYPE_CHECKING:
    from PIL.Image import Image

MESHES: Final = (".obj", ".ply", ".stl")
FORMS: Final = (".glb", ".png", ".gif", *MESHES)
SHEET: Final = ".sheet.png"
"""A contact sheet."""

LARGE: Final = (1000, 750)
"""Pixels of a single picture."""


def write_drawings(drawings: Sequence[Drawing], output: Path, source: str) -> list[str]:
    """Write drawings, all files or none: one of an animation, a GIF or a sheet; else one for each time.

    Parameters
    ----------
    drawings
        At one time or more, ascending.
    output
        Its suffix chooses: ``.glb``, ``.gif`` and ``.sheet.png`` hold all times; ``.png``, ``.obj``, ``.ply`` and
        ``.stl`` hold one, and are numbered where there are several.
    source
        The system's name, kept with the form.

    Returns
    -------
    The files' names.

    Raises
    ------
    InputError
        When nothing is drawn, or the files cannot be written.
    """
    suffix = output.suffix.lower()
    if not any(map(len, drawings)):
        raise InputError("-o", "a form with parts", "none", "the turtle draws nothing at this time; try a later one")
    if output.name.lower().endswith(SHEET):
        files = {output: png_bytes(contact_sheet(drawings, source))}
    elif suffix == ".glb":
        files = {output: animated_glb(drawings, {"title": output.stem, "system": source})}
    elif suffix == ".gif":
        files = {output: gif(drawings)}
    else:
        files = dict(zip(_numbered(output, len(drawings)), _each(drawings, suffix), strict=True))
    write_together(files)
    return [str(path) for path in files]


def png_bytes(image: Image) -> bytes:
    """Give a picture as the content of a PNG file."""
    stream = io.BytesIO()
    image.save(stream, format="PNG", optimize=True)
    return stream.getvalue()


def _each(drawings: Sequence[Drawing], suffix: str) -> list[bytes]:
    """Give a file's content for each drawing."""
    if suffix == ".png":
        return [png_bytes(image) for image in pictures(drawings, LARGE if len(drawings) == 1 else SIZE)]
    for drawing in drawings:
        if not len(drawing):
            got = f"none at time {drawing.time:.9g}"
            raise InputError("-o", "a form with parts at each time", got, "begin later, or write a .glb")
    return [form_bytes(drawing.surface(), suffix) for drawing in drawings]


def _numbered(output: Path, count: int) -> list[Path]:
    """Give the names of so many files; several are numbered from 0."""
    if count == 1:
        return [output]
    digits = max(4, len(str(count - 1)))
    return [output.with_name(f"{output.stem}-{place:0{digits}}{output.suffix}") for place in range(count)]
