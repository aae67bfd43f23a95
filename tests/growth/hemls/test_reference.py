"""The engine against a second reading of the specification (tests/support/reference_hemls.py), step by step."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from reference_hemls import reference_counts, reference_maps
from reference_map import Map
from strategies import systems

from genome.genr8 import Genr8Mapper, Mapped, load_grammar
from genome.integers import random_genes
from growth.hemls import SurfaceGrowth, derive, parse_system
from growth.hemls.map import HalfEdgeMap
from growth.protocol import Failure

SYSTEMS = Path(__file__).parents[3] / "experiments" / "systems"
SQUARE = (SYSTEMS / "square.hemls").read_text()
TRIANGLE = (SYSTEMS / "triangle.hemls").read_text()
TABLE = {
    "square": (SQUARE, [(4, 4, 1), (9, 12, 4), (25, 40, 16), (81, 144, 64), (289, 544, 256)]),
    "square with Sync": (SQUARE + "Sync\n", [(4, 4, 1), (8, 9, 2), (17, 20, 4), (37, 44, 8), (81, 96, 16)]),
    "triangle": (TRIANGLE, [(3, 3, 1), (6, 9, 4), (15, 30, 16), (45, 108, 64), (153, 408, 256)]),
}
HAND = {
    "hexagon": """A + B + C + A + B + C
        A -> A [ [ + B ] - B ] A
        B -> B [ [ + C ] - C ] B
        C -> C [ [ + A ] - A ] A
        Angle 60; BranchAngle 75""",
    "pentagon, reversals": """A + A + ~ B + A + B
        A -> A [ [ + A ] - A ] ~ B
        B -> B [ [ + A ] - A ] + A - A
        Angle 45; BranchAngle 60""",
    "pentagon, contexts": """A + B + A + C + B
        A < B > C -> B [ [ + A ] - A ] B
        B -> A [ [ + A ] - A ] A
        A < A -> A B
        A > B -> B [ [ + B ] - B ] A
        A -> A [ [ + C ] - C ] C
        Angle 60; BranchAngle 80""",
    "chains that meet": """A + A + A + A
        A -> A [ [ + B A ] - B A ] A
        B -> B [ + A + A ] B
        Angle 90; BranchAngle 90""",
    "chains that branch": """A + A + A + A + A + A
        A -> A [ + B [ + A ] - A ] [ - B [ + A ] - A ] A
        Angle 30; BranchAngle 75""",
    "a bracket that goes on from another's last segment": """A + A + A + A
        A -> A [ + B [ + A ] ] [ - B [ + A ] ] A
        B -> B [ [ + A ] - A ] B
        Angle 45; BranchAngle 75""",
    "a branch back along its chain": """A + A + A
        A -> A [ + A + + B [ + B ] ] [ - A - - B ] A
        B -> A [ [ + A + + A ] - A + + A ] B
        Angle 90; BranchAngle 90""",
    "out of the plane": """A + B + A + B
        A -> A & B ^ A [ [ + B ] - B ] A
        B -> B \\ [ + A ] / [ \\ - A ] B
        Angle 30; BranchAngle 75""",
    "upright edges": """A + B + A + B
        A -> A ^ B & [ + A ] [ - A ] A & B ^ A [ [ + A ] - A ]
        B -> B [ + B ] [ - B ] B
        Angle 90; BranchAngle 90""",
    "reversals": """~ A + B + ~ A + B
        A -> ~ A + ~ B - A [ [ + + B ] - - B ] A
        B -> ~ B [ [ + + ~ A ] - - ~ A ] B
        Angle 30; BranchAngle 75""",
    "a list of predecessors": """A + B + A + B
        A B -> A [ [ + C ] - C ] B
        C -> C C
        Angle 90; BranchAngle 90""",
    "a path that comes back": """A + A + A + A
        A -> A + + A [ + A ] [ - A ]
        Angle 90; BranchAngle 60""",
    "edges kept": """A + A + A + A + A
        A -> [ + B ] [ - B ]
        B -> B [ [ + A ] - A ] B
        Angle 45; BranchAngle 60""",
    "half a turn": """A + A + A
        A -> + + A [ + A ] [ - A ] A
        Angle 90; BranchAngle 60""",
    "twin branches": """B + A + A + B + A + B
        A -> B [ + B ] [ + B ] [ + A ] [ - B ] [ - B ] [ - A ] B
        B -> B [ [ + B ] - A ] A
        Angle 90; BranchAngle 60""",
    "joined edges on edges": """~ B + ~ B + A + A + ~ A
        A -> [ + B ] [ - B ] A
        B -> ~ A [ + + A ] [ - - A ] A
        Angle 45; BranchAngle 75""",
    "regions without area": """A + B + ~ A
        A -> A & A [ & + A ] [ & - A ] ^ A [ & + A ] [ & - A ]
        B -> [ + A ] [ - A ] B
        Angle 15; BranchAngle 80""",
    "joined edges that leave their corners": """A + B + ~ A + B + ~ B + A
        B -> [ + B ] [ - B ] A + A - - A + A
        A -> B [ + B ] [ + B ] [ - B ] [ - B ] A
        Angle 30; BranchAngle 90""",
    "pairs of branches with the same ends": """A + B + ~ A + B + ~ B + A + B
        A -> A + B [ & + C ] [ & - C ] - A
        C -> B [ [ [ [ + B ] + + B ] - B ] - - B ] A [ [ [ [ + B ] + + B ] - B ] - - B ] B
        B -> A [ + C B ] [ - B C ] B
        Angle 60; BranchAngle 90""",
    "a later edge along a branch": """A + B + B + B
        A -> [ + + C ] A
        B -> + A [ + + C ] [ + + + C ] [ + C ] - - A
        Angle 30; BranchAngle 90""",
    "upright edges at a crossing": """A + B + A + B + B + B
        A -> B ^ [ + B B ] [ - B ] A & [ - A ] B [ - A ] & A ^ A [ + B ^ B ]
        B -> B B [ + A ] [ - A ]
        Angle 90; BranchAngle 90""",
    "older branches beside newer chains": """~ B + ~ A + A + B
        A -> A & B [ & + B ] [ & - B ] ^ A [ & + B ] [ & - B ]
        B -> A & A [ + B [ + B ] ] [ - ~ B [ + B ] ] ^ A [ + B [ + B ] ] [ - ~ B [ + B ] ]
        A > B -> A [ + B ] [ - B ] B [ + B ] [ - B ] A
        Angle 90; BranchAngle 90""",
}

DENSE = (
    "[ [ + {0} ] - {1} ]",
    "[ [ [ [ + {0} ] + + {1} ] - {1} ] - - {0} ]",
    "[ + {0} ] [ + {1} ] [ - {0} ] [ - {1} ]",
    "[ + {0} {1} ] [ - {1} {0} ]",
    "[ + {0} [ + {1} ] ] [ - ~ {0} [ + {1} ] ]",
    "[ & + {0} ] [ \\ - {0} ]",
    "[ + {0} + {1} + {0} ] [ - {0} ]",
)
"""Brackets that leave many branches to join."""


def edges_of(m: HalfEdgeMap) -> list[tuple[int, int, int]]:
    ends = m.origin[: 2 * m.edges].reshape(-1, 2).tolist()
    return [(start, end, label) for (start, end), label in zip(ends, m.label[: m.edges].tolist(), strict=True)]


def loops_of(m: HalfEdgeMap) -> list[tuple[int, ...]]:
    loops, seen = [], set()
    for first in range(2 * m.edges):
        h, loop = first, []
        while h not in seen:
            seen.add(h)
            loop.append(h)
            h = int(m.next[h])
        if loop and m.face[first] >= 0:
            loops.append(from_least(loop))
    return sorted(loops)


def from_least(loop: Sequence[int]) -> tuple[int, ...]:
    turn = loop.index(min(loop))
    return (*loop[turn:], *loop[:turn])


def edges_and_loops(m: Map) -> tuple[list[tuple[int, int, int]], list[tuple[int, ...]]]:
    """Give what ``edges_of`` and ``loops_of`` give, from the reference's map, whose numbers have gaps."""
    vertex = {number: place for place, number in enumerate(sorted(m.points))}
    edge = {number: place for place, number in enumerate(sorted(m.edges))}
    edges = [(vertex[m.edges[n].start], vertex[m.edges[n].end], m.edges[n].label) for n in sorted(m.edges)]
    loops = [[2 * edge[n] + (not ahead) for n, ahead in darts] for region, darts in m.regions.items() if region]
    return edges, sorted(from_least(loop) for loop in loops)


def agreed_steps(text: str, steps: int, most: int) -> int:
    """Assert that both grow the same map, number by number; give the steps made before the budget ended."""
    system = parse_system(text)
    made = -1
    reference = reference_maps(system, steps, 1.5)
    for m in derive(system, SurfaceGrowth(steps=steps, max_elements=most, max_pairs=20_000)):
        if isinstance(m, Failure):
            return made
        made += 1
        expected = next(reference)
        assert (m.vertices, m.edges, m.faces) == expected.counts(), (made, text)
        edges, loops = edges_and_loops(expected)
        assert edges_of(m) == edges, (made, text)
        assert loops_of(m) == loops, (made, text)
        points = np.array([expected.points[number] for number in sorted(expected.points)])
        np.testing.assert_allclose(m.points[: m.vertices], points, rtol=0, atol=1e-7, err_msg=text)
    return made


@pytest.mark.parametrize("name", TABLE)
def test_reference_gives_the_counts_of_the_table(name: str) -> None:
    text, counts = TABLE[name]
    assert reference_counts(parse_system(text), 4) == counts
    assert agreed_steps(text, 4, 3000) == 4


@pytest.mark.parametrize("sync", [False, True])
@pytest.mark.parametrize("name", HAND)
def test_chosen_systems_grow_alike(name: str, sync: bool) -> None:
    assert agreed_steps(HAND[name] + ("\nSync" if sync else ""), 3, 3000) >= 2


@settings(max_examples=400, derandomize=True, deadline=None)
@given(systems())
def test_any_system_grows_alike(text: str) -> None:
    assert agreed_steps(text, 3, 400) >= 0


def test_systems_that_the_genr8_grammar_writes_grow_alike() -> None:
    rng = np.random.default_rng(2006)
    mapper = Genr8Mapper(load_grammar("genr8", Path()))
    steps = []
    while len(steps) < 150:
        mapped = mapper.map(random_genes(rng, 200, 1000))
        if isinstance(mapped, Mapped):
            steps.append(agreed_steps(mapped.text, 3, 500))
    assert steps.count(3) > 50


def dense_system(rng: np.random.Generator) -> str:
    """Write a system whose every edge leaves branches."""
    labels = "ABC"[: rng.integers(2, 4)]

    def edge() -> str:
        return ("~ " if rng.random() < 0.2 else "") + labels[rng.integers(len(labels))]

    lines = [" + ".join(edge() for _ in range(rng.integers(3, 8)))]
    for label in labels:
        brackets = DENSE[rng.integers(len(DENSE))].format(edge(), edge())
        turn, back = (("", ""), ("", ""), ("+", "-"), ("&", "^"))[rng.integers(4)]
        lines.append(f"{label} -> {edge()} {turn} {edge()} {brackets} {back} {edge()}")
        if rng.random() < 0.3:
            lines.append(f"{label} > {edge()[-1]} -> {brackets} {edge()} {brackets}")
    sync = ("", "Sync\n")[rng.integers(2)]
    angles = f"Angle {rng.choice((15, 30, 45, 60, 90))}\n{sync}BranchAngle {rng.choice((45, 60, 75, 90))}\n"
    return "\n".join(lines) + "\n" + angles


def test_systems_with_many_branches_grow_alike() -> None:
    rng = np.random.default_rng(1968)
    steps = [agreed_steps(dense_system(rng), 3, 300) for _ in range(120)]
    assert steps.count(2) + steps.count(3) > 60
