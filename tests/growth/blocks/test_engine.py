"""Growth of block bodies: words, turtles, foundations and envelopes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lsystem_strategies import systems, words
from reference_blocks import Turtle, derived, stood

from genome.lsystem import LSystem, Word, parse_blocks, parse_word
from genome.lsystem.symbols import ALPHABET
from growth.blocks import BlockGrowth, Body, derive, grow, stand
from growth.blocks.body import BOUNDARY, ENVELOPE, INTERNAL
from growth.blocks.lattice import CUBIC, ISOSPATIAL, LATTICES
from growth.blocks.program import turns_of
from growth.protocol import Failure

NEAR = st.tuples(*[st.integers(-3, 3)] * 3)


def system(text: str) -> LSystem:
    """A system, whether or not it draws, of one iteration where none are told; `;` for line ends."""
    axiom, *lines = text.removeprefix("axiom:").split(";")
    told = [line for line in lines if "iterations" in line]
    rules = [line for line in lines if line not in told]
    whole = parse_blocks("\n".join(["axiom: F", "iterations: 0", *rules]))
    iterations = int(told[0].partition(":")[2]) if told else 1
    return replace(whole, axiom=parse_word(axiom), iterations=iterations)


def word_of(text: str, **growth: object) -> str:
    codes = derive(system(text), BlockGrowth(**growth))
    assert isinstance(codes, np.ndarray)
    return "".join(ALPHABET[code] for code in codes)


def body_of(word: str, **growth: object) -> Body:
    body = grow(LSystem(parse_word(word), (), 0, 0), BlockGrowth(**growth))
    assert isinstance(body, Body)
    return body


@settings(max_examples=200, deadline=None)
@given(systems(), st.integers(0, 4), st.sampled_from((None, 0, 2**63 - 1)))
def test_words_are_those_of_the_plain_reference(given: LSystem, iterations: int, seed: int | None) -> None:
    given = replace(given, iterations=iterations)
    codes = derive(given, BlockGrowth(max_symbols=2000), seed=seed)
    if isinstance(codes, Failure):
        assert codes.reason == "budget"
        shorter = [derived(replace(given, iterations=count), seed) for count in range(iterations + 1)]
        assert max(map(len, shorter)) > 2000
    else:
        assert "".join(ALPHABET[code] for code in codes) == derived(given, seed)


@pytest.mark.parametrize("lattice", sorted(LATTICES))
@settings(max_examples=200, deadline=None)
@given(word=words(8, 3))
def test_bodies_are_those_of_the_plain_reference(lattice: str, word: Word) -> None:
    body = body_of(str(word), lattice=lattice)
    assert body.internal.tolist() == [list(cell) for cell in Turtle(LATTICES[lattice]).walked(str(word))]


@pytest.mark.parametrize("lattice", sorted(LATTICES))
@settings(max_examples=200, deadline=None)
@given(
    cells=st.lists(NEAR, min_size=1, max_size=20),
    supports=st.one_of(st.none(), st.lists(NEAR, min_size=1, max_size=4, unique=True)),
    ground=st.sampled_from(("lowest", "fixed")),
    level=st.integers(-4, 4),
    below=st.integers(1, 27),
    envelope=st.booleans(),
)
def test_what_stands_around_a_skeleton_is_that_of_the_plain_reference(
    lattice: str, cells: list, supports: list | None, ground: str, level: int, below: int, envelope: bool
) -> None:
    of = LATTICES[lattice]
    cells, supports = ([c for c in part or () if not of.parity or sum(c) % 2 == 0] for part in (cells, supports))
    growth = BlockGrowth(
        lattice=lattice, supports=supports or None, ground=ground, ground_level=level, envelope=envelope,
        envelope_below=below,
    )  # fmt: skip
    if not set(cells) - set(supports):
        return
    body = stand(np.array(cells, dtype=np.int64), growth)
    internal, wrap, boundary = stood(cells, of, growth)
    assert body.internal.tolist() == [list(cell) for cell in internal]
    assert body.envelope.tolist() == [list(cell) for cell in wrap]
    assert body.boundary.tolist() == [list(cell) for cell in boundary]
    assert body.systems.tolist() == [INTERNAL] * len(internal) + [ENVELOPE] * len(wrap) + [BOUNDARY] * len(boundary)
    assert len(np.unique(body.cells, axis=0)) == len(body.cells)


def test_f_goes_up_from_a_block_at_the_origin_and_a_cell_is_placed_once() -> None:
    assert body_of("FF").internal.tolist() == [[0, 0, 0], [0, 0, 1], [0, 0, 2]]
    assert body_of("G+Z").internal.tolist() == [[0, 0, 0]]
    assert body_of("F&&&&F").internal.tolist() == [[0, 0, 0], [0, 0, 1]]


@pytest.mark.parametrize(
    ("turn", "to"),
    [
        ("&", [1, 0, 1]), ("^", [-1, 0, 1]), ("£", [0, -1, 1]), ("$", [0, 1, 1]), ("+", [0, 0, 1]), ("%", [0, 0, 1]),
        ("&&", [1, 0, 0]), ("&&+", [1, 1, 0]), ("&&-", [1, -1, 0]), ("&&%", [-1, 0, 0]), ("&&££", [1, 0, 0]),
        ("&&++££", [0, 0, 1]), ("&%", [-1, 0, 1]), ("&&+%", [-1, -1, 0]), ("&+++", [-1, 1, 1]),
    ],
)  # fmt: skip
def test_turns_go_by_eighths_round_the_world_s_axes(turn: str, to: list[int]) -> None:
    assert body_of(f"{turn}F").internal[1].tolist() == to


@pytest.mark.parametrize("lattice", [CUBIC, ISOSPATIAL])
def test_turns_undo_each_other_and_a_full_circle_is_none(lattice: object) -> None:
    turns = turns_of(lattice)
    same = np.arange(len(lattice.offsets))
    for there, back in ((0, 1), (2, 3), (4, 5)):
        np.testing.assert_array_equal(turns[there][turns[back]], same)
        circle = same
        for _ in range(8):
            circle = turns[there][circle]
        np.testing.assert_array_equal(circle, same)
    np.testing.assert_array_equal(turns[6][turns[6]], same)
    half = same
    for _ in range(4 if lattice is CUBIC else 2):
        half = turns[0][half]
    np.testing.assert_array_equal(half, turns[6])


def test_siblings_grow_from_one_point() -> None:
    body = body_of("F[&&F|^^F|G][££F]F")
    assert body.internal.tolist() == [[0, 0, 0], [0, 0, 1], [1, 0, 1], [-1, 0, 1], [0, -1, 1], [0, 0, 2]]


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("axiom: F; iterations: 3; F -> F+G; G -> FF", "F+G+FF+F+GF+G"),
        # The nearest letter on the way to the root; turns do not count, nor do branches passed.
        ("axiom: GF; G < F -> H", "GH"),
        ("axiom: G+%F; G < F -> H", "G+%H"),
        ("axiom: G[X]F; G < F -> H", "G[X]H"),
        ("axiom: G[+F]; G < F -> H", "G[+H]"),
        ("axiom: G[X|F]F; G < F -> H", "G[X|H]H"),
        ("axiom: G[X[F|F]F|F]; G < F -> H", "G[X[F|F]F|H]"),
        ("axiom: F[G]F; G < F -> H", "F[G]F"),
        # The next letter on the same branch.
        ("axiom: FG; F > G -> H", "HG"),
        ("axiom: F[X]-G; F > G -> H", "H[X]-G"),
        ("axiom: F[G]; F > G -> H", "F[G]"),
        ("axiom: X[F|G]G; F > G -> H", "X[F|G]G"),
        ("axiom: X[F[X|F]]G; F > G -> H", "X[F[X|F]]G"),
        ("axiom: X[FG[F]G|F]; F > G -> H", "X[HG[F]G|F]"),
        # Who asks for more goes first; chances are left over to no one else.
        ("axiom: GFX FX GF F; F -> A; F > X -> B; G < F -> C; G < F > X -> H", "GHXBXGCA"),
        ("axiom: GFF; F -> A; F > F -> B; G < F -> C", "GCA"),
        ("axiom: GF; F -> A; G < F -> C (1e-18)", "GF"),
    ],
)
def test_words_by_hand(text: str, word: str) -> None:
    assert word_of(text) == word


def test_chances_are_kept_and_the_seed_decides() -> None:
    text = "axiom: " + "F" * 4000 + "; F -> G (0.5); F -> H (0.2)"
    word = word_of(text)
    counts = [word.count(letter) for letter in "GHF"]
    from scipy.stats import chisquare

    assert chisquare(counts, [2000, 800, 1200]).pvalue > 1e-4
    assert word_of(text) == word
    assert word_of(text + "; seed: 1") != word
    codes = derive(system(text), seed=1)
    assert "".join(ALPHABET[code] for code in codes) == word_of(text + "; seed: 1")


def test_a_rule_for_sure_draws_no_number() -> None:
    """Else a sure rule that is written in would change what chance does elsewhere."""
    rules = "; F -> A (0.5); F -> B (0.5)"
    assert word_of(f"axiom: {'FG' * 40}{rules}; G -> C").replace("C", "") == word_of(f"axiom: {'F' * 40}{rules}")


@pytest.mark.parametrize(
    ("word", "growth", "failure"),
    [
        ("F" * 20, {"max_symbols": 19}, "budget: the axiom has 20 symbols where max_symbols allows 19"),
        ("F" * 20, {"max_blocks": 20}, "budget: more blocks than the 20 that max_blocks allows"),
        ("Z", {"supports": [[0, 0, 0]]}, "boundary: every block lies in a support"),
    ],
)
def test_what_goes_beyond_the_budget_is_a_failure(word: str, growth: dict, failure: str) -> None:
    got = grow(LSystem(parse_word(word), (), 0, 0), BlockGrowth(**growth))
    assert isinstance(got, Failure)
    assert str(got) == failure
    wider = {key: value + 1 for key, value in growth.items() if isinstance(value, int)}
    if wider:
        assert isinstance(grow(LSystem(parse_word(word), (), 0, 0), BlockGrowth(**wider)), Body)


def test_exponential_rewriting_ends_in_a_failure_before_it_takes_memory() -> None:
    got = grow(system("axiom: F; iterations: 1000; F -> FF"))
    assert str(got) == "budget: iteration 16 makes 65536 symbols where max_symbols allows 50000"


def test_the_clock_ends_a_growth() -> None:
    times = iter(range(0, 1000, 20))
    got = grow(system("axiom: F; iterations: 50; F -> F"), BlockGrowth(), lambda: float(next(times)))
    assert str(got) == "clock: the growth took longer than max_seconds"


def test_bodies_miss_a_fixed_ground_and_stand_on_supports() -> None:
    fixed = body_of("FF", ground="fixed", ground_level=1)
    assert fixed.boundary.tolist() == []  # beneath the one block at that level is another
    assert body_of("FF", ground="fixed", ground_level=7).boundary.tolist() == []
    assert body_of("FF&&F", ground="fixed", ground_level=2).boundary.tolist() == [[1, 0, 1]]
    held = body_of("FF", supports=[[1, 0, 2], [0, 0, 1]])
    assert held.internal.tolist() == [[0, 0, 0], [0, 0, 2]]
    assert held.boundary.tolist() == [[0, 0, 1], [1, 0, 2]]


def test_a_column_is_wrapped_at_its_tip() -> None:
    body = body_of("FFF", envelope=True)
    tip = {(x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (2, 3, 4)} - {(0, 0, 3), (0, 0, 2)}
    assert {tuple(cell) for cell in body.envelope.tolist()} == tip
    assert body.boundary.tolist() == [[0, 0, -1]]
    single = body_of("Z", envelope=True)
    assert len(single.envelope) == 17
    assert single.envelope[:, 2].min() == 0
