"""Growth of rooms, zones and houses from their genotypes, and drawing of genotypes that can be grown.

What is drawn starts from one integer of the passed generator. Each free edge is as likely as any other; where the new
cell, or part, does not fit there, the edge is drawn anew (Rosenman 1997, section 3.2.1).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from itertools import chain
from typing import Final

import numpy as np

from genome.polyform.genotypes import Assembly, Attachment, Conjoining, Part, Room
from growth.polyforms import _kernels
from growth.polyforms.polyform import Ints, Plan, Polyform
from growth.polyforms.tiling import Tiling
from growth.protocol import Failure

NONE: Final = -1
NEVER: Final = 2**40
STILL: Final = np.zeros(1, dtype=np.uint64)
REMEMBERED: Final = 4096
"""Forms of parts that are kept: the same rooms are parts of many zones."""


def grow_room(room: Room, tiling: Tiling) -> Polyform | Failure:
    """Grow a room cell by cell.

    Returns
    -------
    Polyform or Failure
        ``conjoining`` with the number of the first that does not fit: there is no such free edge, or the boundary would
        not be a simple polygon.
    """
    joins = _rows(room)
    cells, _, reason, at = _conjoined(joins, NONE, NEVER, STILL, room.first, tiling)
    return Polyform(tiling, cells) if reason == _kernels.DONE else _failure(reason, at, joins, tiling)


def assemble(assembly: Assembly, tiling: Tiling) -> Plan | Failure:
    """Conjoin the parts of a zone or a house, and theirs.

    Returns
    -------
    Plan or Failure
        As :func:`grow_room`; also where parts overlap.
    """
    parts = [form_of(part.genotype, tiling) for part in assembly.parts]
    for one in parts:
        if isinstance(one, Failure):
            return one
    plans = [one for one in parts if isinstance(one, Plan)]
    joins = np.array(assembly.joins, dtype=np.int64).reshape(-1, 3)
    cells, _, reason, at = _assembled(plans, joins, NONE, NEVER, STILL, tiling)
    return _plan(plans, cells, tiling) if reason == _kernels.DONE else _failure(reason, at, joins, tiling)


def draw_room(size: int, tiling: Tiling, rng: np.random.Generator) -> Room:
    """Draw a room of so many cells; of triangles the first points up or down."""
    state = _state(rng)
    first = _kernels.below(state, tiling.types) if tiling.types > 1 else 0
    # No form has an edge of this number: each is drawn.
    return _drawn_room(np.tile(np.array([0, NEVER], dtype=np.int64), (size - 1, 1)), NONE, 0, state, first, tiling)


def redraw_room(room: Room, at: int, tiling: Tiling, rng: np.random.Generator) -> Room:
    """Draw one conjoining of a room anew, and those behind it that no longer fit."""
    joins = _rows(room)
    return _drawn_room(joins, at, at, _state(rng), room.first, tiling)


def draw_assembly(parts: Sequence[Part], tiling: Tiling, rng: np.random.Generator) -> Assembly | Failure:
    """Draw attachments of parts; a failure where no way to conjoin them was found."""
    none = Attachment(0, NEVER, 0)  # no form has an edge of this number
    return mend_assembly(Assembly(tuple(parts), (none,) * (len(parts) - 1)), tiling, rng)


def redraw_assembly(assembly: Assembly, at: int, tiling: Tiling, rng: np.random.Generator) -> Assembly | Failure:
    """Draw one attachment of an assembly anew, and those behind it that no longer fit."""
    return _drawn_assembly(assembly, at, at, tiling, rng)


def mend_assembly(assembly: Assembly, tiling: Tiling, rng: np.random.Generator) -> Assembly | Failure:
    """Draw those attachments of an assembly anew that do not fit, as when one of its parts was exchanged."""
    return _drawn_assembly(assembly, NONE, 0, tiling, rng)


def _drawn_assembly(
    assembly: Assembly, force: int, mend: int, tiling: Tiling, rng: np.random.Generator
) -> Assembly | Failure:
    parts = [form_of(part.genotype, tiling) for part in assembly.parts]
    for one in parts:
        if isinstance(one, Failure):
            return one
    plans = [one for one in parts if isinstance(one, Plan)]
    given = np.array(assembly.joins, dtype=np.int64).reshape(-1, 3)
    _, joins, reason, place = _assembled(plans, given, force, mend, _state(rng), tiling)
    if reason != _kernels.DONE:
        return _failure(reason, place, joins, tiling)
    return Assembly(assembly.parts, tuple(Attachment(*row) for row in joins.tolist()))


# -- between genotypes and kernels -------------------------------------------------------------------------------------


def _rows(room: Room) -> Ints:
    """Give a room's conjoinings, (n - 1, 2); four times as fast as from a sequence of tuples."""
    return np.fromiter(chain.from_iterable(room.joins), np.int64, 2 * len(room.joins)).reshape(-1, 2)


def _state(rng: np.random.Generator) -> np.ndarray[tuple[int], np.dtype[np.uint64]]:
    return np.array([rng.integers(0, 2**63)], dtype=np.uint64)


def _conjoined(
    joins: Ints, force: int, mend: int, state: _kernels.State, first: int, tiling: Tiling
) -> tuple[Ints, Ints, int, int]:
    return _kernels.conjoin(
        joins, force, mend, state, first, tiling.steps, tiling.around, tiling.corners, tiling.lattice
    )


def _drawn_room(joins: Ints, force: int, mend: int, state: _kernels.State, first: int, tiling: Tiling) -> Room:
    """Draw until all fit: a form has a free edge where a cell fits in any case, and each is drawn sooner or later."""
    while True:
        _, made, reason, _ = _conjoined(joins, force, mend, state, first, tiling)
        if reason == _kernels.DONE:
            return Room(tuple(Conjoining(*row) for row in made.tolist()), first)


@lru_cache(maxsize=REMEMBERED)
def form_of(genotype: Room | Assembly, tiling: Tiling) -> Plan | Failure:
    """Grow a genotype of either sort as a plan, a room as one of a single room; the last ones grown are remembered."""
    if isinstance(genotype, Assembly):
        return assemble(genotype, tiling)
    form = grow_room(genotype, tiling)
    if isinstance(form, Failure):
        return form
    return Plan(tiling, form.cells, np.zeros(len(form.cells), dtype=np.int64))


def _assembled(
    plans: Sequence[Plan], joins: Ints, force: int, mend: int, state: _kernels.State, tiling: Tiling
) -> tuple[Ints, Ints, int, int]:
    cells = np.concatenate([plan.cells for plan in plans])
    starts = np.cumsum([0, *(len(plan.cells) for plan in plans)])
    return _kernels.assemble(
        cells, starts, joins, force, mend, state, tiling.steps, tiling.opposite, tiling.corners, tiling.lattice,
    )  # fmt: skip


def _plan(plans: Sequence[Plan], cells: Ints, tiling: Tiling) -> Plan:
    before = 0
    rooms = []
    for plan in plans:
        rooms.append(plan.rooms + before)
        before += plan.count
    return Plan(tiling, cells, np.concatenate(rooms))


def _failure(reason: int, at: int, joins: Ints, tiling: Tiling) -> Failure:
    row = joins[at].tolist()
    edge = f"{tiling.letters[row[0]]}{row[1] + 1}" if row[0] < len(tiling.letters) else f"of vector {row[0]}"
    what = {
        _kernels.NO_EDGE: f"there is no free edge {edge}" + (f" for the part's edge {row[2] + 1}" if row[2:] else ""),
        _kernels.NO_DISC: f"joined at {edge} the boundary is no simple polygon",
        _kernels.OVERLAP: f"joined at {edge} the parts overlap",
    }[reason]
    return Failure("conjoining", f"number {at + 1}: {what}")
