"""Drawings as pictures under one camera: a sequence, a GIF, a contact sheet."""

from __future__ import annotations

import io
import itertools
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from genome.errors import InputError
from growth.camera import looking_at
from growth.timed.drawing import Drawing
from growth.timed.pictures import AZIMUTH, ELEVATION, bounds, picture
from growth.timed.tables import Floats

if TYPE_CHECKING:
    from PIL.Image import Image

SIZE: Final = (480, 360)
SHEET_SIZE: Final = (320, 240)
"""Pixels of a picture, and of one of a contact sheet; as many in another shape where a form is tall, or long."""

TALLEST: Final = 3 / 4
LONGEST: Final = 2.0
"""Width over height of pictures."""

SHOWN: Final = 20
"""The most pictures of a contact sheet."""

COLUMNS: Final = 5
PAPER: Final = "#f4f3f1"
LEAST: Final = 20
"""Milliseconds of a GIF's frame: programs show faster ones slowly."""


def pictures(drawings: Sequence[Drawing], size: tuple[int, int] = SIZE) -> list[Image]:
    """Draw all, each with the room that all of them need; one without parts is empty paper.

    Parameters
    ----------
    drawings
        One or more.
    size
        Pixels. Pictures have as many, in a shape that goes with what all drawings need.

    Raises
    ------
    InputError
        When none has a part.
    """
    from PIL import Image

    window = bounds(*drawings)
    if window is None:
        raise InputError("picture", "a drawing with a part", "none", "the word draws nothing at these times")
    size = _shaped(window, size)
    return [picture(one, size, window) if len(one) else Image.new("RGB", size, PAPER) for one in drawings]


def gif(drawings: Sequence[Drawing], size: tuple[int, int] = SIZE) -> bytes:
    """Draw all as a GIF that goes round for ever; a unit of time is a second; ``size`` as of :func:`pictures`.

    Raises
    ------
    InputError
        When none has a part.
    """
    from PIL.Image import Dither

    images = pictures(drawings, size)
    # One palette for all, so that what stands still does not flicker.
    palette = _side_by_side(images[:: max(1, len(images) // 12)]).quantize(256)
    frames = [image.quantize(palette=palette, dither=Dither.NONE) for image in images]
    stream = io.BytesIO()
    frames[0].save(stream, "GIF", save_all=True, append_images=frames[1:], duration=_lasts(drawings), loop=0)
    return stream.getvalue()


def contact_sheet(drawings: Sequence[Drawing], title: str, size: tuple[int, int] = SHEET_SIZE) -> Image:
    """Draw up to 20 of the drawings side by side, evenly chosen, the first and the last among them.

    ``size`` is that of each, as of :func:`pictures`.

    Raises
    ------
    InputError
        When none has a part.
    """
    from PIL import Image, ImageDraw

    count = min(SHOWN, len(drawings))
    chosen = [drawings[round(place * (len(drawings) - 1) / max(count - 1, 1))] for place in range(count)]
    images = pictures(chosen, size)
    wide, tall = images[0].size
    columns = min(COLUMNS, count)
    rows = -(-count // columns)
    sheet = Image.new("RGB", (columns * wide, 34 + rows * (tall + 20)), "#ffffff")
    pen = ImageDraw.Draw(sheet)
    pen.text((8, 8), title, "#1a1a1a", _font(16))
    for place, (one, image) in enumerate(zip(chosen, images, strict=True)):
        left, top = place % columns * wide, 34 + place // columns * (tall + 20)
        sheet.paste(image, (left, top))
        pen.text((left + 8, top + tall + 2), f"t = {one.time:.4g}", "#6b6b6b", _font(12))
    return sheet


def _shaped(window: Floats, size: tuple[int, int]) -> tuple[int, int]:
    """Give a size of about as many pixels, as wide to its height as the window is seen to be, within limits."""
    corners = np.array(list(itertools.product(*window.T)))
    wide, tall, _ = np.ptp(corners @ looking_at(corners, size, AZIMUTH, ELEVATION).axes.T, axis=0).tolist()
    shape = min(max(wide / max(tall, 1e-300), TALLEST), LONGEST)
    pixels = size[0] * size[1]
    height = round((pixels / shape) ** 0.5)
    return round(pixels / height), height


def _lasts(drawings: Sequence[Drawing]) -> list[int]:
    """Give how long each is shown, in milliseconds; the last as long as the one before."""
    times = [drawing.time for drawing in drawings]
    spans = [after - before for before, after in itertools.pairwise(times)] or [1.0]
    return [max(LEAST, round(1000.0 * span)) for span in (*spans, spans[-1])][: len(times)]


def _side_by_side(images: Sequence[Image]) -> Image:
    from PIL import Image

    small = [image.reduce(4) for image in images]
    sheet = Image.new("RGB", (sum(one.width for one in small), small[0].height))
    left = 0
    for one in small:
        sheet.paste(one, (left, 0))
        left += one.width
    return sheet


def _font(size: int) -> Any:  # noqa: ANN401 - Pillow's
    from PIL import ImageFont

    return ImageFont.load_default(size)
