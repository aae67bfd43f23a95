"""Pictures of drawings: parts in their colours, frames under one camera."""

from __future__ import annotations

import numpy as np
import pytest

from genome.errors import InputError
from growth.timed.pictures import bounds, picture
from tests.growth.timed.test_turtle import drawn

RED = "colour(1, 0, 0) !(1) F(3)"


def test_a_part_is_shown_in_its_colour() -> None:
    pixels = np.asarray(picture(drawn(f"{RED} f(1) colour(0, 0, 1) F(3)"), (60, 60))).astype(int)
    red, blue = pixels[..., 0] - pixels[..., 2] > 60, pixels[..., 2] - pixels[..., 0] > 60
    assert red.sum() > 50
    assert blue.sum() > 50
    assert np.flatnonzero(blue.any(axis=1)).mean() < np.flatnonzero(red.any(axis=1)).mean()


def test_frames_of_one_window_have_one_camera_and_ground() -> None:
    low, high = drawn(RED), drawn(f"f(4) {RED}")
    window = bounds(low, high)
    assert window is not None
    np.testing.assert_allclose(window, [[-1, -1, 0], [1, 1, 7]], atol=1e-12)
    rows = []
    for drawing in (low, high):
        pixels = np.asarray(picture(drawing, (60, 90), window)).astype(int)
        rows.append(np.flatnonzero((pixels[..., 0] - pixels[..., 2] > 60).any(axis=1)))
    assert rows[0].max() - rows[1].max() == pytest.approx((rows[1].max() - rows[1].min()) * 4.0 / 3.6, abs=4)
    assert (rows[0].max() - rows[0].min()) == pytest.approx(rows[1].max() - rows[1].min(), abs=3)


def test_nothing_makes_no_picture() -> None:
    assert bounds(drawn("f(1)")) is None
    with pytest.raises(InputError, match="the word draws nothing at this time"):
        picture(drawn("f(1)"))
