"""Hypothesis strategies for things that Atoll parses and grows."""

from __future__ import annotations

from hypothesis import strategies as st

LABELS = ("A", "B", "C")


def successors(depth: int = 2) -> st.SearchStrategy[str]:
    """Any string of edges and turtle commands with balanced brackets and at least one edge."""
    edge = st.sampled_from(LABELS)
    turn = st.sampled_from(("+", "-", "&", "^", "\\", "/", "~"))
    plain = st.lists(st.one_of(edge, edge, turn), min_size=1, max_size=4).map(" ".join)
    inner = plain
    for _ in range(depth):
        bracket = inner.map(lambda text: f"[ {text} ]")
        inner = st.lists(st.one_of(edge, turn, bracket), min_size=1, max_size=4).map(" ".join)
    return inner.filter(lambda text: any(label in text for label in LABELS))


@st.composite
def branching(draw: st.DrawFn) -> str:
    """A successor in Genr8's manner: two edges with a pair of branches between them."""
    a, b, x = draw(st.sampled_from(LABELS)), draw(st.sampled_from(LABELS)), draw(st.sampled_from(LABELS))
    turns = draw(st.sampled_from(("+ {0} ] -", "+ + {0} ] - -", "- {0} ] +", "+ {0} ] &")))
    return f"{a} [ [ {turns.format(x)} {x} ] {b}"


@st.composite
def systems(draw: st.DrawFn) -> str:
    """The text of a rewrite system of up to five rules."""
    axiom = draw(st.lists(st.tuples(st.sampled_from(("", "~ ")), st.sampled_from(LABELS)), min_size=3, max_size=6))
    lines = [" + ".join(flip + label for flip, label in axiom)]
    for _ in range(draw(st.integers(1, 5))):
        label = draw(st.sampled_from(LABELS))
        left, right = draw(st.sampled_from(("", "", *LABELS))), draw(st.sampled_from(("", "", *LABELS)))
        predecessor = f"{left + ' < ' if left else ''}{label}{' > ' + right if right else ''}"
        lines.append(f"{predecessor} -> {draw(st.one_of(branching(), branching(), successors()))}")
    lines.append(f"Angle {draw(st.sampled_from((15, 30, 45, 60, 90)))}")
    if draw(st.booleans()):
        lines.append("Sync")
    lines.append(f"BranchAngle {draw(st.sampled_from((0, 15, 30, 45, 60, 75, 90)))}")
    return "\n".join(lines) + "\n"
