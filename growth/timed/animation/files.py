"""Drawings as files: a form, an animation, a GIF, a contact sheet, or one file for each time."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from genome.errors import InputError
from genome.files import write_together
from growth.forms import form_bytes
from growth.surface import Surface, surface_of
from growth.timed.animation.glb import animated_glb
from growth.timed.animation.pictures import SIZE, contact_sheet, gif, pictures
from growth.timed.drawing import Drawing

if TYPE_CHECKING:
    from PIL.Image import Image

MESHES: Final = (".obj", ".ply", ".stl")
FORMS: Final = (".glb", ".png", ".gif", *MESHES)
SHEET: Final = ".sheet.png"
"""A contact sheet."""

CLOSE: Final = 1e-7
"""Corners nearer to each other than this share of a part's extent are one: single precision knows no less."""

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
    return [form_bytes(welded(drawing), suffix) for drawing in drawings]


def welded(drawing: Drawing) -> Surface:
    """Give all parts as one surface, corners of a part that are at one place joined, and no triangle without an extent.

    Where a carrier changes its section at one place, its rings touch: readers that join corners, as those of STL files
    do, would take the triangles between them for sides of others.
    """
    corners, triangles = [np.empty((0, 3))], [np.empty((0, 3), dtype=np.int64)]
    count = 0
    for part, which in enumerate(drawing.which.tolist()):
        own = drawing.corners(part)
        extent = float(np.ptp(own, axis=0).max(initial=0.0))
        keys = np.round(own / (CLOSE * extent)) if extent > 0.0 else np.zeros_like(own)
        _, first, place = np.unique(keys, axis=0, return_index=True, return_inverse=True)
        joined = first[place.reshape(-1)][drawing.shapes[which].triangles]
        kept = (joined != np.roll(joined, 1, axis=1)).all(axis=1)
        corners.append(own)
        triangles.append(joined[kept].astype(np.int64) + count)
        count += len(own)
    used, numbers = np.unique(np.concatenate(triangles), return_inverse=True)
    return surface_of(np.concatenate(corners)[used], numbers.reshape(-1, 3))


def _numbered(output: Path, count: int) -> list[Path]:
    """Give the names of so many files; several are numbered from 0."""
    if count == 1:
        return [output]
    digits = max(4, len(str(count - 1)))
    return [output.with_name(f"{output.stem}-{place:0{digits}}{output.suffix}") for place in range(count)]
