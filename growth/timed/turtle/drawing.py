"""From what the turtle leaves behind to a drawing: parts get their shapes, equal ones share one."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Final, final

import numpy as np

from growth.protocol import Failure
from growth.timed.drawing import Drawing, Shape
from growth.timed.tables import NONE, Floats, Ints
from growth.timed.turtle import _carriers, shapes
from growth.timed.turtle.sections import CIRCLE, resampled, shipped
from growth.timed.turtle.settings import TurtleSettings
from growth.timed.turtle.tables import BEGIN, CARRY, DISC, DRAW, SPHERE, SURFACE, Trail
from growth.timed.turtle.walking import walk
from growth.timed.word import Word

DISC_SIDES: Final = 4
"""So many times the sides of other round shapes."""


def draw(word: Word, turtle: TurtleSettings | None = None) -> Drawing | Failure:
    """Draw a word (McCormack, section 4).

    Parameters
    ----------
    word
        At one time; docs/formats/tl.md says what the turtle makes of each symbol. Symbols that it does not know draw
        nothing.
    turtle
        The defaults where not given.

    Returns
    -------
    Drawing or Failure
        A failure has the reason ``rules`` (a parameter count that does not match), ``diverged`` (a coordinate over 1e9)
        or ``budget``.
    """
    turtle = turtle or TurtleSettings()
    trail = walk(word, turtle)
    if isinstance(trail, Failure):
        return trail
    shelf = _Shelf()
    if least_vertices(trail, turtle) > turtle.max_vertices:
        return _too_many(word, turtle)
    which = np.full(len(trail.parts), NONE, dtype=np.int64)
    frames, colours = trail.frames, trail.colours
    for parts, place in _simple(trail, word, turtle, shelf):
        which[parts] = place
    for part, place in (*_carriers_of(trail, word, turtle, shelf), *_polygons(trail, shelf)):
        which[part] = place
    modules = trail.parts[:, 0]
    kept = np.flatnonzero(which != NONE)
    if len(kept) < len(which):
        which, frames, colours, modules = which[kept], frames[kept], colours[kept], modules[kept]
    sizes = np.array([len(shape.vertices) for shape in shelf.shapes], dtype=np.int64)
    if int(sizes[which].sum()) > turtle.max_vertices:
        return _too_many(word, turtle)
    movers = np.where(trail.movers == NONE, 0, word.lineages[trail.movers] if len(word) else 0)
    return Drawing(word.time, tuple(shelf.shapes), which, frames, colours, word.lineages[modules], trail.tips, movers)


def _too_many(word: Word, turtle: TurtleSettings) -> Failure:
    most = f"the {turtle.max_vertices} that max_vertices allows"
    return Failure("budget", f"more vertices at time {word.time:.9g} than {most}")


def least_vertices(trail: Trail, turtle: TurtleSettings) -> int:
    """Give how many vertices carriers and cylinders have at least, before any is made."""
    spots, owners = trail.spots, trail.sections[:, 0]
    order = np.argsort(owners, kind="stable")
    places, owned = spots[order, :3], owners[order]
    inner = owned[1:] == owned[:-1]
    apart = np.linalg.norm(np.diff(places, axis=0), axis=1) > _carriers.STRAY * spots[:, 6].max(initial=0.0)
    carried = int((inner & apart).sum()) * turtle.rings - 2 * len(np.unique(owned))
    cylinders = int((trail.parts[:, 1] == DRAW).sum()) * (2 * turtle.sides + 2)
    return max(carried, 0) * min(turtle.sides, turtle.corners) + cylinders


@final
class _Shelf:
    """Shapes, each once."""

    def __init__(self) -> None:
        self.shapes: list[Shape] = []
        self.places: dict[tuple[int, bytes], int] = {}

    def place(self, kind: int, key: bytes, make: Callable[[], Shape]) -> int:
        """Give the place of a shape, which is made when it is asked for first."""
        if (kind, key) not in self.places:
            self.places[kind, key] = len(self.shapes)
            self.shapes.append(make())
        return self.places[kind, key]


def _simple(trail: Trail, word: Word, turtle: TurtleSettings, shelf: _Shelf) -> Iterator[tuple[Ints, int]]:
    """Give the parts that are scaled unit shapes, and surfaces."""
    kinds = trail.parts[:, 1]
    for kind, unit in ((DRAW, shapes.cylinder), (SPHERE, shapes.sphere)):
        parts = np.flatnonzero(kinds == kind)
        if len(parts):
            yield parts, shelf.place(kind, b"", partial(unit, turtle.sides))
    for kind in (DISC, SURFACE):
        parts = np.flatnonzero(kinds == kind)
        if not len(parts):
            continue
        extras, row = np.unique(trail.extras[parts], axis=0, return_inverse=True)
        for at, extra in enumerate(extras):
            make = partial(_of_extra, kind, extra, word, turtle)
            yield parts[row.reshape(-1) == at], shelf.place(kind, extra.tobytes(), make)


def _of_extra(kind: int, extra: Floats, word: Word, turtle: TurtleSettings) -> Shape:
    """Give a disc with its hole, or the mean of the surfaces."""
    if kind == DISC:
        return shapes.disc(float(extra[0]), DISC_SIDES * turtle.sides)
    return shapes.patch(np.tensordot(extra, word.figures.surfaces, axes=1))


def _carriers_of(trail: Trail, word: Word, turtle: TurtleSettings, shelf: _Shelf) -> Iterator[tuple[int, int]]:
    """Give the carriers; those without length or width are none."""
    sections = np.concatenate([shipped(), word.figures.sections]) if (trail.parts[:, 1] == CARRY).any() else None
    tables: dict[int, Floats] = {}
    for part, rows in _grouped(trail.sections[:, 0]):
        assert sections is not None
        spots, kinds = trail.spots[rows], trail.sections[rows, 1]
        if np.abs(spots[:, :3] - spots[0, :3]).max() <= _carriers.STRAY * spots[:, 6].max() or not spots[:, 6].any():
            continue
        sides = turtle.sides if (kinds == CIRCLE).all() else turtle.corners
        if sides not in tables:
            tables[sides] = resampled(sections, sides)
        make = partial(_carrier, spots, kinds, turtle.rings, tables[sides])
        yield part, shelf.place(CARRY, spots.tobytes() + kinds.tobytes(), make)


def _carrier(spots: Floats, kinds: Ints, rings: int, table: Floats) -> Shape:
    return Shape("carrier", *_carriers.swept(spots, kinds, rings, table), closed=True)


def _polygons(trail: Trail, shelf: _Shelf) -> Iterator[tuple[int, int]]:
    """Give the polygons that were closed, seen from where they began."""
    for part, rows in _grouped(trail.corners):
        if trail.extras[part, 0] == 0.0:
            continue
        frame = trail.frames[part]
        shape = shapes.polygon((trail.places[rows] - frame[:3, 3]) @ frame[:3, :3])
        if shape is not None:
            yield part, shelf.place(BEGIN, shape.vertices.tobytes(), partial(Shape, *shape))


def _grouped(owners: Ints) -> Iterator[tuple[int, Ints]]:
    """Give each owner, in ascending order, with its rows."""
    order = np.argsort(owners, kind="stable")
    numbers, starts = np.unique(owners[order], return_index=True)
    yield from zip(numbers.tolist(), np.split(order, starts[1:]), strict=True) if len(owners) else ()
