"""A map of the channels, and what was accepted on each."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from analysis.colours import COLOURS
from analysis.report.drawing import drawn
from analysis.report.parts import Figure, Section, asked
from orchestrator.folder import RunFolder
from orchestrator.query import Answer

SQL: Final = """
select kind, channel, regexp_replace(source, '-[0-9]+$', '') as "from", regexp_replace(target, '-[0-9]+$', '') as "to",
       count(*) as arrived, count(*) filter (accepted) as accepted, count(distinct id) filter (accepted) as individuals
from migrations group by all order by kind, channel, "from", "to"
"""

REFUSED: Final = """
select kind, reason, count(*) as refused from migrations where not accepted
group by all order by kind, refused desc, reason
"""

USED: Final = """
with arrived as (
    select distinct kind, channel, target, id from migrations where accepted and kind in ('migrants', 'components')
), heirs as (
    select distinct a.kind, a.channel, a.id from arrived a join (
        select island as target, unnest(list_concat(parents, components)) as id from individuals
    ) using (target, id)
)
select kind, channel, count(distinct a.id) as accepted, count(distinct h.id) as "with descendants"
from arrived a left join heirs h using (kind, channel, id) group by all order by all
"""

KINDS: Final = {"migrants": COLOURS[0], "partners": COLOURS[1], "components": COLOURS[2], "surroundings": COLOURS[3]}
STROKES: Final[Mapping[str, Any]] = {"migrants": "-", "partners": "--", "components": "-.", "surroundings": ":"}


def channels(folder: RunFolder) -> Section:
    """Draw the map and the tables of what travelled."""
    sql, answer = asked(folder, SQL)
    text = (
        "Arrows go from the group that sent to the group that took in, the thicker the more was accepted. "
        "Islands of one group that exchange with each other have a loop."
    )
    if not answer.rows:
        return Section("channels", "Channels", "Nothing has travelled on a channel.")
    figures = [Figure("The map", sql, answer, drawn("map", lambda axes: _map(axes, answer), (6.4, 5.2)), shown=True)]
    for title, query, note in (
        ("Refused", REFUSED, "docs/log-schema.md says what the reasons mean."),
        (
            "Taken in, and of use",
            USED,
            "Migrants and parts with a child, or an assembly, bred where they came to.",
        ),
    ):
        shown, found = asked(folder, query)
        if found.rows:
            figures.append(Figure(title, shown, found, note=note, shown=True))
    return Section("channels", "Channels", text, tuple(figures))


def _map(axes: Any, answer: Answer) -> None:  # noqa: ANN401 - matplotlib's
    import networkx as nx
    from matplotlib.lines import Line2D

    weights: dict[tuple[str, str, str], int] = {}
    for kind, _, source, target, _, accepted, _ in answer.rows:
        weights[source, target, kind] = weights.get((source, target, kind), 0) + int(accepted)
    graph = nx.Graph()
    graph.add_nodes_from(dict.fromkeys(name for source, target, _ in weights for name in (source, target)))
    graph.add_edges_from((source, target) for source, target, _ in weights if source != target)
    places = nx.circular_layout(graph) if len(graph) > 1 else dict.fromkeys(graph, (0.0, 0.0))
    most = max([*weights.values(), 1])
    bends: dict[frozenset[str], int] = {}
    for (source, target, kind), accepted in weights.items():
        width = 0.8 + 3.2 * (accepted / most) ** 0.5
        pair = frozenset((source, target))
        bend = 0.15 + 0.14 * bends.get(pair, 0)
        bends[pair] = bends.get(pair, 0) + 1
        style = {"color": KINDS[kind], "linestyle": STROKES[kind], "lw": width, "alpha": 1.0 if accepted else 0.35}
        if source == target:
            _loop(axes, places[source], kind, style)
            continue
        arrow = {
            "arrowstyle": "-|>,head_width=0.3,head_length=0.6",
            "connectionstyle": f"arc3,rad={bend}",
            "shrinkA": 20,
            "shrinkB": 20,
            **style,
        }
        axes.annotate("", places[target], places[source], arrowprops=arrow)
    for name, (x, y) in places.items():
        box = {"boxstyle": "round,pad=0.4", "facecolor": "#ffffff", "edgecolor": "#333333"}
        axes.text(x, y, name, ha="center", va="center", fontsize=9, bbox=box, zorder=4)
    marks = [Line2D([], [], color=KINDS[kind], linestyle=STROKES[kind], lw=1.6, label=kind)
             for kind in KINDS if any(one == kind for _, _, one in weights)]  # fmt: skip
    axes.legend(handles=marks, frameon=False, fontsize=8, loc="upper left", bbox_to_anchor=(-0.02, 1.06), ncols=4)
    axes.set(xlim=(-1.5, 1.5), ylim=(-1.45, 1.5), aspect="equal")
    axes.axis("off")


def _loop(axes: Any, place: Any, kind: str, style: dict[str, Any]) -> None:  # noqa: ANN401 - matplotlib's
    """Draw a loop outside of a node; one of another kind is larger."""
    from matplotlib.patches import Circle

    length = max((place[0] ** 2 + place[1] ** 2) ** 0.5, 1e-9)
    away = (place[0] / length, place[1] / length) if length > 1e-6 else (0.0, 1.0)
    radius = 0.12 + 0.05 * list(KINDS).index(kind)
    centre = (place[0] + away[0] * (0.1 + radius), place[1] + away[1] * (0.1 + radius))
    axes.add_patch(Circle(centre, radius, fill=False, edgecolor=style["color"], linestyle=style["linestyle"],
                          linewidth=style["lw"], alpha=style["alpha"], zorder=2))  # fmt: skip
