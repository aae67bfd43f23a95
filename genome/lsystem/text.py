"""The ``.blocks`` file: its parser and its writer.

One statement a line, ``#`` begins a comment::

    axiom: F
    iterations: 4
    F -> FF[+F|-F] (0.7)
    F -> F&F (0.3)
    G < F > H -> F

``docs/formats/blocks.md`` gives the grammar. Every error names line and column.
"""

from __future__ import annotations

import math
import re
from typing import Final

from genome.errors import InputError
from genome.lsystem.symbols import FORWARD
from genome.lsystem.system import MOST_ITERATIONS, ROUNDING, SEEDS, Head, LSystem, Rule, written_head
from genome.lsystem.word import Word, parse_word

_KEY = re.compile(r"\s*([A-Za-z_]\w*)\s*:")
_HEAD = re.compile(r"\s*(?:([A-Z])\s*<\s*)?([A-Z])(?:\s*>\s*([A-Z]))?\s*")
_CHANCE = re.compile(r"\(([^()]*)\)\s*$")
_ARROW = re.compile(r"->|→")
_KEYS: Final = ("axiom", "iterations", "seed")

_Unshared = tuple[int, Head, float | None, Word]
"""A rule as it stands in the file, with its line; ``None`` where it has no chance of its own."""


def parse_blocks(text: str, name: str = "system") -> LSystem:
    """Parse the text of a ``.blocks`` file.

    Parameters
    ----------
    text
        The file's text.
    name
        The file's name, for messages.

    Returns
    -------
    LSystem
        Rules without a chance share evenly what the others of their head leave of 1.

    Raises
    ------
    InputError
        With ``name:line:column``, for anything that is no L-system, and for one that can never draw.
    """
    return _Parser(name).parse(text)


def format_blocks(system: LSystem) -> str:
    """Write an L-system as the text of a ``.blocks`` file; :func:`parse_blocks` reads an equal one from it.

    A system that can never draw is written as it is, and refused when it is read.
    """
    lines = [f"axiom: {system.axiom}", f"iterations: {system.iterations}"]
    if system.seed:
        lines.append(f"seed: {system.seed}")
    for rule in system.rules:
        share = "" if rule.chance == 1.0 else f" ({rule.chance!r})"
        lines.append(f"{written_head(rule.head)} -> {rule.successor}{share}")
    return "\n".join(lines) + "\n"


class _Parser:
    """Reads one file, line by line."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.axiom: Word | None = None
        self.axiom_line = 1
        self.numbers: dict[str, int] = {}
        self.rules: list[_Unshared] = []

    def parse(self, text: str) -> LSystem:
        for line, written in enumerate(text.split("\n"), 1):
            content = written.partition("#")[0]
            if not content.strip():
                continue
            arrow = _ARROW.search(content)
            key = _KEY.match(content)
            if key is not None and (arrow is None or key.end() <= arrow.start()):
                self._statement(line, content, key)
            elif arrow is not None:
                self._rule(line, content, arrow)
            else:
                raise self._error(line, _start(content), "'axiom: ...', 'iterations: ...' or a rule 'F -> ...'",
                                  f"'{content.strip()[:40]}'")  # fmt: skip
        if self.axiom is None:
            raise InputError(self.name, "a line 'axiom: ...'", "none", "add one, such as 'axiom: F'")
        if "iterations" not in self.numbers:
            raise InputError(self.name, "a line 'iterations: ...'", "none", "add one, such as 'iterations: 4'")
        system = LSystem(self.axiom, self._shared(), self.numbers["iterations"], self.numbers.get("seed", 0))
        if not system.draws:
            expected, remedy = f"rules that lead from this axiom to an {FORWARD}", "a word without one draws nothing"
            raise self._error(self.axiom_line, 0, expected, "none", remedy)
        return system

    def _statement(self, line: int, content: str, key: re.Match[str]) -> None:
        word, start = key.group(1), key.end()
        if word not in _KEYS:
            expected = "'axiom', 'iterations' or 'seed' before a colon"
            raise self._error(line, key.start(1), expected, f"'{word}'")
        if word in self.numbers or (word == "axiom" and self.axiom is not None):
            raise self._error(line, key.start(1), f"'{word}' once", "a second one", "remove it")
        value = content[start:].strip()
        if word != "axiom":
            self.numbers[word] = self._number(line, start, content, word)
            return
        if not value:
            raise self._error(line, len(content.rstrip()), "a word of one symbol or more", "the end of the line")
        self.axiom, self.axiom_line = parse_word(content[start:], self.name, line, start + 1), line

    def _number(self, line: int, start: int, content: str, word: str) -> int:
        value = content[start:].strip()
        end = SEEDS - 1 if word == "seed" else MOST_ITERATIONS
        if not re.fullmatch(r"[0-9]{1,19}", value) or int(value) > end:
            at = start + _start(content[start:])
            raise self._error(line, at, f"a whole number from 0 to {end}", f"'{value}'" if value else "nothing")
        return int(value)

    def _rule(self, line: int, content: str, arrow: re.Match[str]) -> None:
        head = _HEAD.fullmatch(content[: arrow.start()])
        if head is None:
            raise self._error(line, _start(content), "a capital letter before '->', or 'G < F', 'F > H', 'G < F > H'",
                              f"'{content[: arrow.start()].strip()}'")  # fmt: skip
        left, operand, right = head.groups()
        chance: float | None = None
        body = content[arrow.end() :]
        share = _CHANCE.search(body)
        if share is not None:
            chance = self._chance(line, arrow.end() + share.start(1), share.group(1))
            body = body[: share.start()]
        successor = parse_word(body, self.name, line, arrow.end() + 1)
        if not successor.items:
            raise self._error(line, arrow.end(), "a successor of one symbol or more", "none",
                              "a letter that no rule rewrites, such as Z, draws nothing")  # fmt: skip
        self.rules.append((line, (operand, left, right), chance, successor))

    def _chance(self, line: int, at: int, text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not 0.0 < value <= 1.0:
            raise self._error(line, at, "a chance over 0 and up to 1", f"'{text}'")
        return value

    def _shared(self) -> tuple[Rule, ...]:
        """Give the rules that have no chance of their own what the others of their head leave."""
        given: dict[Head, list[float]] = {}
        waiting: dict[Head, int] = {}
        for line, head, chance, _ in self.rules:
            values = given.setdefault(head, [])
            if chance is None:
                waiting[head] = waiting.get(head, 0) + 1
            else:
                values.append(chance)
                if math.fsum(values) > 1.0 + ROUNDING:
                    raise self._error(line, 0, f"chances of {written_head(head)} that add up to 1 at most",
                                      f"{math.fsum(values):.6g} up to this line")  # fmt: skip
        rules = []
        for line, head, chance, successor in self.rules:
            left = 1.0 - math.fsum(given[head])
            if chance is None and left <= ROUNDING:
                raise self._error(line, 0, "a chance left for this rule", "none: the others add up to 1",
                                  "give it one, such as '(0.3)'")  # fmt: skip
            share = left / waiting[head] if chance is None else chance
            rules.append(Rule(*head, share, successor))
        return tuple(rules)

    def _error(self, line: int, at: int, expected: str, got: str, remedy: str = "") -> InputError:
        return InputError(f"{self.name}:{line}:{at + 1}", expected, got, remedy)


def _start(text: str) -> int:
    """Give the place of the first character that is no blank; the end where there is none."""
    return len(text) - len(text.lstrip())
