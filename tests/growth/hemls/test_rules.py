"""The parser of ``.hemls`` files: what it reads, and what it says of what it cannot read."""

from __future__ import annotations

import pytest
from hypothesis import given
from strategies import systems

from genome.errors import InputError
from growth.hemls.rules import Segment, parse_system

SQUARE = "A + B + A + B\nA -> A [ [ + B ] - B ] A\nB -> B [ [ + A ] - A ] B\nAngle 90\nBranchAngle 90\n"


def test_the_square_system_is_read_whole() -> None:
    system = parse_system(SQUARE)
    assert system.labels == ("A", "B")
    assert [segment.label for segment in system.axiom] == [0, 1, 0, 1]
    assert (system.angle, system.branch_angle, system.sync) == (90.0, 90.0, False)
    assert system.rules[1].successor == (
        Segment(1), "[", "[", "+", Segment(0), "]", "-", Segment(0), "]", Segment(1),
    )  # fmt: skip


def test_line_ends_semicolons_spaces_and_comments_do_not_matter() -> None:
    crowded = "A+B+A+B;A->A[[+B]-B]A;B->B[[+A]-A]B;Angle 90;BranchAngle 90 # the end"
    spread = SQUARE.replace("\n", "\r\n# a comment ; with a semicolon\n\n")
    assert parse_system(crowded) == parse_system(SQUARE) == parse_system(spread)


def test_edge_names_are_numbers_not_spellings() -> None:
    system = parse_system("Edge0 + Edge01 + E2\nEdge1 -> Edge1 E0\nAngle 30\nBranchAngle 30")
    assert system.labels == ("Edge0", "Edge1", "Edge2")


def test_a_list_of_predecessors_is_a_rule_for_each() -> None:
    system = parse_system("A + B + C\nB A B -> C\nC -> C C\nAngle 30\nBranchAngle 30")
    assert [rule.label for rule in system.rules] == [1, 0, 2]


@pytest.mark.parametrize(
    ("predecessor", "expected"),
    [("A < B", (1, 0, None)), ("A > B", (0, None, 1)), ("A < B > C", (1, 0, 2)), ("B", (1, None, None))],
)
def test_context(predecessor: str, expected: tuple[int, int | None, int | None]) -> None:
    rule = parse_system(f"A + B + C\n{predecessor} -> A A\nAngle 30\nBranchAngle 30").rules[0]
    assert (rule.label, rule.before, rule.after) == expected


def test_a_tilde_reverses_the_next_segment_only() -> None:
    # Figure 4 writes the axiom's reversal before the '+'.
    assert parse_system("A ~ + B + A\nA -> A\nAngle 30\nBranchAngle 30").axiom[1].reversed
    system = parse_system("~ A + B + ~~ A\nA -> ~ + A B [ ~ ] A [ ~ B ]\nAngle 30\nBranchAngle 30")
    assert [segment.reversed for segment in system.axiom] == [True, False, False]
    flips = [symbol.reversed for symbol in system.rules[0].successor if isinstance(symbol, Segment)]
    assert flips == [True, False, False, True]


BAD = {
    "": "f: expected an axiom such as 'A + B + A + B', got an empty file; write one",
    "A + B": "f:1:1: expected at least three edges in the axiom, got 2; the seed is a polygon",
    "A + B + ": "f:1:8: expected an edge after '+', got the end of the line",
    "A + B + A ~": "f:1:12: expected an edge after '~', got the end of the line",
    "A + B - A": "f:1:7: expected '+' or the end of the axiom, got '-'",
    "A + B + a": "f:1:9: expected an edge, a turtle command or a keyword, got 'a'",
    "A + B + A\nA -> [ B": "f:2:6: expected a ']' for this '[', got '['; brackets must balance",
    "A + B + A\nA -> B ] [": "f:2:8: expected a '[' before this ']', got ']'",
    "A + B + A\nA ->": "f:2:5: expected a successor, got the end of the line",
    "A + B + A\n-> A": "f:2:1: expected an edge before '->', got '->'",
    "A + B + A\nA B": "f:2:4: expected '->' in a rule, got the end of the line",
    "A + B + A\nA < B < A -> A": (
        "f:2:1: expected 'A', 'A B', 'A < B', 'B > C' or 'A < B > C' before '->', got 'A < B < A'"
    ),
    "A + B + A\nA -> B -> A": "f:2:8: expected one '->' a rule, got '->'",
    "A + B + A\nA -> + -": "f:2:6: expected at least one edge in a successor, got '+'",
    "A + B + A\nA -> B 4": "f:2:8: expected an edge or a turtle command",
    "A + B + A\nA -> B Weight 4": "f:2:8: expected an edge, a turtle command or a keyword, got 'Weight'",
    "A + B + A\nA -> EdgeY": "f:2:6: expected an edge, a turtle command or a keyword, got 'EdgeY'; bound edges are",
    "A + B + A\nA -> Edge": "f:2:6: expected an edge, a turtle command or a keyword, got 'Edge'",
    "A + B + A\nA -> A\nAngle": "f:3:6: expected a number of degrees, got the end of the line",
    "A + B + A\nA -> A\nAngle 91": "f:3:7: expected degrees within 0 and 90, got '91'",
    "A + B + A\nA -> A\nAngle 9\nAngle 9": "f:4:1: expected 'Angle' once, got 'Angle'",
    "A + B + A\nA -> A\nSync\nSync": "f:4:1: expected 'Sync' once",
    "A + B + A\nA -> A\nSync 3": "f:3:6: expected nothing after 'Sync', got '3'",
    "A + B + A\nA -> A\nAngle 4 5": "f:3:9: expected nothing after 'Angle 4', got '5'",
    "A + B + A\nA -> A\nAngle 4": "f: expected a line 'BranchAngle <degrees>', got none; add the line",
    "A + B + A\nAngle 4\nBranchAngle 3": "f: expected at least one rule such as 'A -> A A', got none; add a rule",
    "A + B + A\nA -> A\nAngle nan": "f:3:7: expected an edge, a turtle command or a keyword, got 'nan'",
    "A + B + A\nA -> " + "[" * 101 + "A" + "]" * 101: "f:2:106: expected at most 100 brackets inside each other",
}


@pytest.mark.parametrize("text", BAD)
def test_bad_files_name_line_column_expected_and_got(text: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_system(text, "f")
    assert str(caught.value).startswith(BAD[text])


@given(systems())
def test_every_generated_system_is_read(text: str) -> None:
    assert len(parse_system(text).rules) >= 1
