"""Genr8's use of grammatical evolution: a genome becomes the text of a `.hemls` rule file.

The general mapper writes the sentence; this module adds what is particular to Genr8 (Hemberg 2006, section 5.1): the
grammar that is shipped, the profile ``paper``, and the repair that gives every label a rule.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, replace
from importlib import resources
from itertools import chain
from pathlib import Path
from typing import Literal

from pydantic import Field

from genome import _kernels
from genome.bnf import parse_bnf
from genome.errors import InputError
from genome.grammar import Grammar, Item, Option, Repeat, Terminal, non_terminals, terminals
from genome.mapping import NO_GENES, Mapper, Unmapped, gene_array, unmapped
from genome.program import Labels, compile_grammar
from genome.settings import Settings, near

Profile = Literal["default", "paper"]
SUCCESSOR = "Successor"
"""The non-terminal that repair expands."""


class Genr8Genome(Settings):
    """The settings under ``genome:`` of an island of surfaces."""

    grammar: str = "genr8"
    """A shipped grammar's name, or the path of a `.bnf` file."""
    length: int = Field(default=200, ge=2, le=1_000_000)
    profile: Profile = "default"
    max_depth: int = Field(default=8, ge=1, le=10_000)
    wraps: int = Field(default=3, ge=0, le=1000)
    max_tokens: int = Field(default=2000, ge=1, le=10_000_000)
    gene_ceiling: int = Field(default=1000, ge=2, le=2**53)
    """Genes are integers from 0 up to, and without, this."""
    crossover: Literal["one_point", "two_point"] = "one_point"
    gene_mutation: float = Field(default=0.02, ge=0, le=1)
    """The chance of each gene of a mutated genome to be drawn anew."""

    def mapper(self, base: Path) -> Genr8Mapper:
        """Load the grammar, its path relative to the folder ``base``, and make the mapper that these settings ask for.

        Raises
        ------
        InputError
            See :func:`load_grammar` and :class:`Genr8Mapper`.
        """
        return Genr8Mapper(load_grammar(self.grammar, base), self.profile, self.max_depth, self.wraps, self.max_tokens)


@dataclass(frozen=True, slots=True)
class Mapped:
    """A rule file, and how it came about.

    Attributes
    ----------
    text
        The rule file, one rule a line.
    genes_read
        How many genes were read, repair and genes read again included.
    repaired
        The labels that got their rule by repair, ascending.
    """

    text: str
    genes_read: int
    repaired: tuple[int, ...]


def load_grammar(name_or_path: str, base: Path) -> Grammar:
    """Load a grammar.

    Parameters
    ----------
    name_or_path
        The name of a shipped grammar (``genr8``), or a path, told by its ``.bnf`` ending or a slash in it.
    base
        The folder that a relative path starts from.

    Raises
    ------
    InputError
        Where there is no such grammar or file, or its text is not a grammar.
    """
    if "/" not in name_or_path and not name_or_path.endswith(".bnf"):
        shipped = resources.files("genome") / "grammars"
        names = sorted(entry.name.removesuffix(".bnf") for entry in shipped.iterdir() if entry.name.endswith(".bnf"))
        if name_or_path not in names:
            remedy = f"{near(name_or_path, names)}; a file's name ends in .bnf"
            raise InputError("grammar", "a grammar's name or file", f"'{name_or_path}'", remedy)
        file = f"{name_or_path}.bnf"
        return parse_bnf((shipped / file).read_text(encoding="utf-8"), file)
    path = base / name_or_path
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError, ValueError) as error:
        got = getattr(error, "strerror", None) or "bytes that are not UTF-8"
        raise InputError(
            str(path), "a readable grammar file", got, "check the path, from the experiment's folder"
        ) from None
    return parse_bnf(text, str(path))


class Genr8Mapper:
    """Maps genomes to rule files.

    Parameters
    ----------
    grammar
        A grammar whose sentences are rule files, ``;`` ending each line. One with label terminals must have a
        ``<Successor>``; one without is never repaired.
    profile
        ``paper`` leaves out the ``[ ~ ]`` of the axiom, as the worked example of Hemberg 2006, section 5.2, does.
    max_depth, wraps, max_tokens
        Limits, see :class:`genome.mapping.Mapper`.

    Raises
    ------
    InputError
        For a grammar with label terminals that has no ``<Successor>``.
    """

    def __init__(
        self,
        grammar: Grammar,
        profile: Profile = "default",
        max_depth: int = 8,
        wraps: int = 3,
        max_tokens: int = 2000,
    ) -> None:
        depths = _depths_reached(grammar)
        labels = Labels() if _has_labels(grammar, Labels()) else None
        if labels and SUCCESSOR not in grammar.rules:
            raise InputError(
                grammar.source,
                f"a production <{SUCCESSOR}> (repair expands it)",
                "none",
                "name it so, or add it",
            )
        program = compile_grammar(of_profile(grammar, profile), labels, " ")
        self._arrays = (program.code, program.choices, program.targets, program.letters, program.spans)
        self._start = (program.symbols[grammar.start], 0, 0, labels.first if labels else 0)
        self._repair = (program.symbols.get(SUCCESSOR, 0), depths.get(SUCCESSOR, 1))
        self._limits = (program.bound, max_depth)
        self._wraps = wraps
        self._max_tokens = max_tokens

    def map(self, genes: Sequence[int]) -> Mapped | Unmapped:
        """Map a genome to a rule file's text.

        Parameters
        ----------
        genes
            Integers of 0 or more.

        Returns
        -------
        Mapped or Unmapped
            Unmapped where the genes ran out, in the sentence or in its repair, or the text grew too long.

        Raises
        ------
        InputError
            For genes that are not integers from 0 to 2**63 - 1.
        """
        row = gene_array(genes)
        if not row.size:
            return NO_GENES
        limits = (*self._limits, row.size * (self._wraps + 1), self._max_tokens)
        status, reads, text, labels = _kernels.expand_with_repair(*self._arrays, row, self._start, limits, self._repair)
        repaired = tuple(labels.tolist())
        if status != _kernels.DONE:
            reason = unmapped(status, reads, row.size, self._wraps, self._max_tokens).reason
            return Unmapped(f"{reason}, while repairing Edge{repaired[-1]}" if repaired else reason)
        return Mapped(text.tobytes().decode(), reads, repaired)


def compile_kernels() -> None:
    """Compile the kernels into Numba's cache, so that the first genome of a run need not wait for it."""
    grammar = load_grammar("genr8", Path())
    Genr8Mapper(grammar).map((0,))
    Mapper(grammar).map((0,))


def _has_labels(grammar: Grammar, labels: Labels) -> bool:
    names = {labels.name, *labels.bound}
    sequences = chain.from_iterable(grammar.rules.values())
    return any(word in names for sequence in sequences for word in terminals(sequence))


def _depths_reached(grammar: Grammar) -> dict[str, int]:
    """Give the least depth at which each non-terminal stands below the start symbol, which is at 0."""
    depths = {grammar.start: 0}
    queue = deque([grammar.start])
    while queue:
        name = queue.popleft()
        for sequence in grammar.rules[name]:
            for used in non_terminals(sequence):
                if used not in depths:
                    depths[used] = depths[name] + 1
                    queue.append(used)
    return depths


def of_profile(grammar: Grammar, profile: Profile) -> Grammar:
    """Give the grammar as a profile has it: ``paper`` leaves out the options ``[ ~ ]`` of ``<Axiom>``."""
    if profile == "default" or "Axiom" not in grammar.rules:
        return grammar
    axiom = tuple(_without_turns(sequence) for sequence in grammar.rules["Axiom"])
    return replace(grammar, rules={**grammar.rules, "Axiom": axiom})


def _without_turns(sequence: tuple[Item, ...]) -> tuple[Item, ...]:
    kept: list[Item] = []
    for item in sequence:
        if isinstance(item, (Repeat, Option)):
            if item == Option(((Terminal("~"),),)):
                continue
            kept.append(type(item)(tuple(_without_turns(inner) for inner in item.alternatives)))
        else:
            kept.append(item)
    return tuple(kept)
