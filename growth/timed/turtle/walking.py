"""Walking along a word: the turtle's commands as tables, its room, and what goes wrong."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from genome.timed.commands import SECTIONS, TURTLE
from growth.protocol import Failure
from growth.timed.tables import NONE, Floats, Ints
from growth.timed.turtle import _kernels
from growth.timed.turtle.sections import CIRCLE
from growth.timed.turtle.settings import TurtleSettings
from growth.timed.turtle.tables import (
    BEGIN,
    CARRY,
    CLOSE,
    DISC,
    DRAW,
    FAR,
    FEW,
    FIRST_POLYGON,
    FRAME,
    HUE,
    IDLE,
    MANY,
    MOVE,
    MOVER,
    OPERATIONS,
    SECTION,
    SHADE,
    SHAPE,
    SPHERE,
    STATE_COLUMNS,
    SURFACE,
    UNBALANCED,
    WEIGHT,
    WEIGHTS,
    WIDE,
    Code,
    Trail,
)
from growth.timed.word import Word

CLAY: Final = (0.84, 0.46, 0.32)
"""The colour before any other is chosen."""

PALETTE: Final = np.array(
    [
        (0.90, 0.62, 0.00),
        (0.34, 0.71, 0.91),
        (0.00, 0.62, 0.45),
        (0.94, 0.89, 0.26),
        (0.00, 0.45, 0.70),
        (0.84, 0.37, 0.00),
        (0.80, 0.47, 0.65),
        (0.35, 0.35, 0.35),
    ]
)
"""Colours that all kinds of eyes tell apart (Okabe and Ito 2008; dark grey stands for their black)."""

FREE: Final = np.iinfo(np.int64).max
"""A symbol that is the turtle's by an equiv alone may have parameters of its own behind those of the command."""

TROUBLES: Final[Mapping[int, str]] = {
    FEW: "too few parameters",
    MANY: "too many parameters; a symbol that has an equiv may have others of its own behind them",
    FAR: "a coordinate, radius or scale of more than 1e9",
    UNBALANCED: "brackets that do not balance",
}


def walk(word: Word, turtle: TurtleSettings) -> Trail | Failure:
    """Turn a word into places and frames.

    Returns
    -------
    Trail or Failure
        A failure has the reason ``rules`` for parameter counts that do not match, ``diverged`` where the turtle gets
        too far, ``budget`` where there are too many parts.
    """
    code = commanded(word)
    found = np.zeros(WEIGHT + 1, dtype=np.int64)
    depth = _kernels.counted(code.operations, word.codes, found)
    parts = int(found[[DRAW, SPHERE, DISC, SURFACE, CARRY, BEGIN]].sum())
    surfaces = len(word.figures.surfaces)
    trail = _room(found, parts, max(surfaces, 1))
    states, wholes = np.zeros((depth + 1, WEIGHTS + surfaces)), np.zeros((depth + 1, STATE_COLUMNS), dtype=np.int64)
    states[0, FRAME : FRAME + 9] = (0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0)
    states[0, WIDE], states[0, SHADE : SHADE + 3] = turtle.radius, CLAY
    wholes[0] = NONE
    wholes[0, SHAPE], wholes[0, FIRST_POLYGON] = CIRCLE, 0
    assert (HUE, MOVER) == (2, 3)
    unit = 1.0 if word.radians else np.pi / 180.0
    defaults = np.array([turtle.length, np.radians(turtle.angle), unit])
    pile = np.empty(int(found[BEGIN]) + 1, dtype=np.int64)
    counts = np.zeros(_kernels.COUNTERS, dtype=np.int64)
    trouble, at = _kernels.walked(
        code,
        word.codes,
        word.starts,
        word.values,
        defaults,
        PALETTE,
        states,
        wholes,
        pile,
        trail,
        counts,
        np.array([0.0, 1.0, 0.0]),
    )
    if trouble:
        reason = "diverged" if trouble == FAR else "rules"
        return Failure(reason, f"{TROUBLES[trouble]}, at {_described(word, at)} at time {word.time:.9g}")
    p, s, c, k = counts[:4].tolist()
    if p > turtle.max_parts:
        return Failure(
            "budget", f"more parts at time {word.time:.9g} than the {turtle.max_parts} that max_parts allows"
        )
    return Trail(trail.parts[:p], trail.frames[:p], trail.colours[:p], trail.extras[:p], trail.sections[:s],
                 trail.spots[:s], trail.corners[:c], trail.places[:c], trail.tips[:k], trail.movers[:k])  # fmt: skip


def commanded(word: Word) -> Code:
    """Give what the turtle makes of each code of a word."""
    figures, rows = word.figures, []
    nothing = [NONE] * len(word.names)
    chosen, weighed = (part.tolist() or nothing for part in (figures.section_of, figures.surface_of))
    for name, command, section, surface in zip(word.names, word.commands, chosen, weighed, strict=True):
        if section != NONE or surface != NONE:
            row = (WEIGHT, surface, 0, 1) if section == NONE else (SECTION, len(SECTIONS) + section, 0, 0)
        elif command in OPERATIONS:
            kind = SECTIONS.index(command) if command in SECTIONS else 0
            row = (OPERATIONS[command], kind, *TURTLE[command])
        else:
            row = (IDLE, 0, 0, FREE)
        rows.append((*row[:3], row[3] if name == command else FREE))
    return Code(*(np.array(column, dtype=np.int64) for column in zip(*rows, strict=True)))


def _room(found: Ints, parts: int, width: int) -> Trail:
    sections, corners = 2 * int(found[CARRY]), int(found[[MOVE, DRAW, CARRY, BEGIN]].sum()) if found[BEGIN] else 0
    tips = int(found[CLOSE]) + 1
    return Trail(
        parts=np.empty((parts, 2), dtype=np.int64),
        frames=np.empty((parts, 4, 4)),
        colours=np.empty((parts, 3)),
        extras=np.zeros((parts, width)) if found[[DISC, SURFACE, BEGIN]].any() else np.zeros((1, width)),
        sections=np.empty((sections, 2), dtype=np.int64),
        spots=np.empty((sections, 8)),
        corners=np.empty(corners, dtype=np.int64),
        places=np.empty((corners, 3)),
        tips=np.empty((tips, 3)),
        movers=np.empty(tips, dtype=np.int64),
    )


def _described(word: Word, at: int) -> str:
    values: Floats = word.values[word.starts[at] : word.starts[at + 1]]
    name = word.names[int(word.codes[at])]
    return f"{name}({', '.join(f'{value:.6g}' for value in values.tolist())})" if len(values) else name
