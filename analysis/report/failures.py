"""What was invalid, and what else went wrong, by reason."""

from __future__ import annotations

from typing import Any, Final

from analysis.colours import COLOURS
from analysis.report.drawing import HEIGHT, WIDTH, drawn
from analysis.report.parts import Figure, Section, asked
from orchestrator.folder import RunFolder
from orchestrator.query import Answer

SQL: Final = """
select regexp_replace(island, '-[0-9]+$', '') as islands, split_part(error, ':', 1) as reason, count(*) as invalid,
       min(error) as example
from individuals where not valid group by all order by invalid desc, islands, reason
"""

SHARE: Final = """
select regexp_replace(island, '-[0-9]+$', '') as islands, count(*) as bred, count(*) filter (not valid) as invalid,
       count(*) filter (not valid) / count(*) as share
from individuals group by all order by all
"""

EVENTS: Final = """
select kind, island, count(*) as events, min(epoch) as "first epoch", max(epoch) as "last epoch", min(detail) as example
from events where kind not in ('start', 'finish', 'arrivals', 'coevolution') group by all order by kind, island
"""


def failures(folder: RunFolder) -> Section:
    """Draw the invalid by reason, and list the events that are more than a start and an end."""
    sql, reasons = asked(folder, SQL)
    figures = []
    if reasons.rows:
        size = (WIDTH, max(HEIGHT * 0.5, 0.7 + 0.24 * len(_bars(reasons))))
        note = "Reasons are explained in docs/log-schema.md."
        figures.append(
            Figure("Invalid individuals", sql, reasons, drawn("invalid", lambda axes: _draw(axes, reasons), size), note)
        )
    shown, share = asked(folder, SHARE)
    if share.rows:
        figures.append(Figure("Invalid among all that were bred", shown, share, shown=True))
    shown, events = asked(folder, EVENTS)
    if events.rows:
        figures.append(
            Figure("Events", shown, events, note="Interventions, losses of hosts, repairs and the like.", shown=True)
        )
    text = "" if reasons.rows else "Every individual was valid." if share.rows else "Nobody was bred."
    return Section("failures", "Invalid individuals and events", text, tuple(figures))


def _bars(answer: Answer) -> list[tuple[str, int]]:
    return [(f"{islands}: {reason}", int(invalid)) for islands, reason, invalid, _ in answer.rows[:20]]


def _draw(axes: Any, answer: Answer) -> None:  # noqa: ANN401 - matplotlib's
    bars = _bars(answer)[::-1]
    axes.barh([name for name, _ in bars], [count for _, count in bars], color=COLOURS[1], height=0.62)
    for place, (_, count) in enumerate(bars):
        axes.text(count, place, f" {count}", va="center", fontsize=8)
    axes.set_xlabel("individuals")
    axes.margins(x=0.14)
    axes.grid(visible=False, axis="y")
