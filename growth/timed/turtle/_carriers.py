"""The kernels of generalised cylinders: rings along a carrier curve, and the surface around them."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from growth.surface import Indices
from growth.timed.tables import Floats, Ints

PINCH: float = 1e-6
"""No ring within a carrier is narrower than this part of its widest."""

STRAY: float = 1e-12
"""Pieces shorter than this part of the widest radius have no length."""


@njit(cache=True)
def unit(vectors: Floats, at: int, x: float, y: float, z: float) -> bool:
    """Write a vector as a unit vector; tell whether it has a direction."""
    length = math.sqrt(x * x + y * y + z * z)
    if not length > 0.0:
        return False
    vectors[at, 0], vectors[at, 1], vectors[at, 2] = x / length, y / length, z / length
    return True


@njit(cache=True)
def slopes(lengths: Floats, radii: Floats) -> Floats:
    """Give how fast the radius changes at each section, by length, so that no bulge comes in between.

    The weighted harmonic mean of the slopes on both sides, nothing where their signs differ (Fritsch and Butland 1984).
    Pieces without length count as if they were not there.
    """
    count = radii.size
    found = np.zeros(count)
    for at in range(count):
        before, after = at > 0 and lengths[at - 1] > 0.0, at < count - 1 and lengths[at] > 0.0
        left = (radii[at] - radii[at - 1]) / lengths[at - 1] if before else 0.0
        right = (radii[at + 1] - radii[at]) / lengths[at] if after else 0.0
        if before and after:
            if left * right > 0.0:
                a, b = lengths[at - 1], lengths[at]
                found[at] = 3.0 * (a + b) / ((2.0 * b + a) / left + (b + 2.0 * a) / right)
        else:
            found[at] = left if before else right
    return found


@njit(cache=True)
def traced(spots: Floats, kinds: Ints, rings: int) -> tuple[Floats, Floats, Floats, Ints]:
    """Give the rings of a carrier.

    Parameters
    ----------
    spots
        (k, 8) float64: place, heading, radius and roll of each section.
    kinds
        (k,) int64.
    rings
        How many a piece of some length has, the last being that at its end. A piece without length has one where its
        sections differ, and none where they do not.

    Returns
    -------
    centres, headings
        (n, 3) float64. Cubic Hermite curves, whose tangents at the sections are the headings, as long as the piece.
    numbers
        (n, 3) float64: the radius; the share of the second of two sections, eased; the roll.
    sections
        (n, 2) int64, the two.
    """
    count = spots.shape[0]
    lengths = np.empty(count - 1)
    for k in range(count - 1):
        length = math.sqrt(((spots[k + 1, :3] - spots[k, :3]) ** 2).sum())
        lengths[k] = length if length > STRAY * spots[:, 6].max() else 0.0
    gains = slopes(lengths, spots[:, 6].copy())
    most = 1 + rings * (count - 1)
    centres, headings = np.empty((most, 3)), np.empty((most, 3))
    numbers, sections = np.empty((most, 3)), np.empty((most, 2), np.int64)
    centres[0], headings[0] = spots[0, :3], spots[0, 3:6]
    numbers[0] = (spots[0, 6], 0.0, spots[0, 7])
    sections[0] = kinds[0]
    n = 1
    for k in range(count - 1):
        h, first, second = lengths[k], spots[k], spots[k + 1]
        same = first[6] == second[6] and kinds[k] == kinds[k + 1]
        steps = rings if h > 0.0 else (0 if same else 1)
        for step in range(1, steps + 1):
            t = step / steps
            a, b, c, d = (1 + 2 * t) * (1 - t) ** 2, t * (1 - t) ** 2, t * t * (3 - 2 * t), t * t * (t - 1)
            da, db, dd = 6 * t * (t - 1), (1 - t) * (1 - 3 * t), t * (3 * t - 2)
            if step == steps:
                centres[n] = second[:3]
                unit(headings, n, second[3], second[4], second[5])
            else:
                centres[n] = a * first[:3] + c * second[:3] + h * (b * first[3:6] + d * second[3:6])
                way = da * (first[:3] - second[:3]) + h * (db * first[3:6] + dd * second[3:6])
                if not unit(headings, n, way[0], way[1], way[2]):
                    headings[n] = headings[n - 1]
            numbers[n, 0] = a * first[6] + c * second[6] + h * (b * gains[k] + d * gains[k + 1])
            numbers[n, 1] = c
            numbers[n, 2] = first[7] + c * (second[7] - first[7])
            if kinds[k] == 0 and kinds[k + 1] == 0:
                numbers[n, 2] = 0.0
            sections[n, 0], sections[n, 1] = kinds[k], kinds[k + 1]
            n += 1
    return centres[:n], headings[:n], numbers[:n], sections[:n]


@njit(cache=True)
def reflected(vector: Floats, along: Floats) -> Floats:
    """Reflect a vector in the plane across a direction; in none where there is no direction."""
    square = (along * along).sum()
    if square == 0.0:
        return vector
    return vector - along * (2.0 * (vector * along).sum() / square)


@njit(cache=True)
def transported(centres: Floats, headings: Floats) -> Floats:
    """Carry the first left (x) along so that it turns as little as can be: the double reflection of Wang 2008.

    Returns
    -------
    lefts
        (n, 3) float64, across the headings.
    """
    lefts = np.zeros(headings.shape)
    lefts[0, 0] = 1.0
    for n in range(1, headings.shape[0]):
        along = centres[n] - centres[n - 1]
        left, heading = reflected(lefts[n - 1], along), reflected(headings[n - 1], along)
        left = reflected(left, headings[n] - heading)
        left = left - headings[n] * (left * headings[n]).sum()
        lefts[n] = lefts[n - 1]
        unit(lefts, n, left[0], left[1], left[2])
    return lefts


@njit(cache=True)
def swept(spots: Floats, kinds: Ints, rings: int, tables: Floats) -> tuple[Floats, Indices]:
    """Give the closed surface of a carrier.

    Parameters
    ----------
    spots, kinds, rings
        As of :func:`traced`; two sections or more, of which one has a radius over 0.
    tables
        (s, m) float64, the polar radii of the sections at m angles, from left to up.

    Returns
    -------
    vertices
        (v, 3) float64, ring by ring; then the centres of the two ends. An end of radius 0 is its centre alone.
    triangles
        (t, 3) int32, counter-clockwise seen from outside.
    """
    centres, headings, numbers, sections = traced(spots, kinds, rings)
    lefts = transported(centres, headings)
    widest = numbers[:, 0].max()
    count, sides = centres.shape[0], tables.shape[1]
    first = 1 if numbers[0, 0] <= PINCH * widest else 0
    last = count - 2 if numbers[count - 1, 0] <= PINCH * widest else count - 1
    vertices = np.empty(((last - first + 1) * sides + 2, 3))
    at = 0
    for n in range(first, last + 1):
        radius, share, roll = max(numbers[n, 0], PINCH * widest), numbers[n, 1], numbers[n, 2]
        h, p = headings[n], lefts[n]
        qx, qy, qz = h[1] * p[2] - h[2] * p[1], h[2] * p[0] - h[0] * p[2], h[0] * p[1] - h[1] * p[0]
        a, b = sections[n, 0], sections[n, 1]
        for side in range(sides):
            angle = 2.0 * math.pi * side / sides + roll
            wide = radius * ((1.0 - share) * tables[a, side] + share * tables[b, side])
            x, y = wide * math.cos(angle), wide * math.sin(angle)
            vertices[at, 0] = centres[n, 0] + x * p[0] + y * qx
            vertices[at, 1] = centres[n, 1] + x * p[1] + y * qy
            vertices[at, 2] = centres[n, 2] + x * p[2] + y * qz
            at += 1
    vertices[at], vertices[at + 1] = centres[0], centres[count - 1]
    return vertices, skinned(last - first + 1, sides)


@njit(cache=True)
def skinned(rings: int, sides: int) -> Indices:
    """Give the triangles around rings, and of the fans that close the ends."""
    triangles = np.empty((2 * rings * sides, 3), np.int32)
    at = 0
    for side in range(sides):
        after = (side + 1) % sides
        for ring in range(rings - 1):
            low, high = ring * sides, (ring + 1) * sides
            triangles[at, 0], triangles[at, 1], triangles[at, 2] = low + side, low + after, high + after
            triangles[at + 1, 0], triangles[at + 1, 1], triangles[at + 1, 2] = low + side, high + after, high + side
            at += 2
        end = (rings - 1) * sides
        triangles[at, 0], triangles[at, 1], triangles[at, 2] = rings * sides, after, side
        triangles[at + 1, 0], triangles[at + 1, 1], triangles[at + 1, 2] = rings * sides + 1, end + side, end + after
        at += 2
    return triangles
