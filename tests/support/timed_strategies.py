"""Hypothesis strategies for expressions and timed systems."""

from __future__ import annotations

from hypothesis import strategies as st

from genome.timed import (
    Binary,
    Birth,
    Call,
    Define,
    Development,
    Equiv,
    Expression,
    Formal,
    Name,
    Number,
    Production,
    Section,
    Sheet,
    TimedSystem,
    Unary,
)
from genome.timed.expression import BINDING, FUNCTIONS

SYMBOLS = ("A", "B", "C")
SMALL = st.sampled_from((0.0, 0.25, 0.5, 1.0, 2.0, 3.0, 0.1, 7.5)).map(Number)
NUMBERS = st.one_of(SMALL, st.floats(0.0, 1e300).map(Number))
DETERMINED = tuple(name for name in FUNCTIONS if name not in ("random", "normal", "besselj", "if"))


def expressions(
    names: tuple[str, ...],
    functions: tuple[str, ...] = DETERMINED,
    numbers: st.SearchStrategy = NUMBERS,
    leaves: int = 8,
) -> st.SearchStrategy[Expression]:
    """Any expression over these names."""
    leaf = st.one_of(numbers, st.sampled_from(names).map(Name)) if names else numbers

    def larger(inner: st.SearchStrategy[Expression]) -> st.SearchStrategy[Expression]:
        calls = [
            st.tuples(*[inner] * FUNCTIONS[name]).map(lambda given, name=name: Call(name, given)) for name in functions
        ]
        return st.one_of(
            st.builds(Unary, st.sampled_from("-!"), inner),
            st.builds(Binary, st.sampled_from((*BINDING, "^")), inner, inner),
            st.builds(lambda *given: Call("if", given), inner, inner, inner),
            *calls,
        )

    return st.recursive(leaf, larger, max_leaves=leaves)


@st.composite
def systems(draw: st.DrawFn, contexts: bool = False, random: bool = False) -> TimedSystem:
    """A system of the symbols A(x), B and C(x, y), tame enough that most of them grow."""
    arity = {"A": ("x",), "B": (), "C": ("x", "y")}
    ends = {symbol: Number(draw(st.sampled_from((0.3, 0.5, 0.7, 1.0, 1.5)))) for symbol in SYMBOLS}
    if draw(st.booleans()):
        ends["A"] = Call("max", (Number(0.4), Call("min", (Name("x"), Number(2.0)))))

    def value(names: tuple[str, ...]) -> Expression:
        if random and draw(st.integers(0, 3)) == 0:
            return Call("random", (Number(0.0), Number(2.0)))
        return draw(expressions(names, ("min", "max", "sin", "abs"), SMALL, 3))

    def born(names: tuple[str, ...]) -> Birth:
        symbol = draw(st.sampled_from(SYMBOLS))
        age = draw(st.sampled_from((0.0, 0.0, 0.0, 0.1, 0.25, 0.6)))
        return Birth(symbol, tuple(value(names) for _ in arity[symbol]), Number(age))

    def word(names: tuple[str, ...], least: int) -> tuple[Birth, ...]:
        births = [born(names) for _ in range(draw(st.sampled_from((least, 1, 2, 2, 3))))]
        if births and draw(st.booleans()):
            births = [Birth("["), *births, Birth("]"), Birth("+", (Number(30.0),))]
        return tuple(births)

    productions = []
    for symbol in draw(st.lists(st.sampled_from(SYMBOLS), min_size=2, max_size=6)):
        left = right = None
        if contexts and draw(st.booleans()):
            left, right = (_context(draw, arity, letter) for letter in "pq")
        own = Formal(symbol, arity[symbol])
        names = own.parameters + sum((side.parameters for side in (left, right) if side), ())
        condition = draw(expressions(names, ("min",), SMALL, 3)) if draw(st.integers(0, 2)) == 0 else None
        chance = draw(st.none() | st.sampled_from((0.3, 0.5)).map(Number)) if random else None
        productions.append(Production(own, ends[symbol], word(names, 0), left, right, condition, chance))
    developments = []
    for symbol in draw(st.lists(st.sampled_from(SYMBOLS), unique=True, max_size=3)):
        names = (*arity[symbol], "age")
        developments.append(Development(symbol, names, draw(expressions(names, ("sin", "min"), SMALL, 3))))
    return TimedSystem(word((), 1), tuple(_chanced(productions)), tuple(developments), ignored=("+",))


def _context(draw: st.DrawFn, arity: dict[str, tuple[str, ...]], letter: str) -> Formal | None:
    symbol = draw(st.sampled_from((*SYMBOLS, None)))
    return None if symbol is None else Formal(symbol, tuple(letter + name for name in arity[symbol]))


def _chanced(productions: list[Production]) -> list[Production]:
    """Leave out productions with which chances of one head would add up to more than 1."""
    kept: list[Production] = []
    for one in productions:
        alike = [o for o in kept if (o.predecessor, o.left, o.right, o.condition) ==
                 (one.predecessor, one.left, one.right, one.condition)]  # fmt: skip
        if sum(o.chance.value for o in alike if isinstance(o.chance, Number)) <= 0.5:
            kept.append(one)
    return kept


@st.composite
def written_systems(draw: st.DrawFn) -> TimedSystem:
    """Any system that a file can hold, with all kinds of statements, whether or not it can grow."""
    system = draw(systems(contexts=True, random=True))
    defines = (Define("K", draw(expressions((), numbers=SMALL))), Define("L", draw(expressions(("K",), numbers=SMALL))))
    inner = TimedSystem(
        (Birth("A", (Name("u"),), draw(expressions(("u", "K"), numbers=SMALL))), Birth("D")),
        (Production(Formal("D"), Name("L"), (Birth("A", (Name("K"),)),)),),
        name="part",
        parameters=("u",),
    )
    axiom = (*system.axiom, Birth("part", (draw(expressions(("L",))),), Name("K")))
    equivs = (Equiv("f", "A"), Equiv("\\", "C"))
    sections = (Section("round", ("a",), draw(expressions(("a", "K"), DETERMINED, SMALL))),)
    surfaces = (Sheet("leaf", ("u", "v"), tuple(draw(expressions(("u", "v"), numbers=SMALL)) for _ in range(3))),)
    return TimedSystem(axiom, system.productions, system.developments, defines, equivs, system.ignored, (inner,),
                       draw(st.booleans()), sections=sections, surfaces=surfaces)  # fmt: skip
