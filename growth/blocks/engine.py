"""Growth of block bodies: rewriting, the turtle, and what stands around the skeleton (Senatore 2009, chapter 2)."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Final

import numpy as np
from numpy.typing import NDArray

from genome.lsystem import LSystem
from growth.blocks import _kernels
from growth.blocks.body import BOUNDARY, ENVELOPE, INTERNAL, Body, Cells
from growth.blocks.lattice import Lattice
from growth.blocks.program import Codes, compile_system, turns_of
from growth.blocks.settings import BlockBudget, BlockGrowth, CellGrowth
from growth.protocol import Clock, Failure

NO_FLOOR: Final = -2 * _kernels.FARTHEST

Free = Callable[[Cells], NDArray[np.bool_]]
"""Says of each of (n, 3) cells whether it may be placed."""


def grow(
    system: LSystem, growth: BlockGrowth | None = None, clock: Clock = time.thread_time, seed: int | None = None
) -> Body | Failure:
    """Grow a body from an L-system.

    Parameters
    ----------
    system
        The genotype.
    growth
        Lattice, ground, envelope and budget; the defaults where not given.
    clock
        Tells the time for the safety net behind the budget.
    seed
        Decides what rules with chances do, in place of the genotype's own.

    Returns
    -------
    Body or Failure
        A failure has the reason ``budget``, ``clock``, or ``boundary`` where all blocks fall into the supports.
    """
    growth = growth or BlockGrowth()
    cells = _drawn(system, growth, growth.cells, clock, seed)
    if isinstance(cells, Failure):
        return cells
    body = stand(cells, growth)
    if not len(body.internal):
        return Failure("boundary", "every block lies in a support")
    return body


def grow_cells(
    system: LSystem,
    growth: CellGrowth | None = None,
    clock: Clock = time.thread_time,
    seed: int | None = None,
    free: Free | None = None,
) -> Cells | Failure:
    """Grow bare cells from an L-system; nothing stands, and nothing is wrapped.

    Parameters
    ----------
    system, clock, seed
        As of :func:`grow`.
    growth
        Lattice, start and budget; the defaults where not given.
    free
        Which cells may be placed; all where not given. The turtle goes through the others and leaves them out.

    Returns
    -------
    (n, 3) int64 or Failure
        Distinct cells in the order in which they were placed, at least one. A failure has the reason ``budget``,
        ``clock``, or ``empty`` where no cell could be placed.
    """
    growth = growth or CellGrowth()
    # Cells that are left out cost nothing: of those that a turtle goes through its word's length is the bound.
    most = growth.max_blocks if free is None else max(growth.max_blocks, growth.max_symbols)
    cells = _drawn(system, growth, growth.cells, clock, seed, most)
    if isinstance(cells, Failure):
        return cells
    placed = cells + np.array(growth.start, dtype=np.int64)
    if free is not None:
        placed = np.ascontiguousarray(placed[free(placed)])
    if len(placed) > growth.max_blocks:
        return _too_many(growth)
    if not len(placed):
        return Failure("empty", f"none of {len(cells)} cells lies where cells may be placed")
    return placed


def _drawn(
    system: LSystem, budget: BlockBudget, lattice: Lattice, clock: Clock, seed: int | None, most: int | None = None
) -> Cells | Failure:
    """Let the turtle read an L-system's last word, from a block at the origin on, for so many blocks at most."""
    most = budget.max_blocks if most is None else most
    word = derive(system, budget, clock, seed)
    if isinstance(word, Failure):
        return word
    cells, count = _kernels.walk(word, lattice.offsets, turns_of(lattice), lattice.heading, most)
    return _too_many(budget) if count > most else cells


def _too_many(budget: BlockBudget) -> Failure:
    return Failure("budget", f"more blocks than the {budget.max_blocks} that max_blocks allows")


def derive(
    system: LSystem, growth: BlockBudget | None = None, clock: Clock = time.thread_time, seed: int | None = None
) -> Codes | Failure:
    """Rewrite an L-system's axiom as often as it says; give the codes of the last word. Parameters as of :func:`grow`.

    Each letter is replaced by the rule, of those whose contexts it has, that asks for most: both contexts, the left
    one, the right one, none.
    """
    growth = growth or BlockBudget()
    deadline = clock() + growth.max_seconds
    program = compile_system(system)
    word = program.axiom
    if word.size > growth.max_symbols:
        return _too_long("the axiom has", word.size, growth)
    state = np.array([system.seed if seed is None else seed], dtype=np.uint64)
    for iteration in range(system.iterations):
        chosen, total = _kernels.choose(
            word, program.groups, program.contexts, program.spans, program.until, program.lengths, state
        )
        if total > growth.max_symbols:
            return _too_long(f"iteration {iteration + 1} makes", total, growth)
        word = _kernels.rewrite(word, chosen, total, program.successors, program.starts)
        if clock() > deadline:
            return Failure("clock", "the growth took longer than max_seconds")
    return word


def stand(internal: Cells, growth: BlockGrowth | None = None) -> Body:
    """Stand a skeleton on its ground or supports, and wrap it.

    Parameters
    ----------
    internal
        (n, 3) int64, the cells of the skeleton in the order in which they were placed. Of equal ones the first counts;
        those in a support do not count.
    growth
        Lattice, ground, supports and envelope; the defaults where not given. Its budget is not looked at.

    Returns
    -------
    Body
        Its boundary is empty where it misses a fixed ground. Cells of the envelope lie free, and not under the ground.
    """
    growth = growth or BlockGrowth()
    lattice = growth.cells
    internal = np.ascontiguousarray(internal, dtype=np.int64).reshape(-1, 3)
    supports = np.array(growth.supports or (), dtype=np.int64).reshape(-1, 3)
    internal = _kernels.distinct(internal, supports)
    floor = NO_FLOOR
    if growth.supports is not None:
        boundary = supports
    elif len(internal):
        floor = int(internal[:, 2].min()) if growth.ground == "lowest" else growth.ground_level
        boundary = _kernels.foundation(internal, lattice.offsets[lattice.beneath], floor)
    else:
        boundary = supports
    wrap = np.empty((0, 3), dtype=np.int64)
    if growth.envelope:
        wrap = _kernels.envelope(internal, boundary, lattice.offsets, growth.envelope_below, floor)
    cells = np.concatenate([internal, _ascending(wrap), _ascending(boundary)])
    systems = np.repeat(
        np.array([INTERNAL, ENVELOPE, BOUNDARY], dtype=np.uint8), [len(internal), len(wrap), len(boundary)]
    )
    return Body(lattice, cells, systems)


def _ascending(cells: Cells) -> Cells:
    return cells[np.lexsort((cells[:, 2], cells[:, 1], cells[:, 0]))]


def _too_long(what: str, count: int, growth: BlockBudget) -> Failure:
    return Failure("budget", f"{what} {count} symbols where max_symbols allows {growth.max_symbols}")
