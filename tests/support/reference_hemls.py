"""HEMLS growth once more, from the specification alone: what the compiled engine must equal.

Plain lists, dictionaries and floats, and another picture of the map than the engine's (see ``reference_map``). No
forces, no boundaries. Where the specification is silent, a comment says what the engine does.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from reference_map import Map
from reference_turtle import Drawing, Frame, draw, plus, times

from growth.hemls.rules import Rule, System


class Growth:
    def __init__(self, system: System, scale: float) -> None:
        self.system, self.scale = system, scale
        self.map = Map(system.axiom)
        self.drawings = {rule: draw(rule.successor, system.angle) for rule in system.rules}

    def choose(self, number: int, rules: Sequence[Rule]) -> Rule | None:
        """Choose the rule with most matching context, of equal ones the first."""
        edge = self.map.edges[number]
        best, most = None, -1
        for rule in rules:
            known = 0
            for wanted, vertex in ((rule.before, edge.start), (rule.after, edge.end)):
                near = [self.map.edges[other].label for other, _ in self.map.leaving[vertex] if other != number]
                known += 0 if wanted is None else 1 if wanted in near else -9
            if known > most:
                best, most = rule, known
        return best

    def step(self) -> None:
        m = self.map
        total = (0.0, 0.0, 0.0)
        for point in m.points.values():
            total = plus(total, point)
        centre = times(total, 1 / len(m.points))
        for vertex, point in m.points.items():
            m.points[vertex] = plus(point, plus(point, centre, -1), self.scale - 1)
        present = sorted(m.edges)
        labels = list(dict.fromkeys(rule.label for rule in self.system.rules))
        made: set[int] = set()
        if self.system.sync:
            plans = [plan for label in labels for plan in self.plan(label, present)]
            self.apply(plans)
            m.join_all(self.system.branch_angle)
        else:
            for label in labels:
                plans = self.plan(label, [number for number in sorted(m.edges) if number not in made])
                made.update(self.apply(plans))
                m.join_all(self.system.branch_angle)
        m.prune()

    def plan(self, label: int, numbers: Sequence[int]) -> list[tuple[int, Drawing, Frame]]:
        rules = [rule for rule in self.system.rules if rule.label == label]
        plans = []
        for number in numbers:
            rule = self.choose(number, rules) if self.map.edges[number].label == label else None
            if rule is not None:
                plans.append((number, self.drawings[rule], self.map.frame(number)))
        return plans

    def apply(self, plans: Sequence[tuple[int, Drawing, Frame]]) -> list[int]:
        """Rewrite all planned edges, then place their brackets; give the edges that rewriting made."""
        first = self.map.next_edge
        bracketed = [drawn for plan in plans for drawn in self.map.rewrite(*plan)]
        self.map.place(bracketed)
        return [number for number, _, _ in plans] + list(range(first, self.map.next_edge))


def reference_maps(system: System, steps: int, scale: float) -> Iterator[Map]:
    """Give the map after each step, the seed first; it is one map that changes as the next is asked for."""
    growth = Growth(system, scale)
    yield growth.map
    for _ in range(steps):
        growth.step()
        yield growth.map


def reference_counts(system: System, steps: int, scale: float = 1.5) -> list[tuple[int, int, int]]:
    """Count vertices, edges and regions after each step, the seed first."""
    return [m.counts() for m in reference_maps(system, steps, scale)]
