"""L-systems and turtles as arrays, for the kernels."""

from __future__ import annotations

from functools import cache
from itertools import accumulate
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from genome.lsystem import LSystem, Rule, Word
from genome.lsystem.symbols import ALPHABET
from genome.lsystem.system import ROUNDING, Head
from growth.blocks.lattice import Ints, Lattice

Codes = NDArray[np.uint8]

_CODES: Final = np.zeros(256, dtype=np.uint8)
_CODES[list(ALPHABET.encode("latin-1"))] = np.arange(len(ALPHABET))


class Program(NamedTuple):
    """An L-system's rules as arrays, see :func:`growth.blocks._kernels.choose`.

    Attributes
    ----------
    axiom
        (n,) codes.
    groups, contexts, spans, until, lengths
        The rules, sorted into groups that share operand and contexts.
    successors, starts
        (sum of lengths,) codes, and (r + 1,) where each successor begins.
    """

    axiom: Codes
    groups: Ints
    contexts: Ints
    spans: Ints
    until: NDArray[np.float64]
    lengths: Ints
    successors: Codes
    starts: Ints


def codes_of(word: Word) -> Codes:
    """Give the codes (n,) of a word's characters."""
    return np.asarray(_CODES[np.frombuffer(str(word).encode("latin-1"), dtype=np.uint8)])


def compile_system(system: LSystem) -> Program:
    """Turn an L-system into arrays.

    Of the groups of one operand those that ask for more stand first: both contexts, the left one, the right one, none.
    """
    members: dict[Head, list[Rule]] = {}
    for rule in system.rules:
        members.setdefault(rule.head, []).append(rule)
    heads = sorted(members, key=lambda head: (_code(head[0]), head[1] is None, head[2] is None))
    operands = np.array([_code(head[0]) for head in heads], dtype=np.int64)
    contexts = np.array([[_code(head[1]), _code(head[2])] for head in heads], dtype=np.int64).reshape(-1, 2)
    words = [codes_of(rule.successor) for head in heads for rule in members[head]]
    lengths = np.array([len(word) for word in words], dtype=np.int64)
    return Program(
        axiom=codes_of(system.axiom),
        groups=np.searchsorted(operands, np.arange(len(ALPHABET) + 1)).astype(np.int64),
        contexts=contexts,
        spans=_starts(np.array([len(members[head]) for head in heads], dtype=np.int64)),
        until=np.array([share for head in heads for share in _until(members[head])], dtype=np.float64),
        lengths=lengths,
        successors=np.concatenate([np.empty(0, dtype=np.uint8), *words]),
        starts=_starts(lengths),
    )


@cache
def turns_of(lattice: Lattice) -> Ints:
    """Give the heading after each turn: (7, k) places in ``offsets``, by heading; rows in the order of the codes."""
    there = lattice.turns
    back = np.argsort(there, axis=1)
    places = {tuple(offset): place for place, offset in enumerate(lattice.offsets.tolist())}
    half = [places[-x, -y, z] for x, y, z in lattice.offsets.tolist()]
    return np.stack([there[0], back[0], there[1], back[1], there[2], back[2], np.array(half)]).astype(np.int64)


def _code(letter: str | None) -> int:
    return -1 if letter is None else ALPHABET.index(letter)


def _until(rules: list[Rule]) -> list[float]:
    """Add up the chances of a group; what is left within rounding goes to the last rule."""
    sums = list(accumulate(rule.chance for rule in rules))
    return [*sums[:-1], 2.0] if sums[-1] >= 1.0 - ROUNDING else sums


def _starts(lengths: Ints) -> Ints:
    return np.concatenate([np.zeros(1, dtype=np.int64), np.cumsum(lengths)])
