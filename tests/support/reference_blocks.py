"""Block growth as plain Python over lists, sets and strings, written from its page and not from the kernels."""

from __future__ import annotations

from genome.lsystem import LSystem, Rule
from growth.blocks.lattice import Lattice

Cell = tuple[int, int, int]
MASK = 2**64 - 1


class Numbers:
    """SplitMix64."""

    def __init__(self, seed: int) -> None:
        self.state = seed

    def draw(self) -> float:
        self.state = (self.state + 0x9E3779B97F4A7C15) & MASK
        z = self.state
        z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
        return ((z ^ (z >> 31)) >> 11) / 2**53


def left_context(word: str, at: int) -> str | None:
    """The nearest letter before a place on the way to the root."""
    depth = 0
    for place in range(at - 1, -1, -1):
        symbol = word[place]
        if symbol == "]":
            depth += 1
        elif symbol == "[":
            depth = max(depth - 1, 0)
        elif symbol == "|" and depth == 0:
            depth = 1  # an elder sibling: passed over up to its branch point
        elif symbol.isalpha() and depth == 0:
            return symbol
    return None


def right_context(word: str, at: int) -> str | None:
    """The next letter behind a place on the same branch."""
    depth = 0
    for symbol in word[at + 1 :]:
        if symbol == "[":
            depth += 1
        elif symbol == "]" and depth:
            depth -= 1
        elif symbol in "|]" and not depth:
            return None
        elif symbol.isalpha() and not depth:
            return symbol
    return None


def chosen_rules(rules: tuple[Rule, ...], operand: str, left: str | None, right: str | None) -> list[Rule]:
    """The rules of the most demanding head that matches."""
    heads = ((left, right), (left, None), (None, right), (None, None))
    for head in heads:
        found = [rule for rule in rules if rule.operand == operand and (rule.left, rule.right) == head]
        if found:
            return found
    return []


def rewritten(word: str, rules: tuple[Rule, ...], numbers: Numbers) -> str:
    parts = []
    for at, symbol in enumerate(word):
        found = chosen_rules(rules, symbol, left_context(word, at), right_context(word, at)) if symbol.isalpha() else []
        new = symbol
        if found:
            whole = sum(rule.chance for rule in found) >= 1 - 1e-9
            drawn = numbers.draw() if not (whole and len(found) == 1) else 0.0
            total = 0.0
            for rule in found:
                total += rule.chance
                if drawn < total or (whole and rule is found[-1]):
                    new = str(rule.successor)
                    break
        parts.append(new)
    return "".join(parts)


def derived(system: LSystem, seed: int | None = None) -> str:
    numbers = Numbers(system.seed if seed is None else seed)
    word = str(system.axiom)
    for _ in range(system.iterations):
        word = rewritten(word, system.rules, numbers)
    return word


def turned(lattice: Lattice, heading: Cell, axis: int, quarter: int) -> Cell:
    """The next offset on the same ring about an axis, to the left (1) or right (-1) of the heading."""
    import math

    across, up = (axis + 1) % 3, (axis + 2) % 3
    if not heading[across] and not heading[up]:
        return heading
    ring = [tuple(o) for o in lattice.offsets.tolist() if o[axis] == heading[axis] and (o[across] or o[up])]
    ring.sort(key=lambda o: math.atan2(o[up], o[across]))
    return ring[(ring.index(heading) + quarter) % len(ring)]


TURNS = {"+": (2, 1), "-": (2, -1), "&": (1, 1), "^": (1, -1), "£": (0, 1), "$": (0, -1)}


class Turtle:
    """Reads a word; the turns are looked up once, as the engine's are."""

    def __init__(self, lattice: Lattice) -> None:
        offsets = [tuple(offset) for offset in lattice.offsets.tolist()]
        self.start = offsets[lattice.heading]
        self.turns = {
            (symbol, offset): turned(lattice, offset, *turn) for symbol, turn in TURNS.items() for offset in offsets
        }
        self.turns |= {("%", offset): (-offset[0], -offset[1], offset[2]) for offset in offsets}

    def walked(self, word: str) -> list[Cell]:
        place, heading = (0, 0, 0), self.start
        placed = {place: None}
        stack = []
        for symbol in word:
            if symbol == "F":
                place = (place[0] + heading[0], place[1] + heading[1], place[2] + heading[2])
                placed.setdefault(place)
            elif symbol == "[":
                stack.append((place, heading))
            elif symbol == "|":
                place, heading = stack[-1]
            elif symbol == "]":
                place, heading = stack.pop()
            elif not symbol.isalpha():
                heading = self.turns[symbol, heading]
        return list(placed)


def stood(internal: list[Cell], lattice: Lattice, growth: object) -> tuple[list[Cell], list[Cell], list[Cell]]:
    """The three systems of a body."""
    given = [] if growth.supports is None else sorted(growth.supports)
    skeleton = [cell for cell in dict.fromkeys(internal) if cell not in given]
    level = growth.ground_level if growth.ground == "fixed" else min(z for _, _, z in skeleton)
    beneath = lattice.offsets[lattice.beneath].tolist()
    boundary = given
    if growth.supports is None:
        feet = {(x + a, y + b, z + c) for x, y, z in skeleton if z == level for a, b, c in beneath}
        boundary = sorted(feet - set(skeleton))
    taken = {*skeleton, *boundary}
    around = {cell: [tuple(int(c) for c in near) for near in lattice.offsets + np_cell(cell)] for cell in skeleton}
    few = [cell for cell in skeleton if sum(near in taken for near in around[cell]) < growth.envelope_below]
    free = {near for cell in few for near in around[cell]} - taken
    if growth.supports is None:
        free = {cell for cell in free if cell[2] >= level}
    return skeleton, sorted(free) if growth.envelope else [], boundary


def np_cell(cell: Cell) -> object:
    import numpy as np

    return np.array(cell)
