"""Grammatical evolution as plain recursion over the grammar: what the compiled mapper must equal."""

from __future__ import annotations

from collections.abc import Sequence

from genome.grammar import Alternatives, Grammar, NonTerminal, Option, Terminal, least_depths, shortest
from genome.grammar import Sequence as Items
from genome.program import Labels


class OutOfGenesError(Exception):
    """The genome was read as often as it may be."""


class TooLongError(Exception):
    """The text grew past its limit."""


class ReferenceMapper:
    def __init__(
        self,
        grammar: Grammar,
        labels: Labels | None = None,
        max_depth: float = float("inf"),
        wraps: int = 3,
        max_tokens: int = 100_000,
    ) -> None:
        self.grammar = grammar
        self.plan = labels
        self.depths = least_depths(grammar.rules)
        self.max_depth = max_depth
        self.wraps = wraps
        self.max_tokens = max_tokens

    def map(self, genes: Sequence[int], symbol: str | None = None, depth: int = 0, reads: int = 0) -> str:
        self.genes = genes
        self.reads = reads
        self.labels = self.plan.first if self.plan else 0
        self.out: list[str] = []
        self.expand(symbol or self.grammar.start, depth)
        return " ".join(self.out)

    def gene(self) -> int:
        if self.reads == len(self.genes) * (self.wraps + 1):
            raise OutOfGenesError
        self.reads += 1
        return self.genes[(self.reads - 1) % len(self.genes)]

    def write(self, token: str) -> None:
        if len(self.out) == self.max_tokens:
            raise TooLongError
        self.out.append(token)

    def label(self) -> int:
        found = self.gene() % (self.labels + 1)
        self.labels = max(self.labels, found + 1)
        return found

    def choose(self, alternatives: Alternatives, depth: int) -> Items:
        gene = self.gene()
        if depth >= self.max_depth - 1:
            short = shortest(alternatives, self.depths)
            return alternatives[short[gene % len(short)]]
        return alternatives[gene % len(alternatives)]

    def expand(self, symbol: str, depth: int) -> None:
        self.sequence(self.choose(self.grammar.rules[symbol], depth), depth, {})

    def group(self, alternatives: Alternatives, depth: int, bound: dict[str, int]) -> None:
        chosen = alternatives[0] if len(alternatives) == 1 else self.choose(alternatives, depth)
        self.sequence(chosen, depth, bound)

    def sequence(self, items: Items, depth: int, bound: dict[str, int]) -> None:
        for item in items:
            if isinstance(item, Terminal):
                self.terminal(item.text, bound)
            elif isinstance(item, NonTerminal):
                self.expand(item.name, depth + 1)
            elif isinstance(item, Option):
                if self.gene() % 2 == 1:
                    self.group(item.alternatives, depth, bound)
            else:
                counter = 0
                while self.gene() % (counter + 2) > counter:
                    self.group(item.alternatives, depth, bound)
                    counter += 1

    def terminal(self, text: str, bound: dict[str, int]) -> None:
        if self.plan and text == self.plan.name:
            self.write(f"{text}{self.label()}")
        elif self.plan and text in self.plan.bound:
            if text not in bound:
                bound[text] = self.label()
            self.write(f"{self.plan.name}{bound[text]}")
        else:
            self.write(text)

    def map_with_repair(self, genes: Sequence[int], successor: str, depth: int) -> tuple[str, list[int]]:
        """Genr8's text: a rule for each label without one, behind the last rule."""
        lines = [line.strip() for line in self.map(genes).split(";") if line.strip()]
        ruled: set[str] = set()
        for line in lines:
            predecessor, arrow, _ = line.partition("->")
            if arrow:
                ruled.update(predecessor.split("<")[-1].split(">")[0].split())
        repaired = []
        place = max((i for i, line in enumerate(lines) if "->" in line), default=0) + 1
        label = 0
        while label < self.labels:
            if f"Edge{label}" not in ruled:
                before = len(self.out)
                self.expand(successor, depth)
                lines.insert(place + len(repaired), f"Edge{label} -> {' '.join(self.out[before:])}")
                repaired.append(label)
            label += 1
        return "\n".join(lines) + "\n", repaired
