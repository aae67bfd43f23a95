"""Drawings and animals made by hand, for the criteria of timed forms."""

from __future__ import annotations

import math

import numpy as np

from evaluators.timed import Unfolding
from growth.timed.drawing import Drawing, Shape
from growth.timed.turtle.shapes import cylinder, disc, polygon, sphere

SIDES = 16
CYLINDER, SPHERE, SQUARE = (
    cylinder(SIDES),
    sphere(SIDES),
    polygon(np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])),
)
assert SQUARE is not None
RINGED = disc(0.5, SIDES)
BASE = math.sin(2 * math.pi / SIDES) * SIDES / 2
"""The area of a cylinder's base, of radius 1."""
GIRTH = 2 * SIDES * math.sin(math.pi / SIDES)
"""How long it is around."""


def placed(x=0.0, y=0.0, z=0.0, wide=1.0, high=1.0):
    """A frame that scales and moves."""
    frame = np.diag([wide, wide, high, 1.0])
    frame[:3, 3] = x, y, z
    return frame


def drawing(*parts: tuple[Shape, np.ndarray], time=0.0, tips=(), lineages=None) -> Drawing:
    """A drawing of parts, each a shape and a frame."""
    shapes = []
    for shape, _ in parts:
        if not any(shape is other for other in shapes):
            shapes.append(shape)
    which = [next(at for at, other in enumerate(shapes) if other is shape) for shape, _ in parts]
    tips = np.array(tips, dtype=float).reshape(-1, 3)
    names = np.arange(1, len(tips) + 1) if lineages is None else np.array(lineages, dtype=np.int64)
    frames = np.array([frame for _, frame in parts]).reshape(-1, 4, 4)
    count = len(parts)
    return Drawing(time, tuple(shapes), np.array(which, dtype=np.int64), frames, np.full((count, 3), 0.5),
                   np.arange(count), tips, names)  # fmt: skip


def still(*parts) -> Unfolding:
    """A form at one time."""
    return Unfolding(np.zeros(1), (drawing(*parts),))


def sequence(*drawings: Drawing) -> Unfolding:
    """Drawings as a form that unfolds."""
    return Unfolding(np.arange(len(drawings), dtype=float), drawings)


BODY = (CYLINDER, placed(z=1.0, wide=0.2, high=1.0))


def animal(tracks, lineages=None, body=BODY) -> Unfolding:
    """An animal whose feet are at places (n, k, 3)."""
    return sequence(*(drawing(body, tips=places, lineages=lineages) for places in np.asarray(tracks, dtype=float)))


def walker(phases, n=12, cycles=1, reach=0.5, lift=0.25, duty=0.5, heading=0.0):
    """Places (cycles n + 1, k, 3) of feet that go back on the ground for a part of the cycle, and forth in the air.

    The animal heads for ``heading``, an angle in degrees from x to y. A foot of phase 0 comes down at the first sample.
    """
    times = np.arange(cycles * n + 1)[:, None] / n
    # In exact n-ths, so that a foot that is down at a sample is not up by rounding.
    parts = np.round((times + np.asarray(phases)[None, :]) % 1.0, 12) % 1.0
    stands = parts <= duty
    along = np.where(stands, reach * (1 - 2 * parts / duty), reach * (2 * (parts - duty) / (1 - duty) - 1))
    heights = np.where(stands, 0.0, lift * np.sin(np.pi * (parts - duty) / (1 - duty)))
    angle = math.radians(heading)
    ways = along[..., None] * [math.cos(angle), math.sin(angle), 0.0]
    ways[..., 2] = heights
    # Hips stand across the way, in a row.
    hips = np.arange(len(phases))[:, None] * [-math.sin(angle), math.cos(angle), 0.0]
    return ways + hips
