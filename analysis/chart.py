"""A chart of one score over a run's generations: for each group of islands the best and the mean of who was scored."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple

from analysis.colours import colour
from genome.errors import InputError
from genome.files import write_whole
from genome.settings import near
from orchestrator.query import ask

if TYPE_CHECKING:
    from orchestrator.folder import RunFolder

FITNESS: Final = "fitness"
FORMATS: Final = ("png", "svg")

SERIES: Final = """
    with scored as (
        select island, generation, {score} as value from individuals where valid
        union all select island, generation, {score} as value from evaluations where valid
    )
    select regexp_replace(island, '-[0-9]+$', '') as line, generation, max(value), avg(value)
    from scored where value is not null group by all order by all
"""

NAMES: Final = "select distinct unnest(map_keys(scores)) as name from individuals order by name"


class Line(NamedTuple):
    """One group of islands.

    Attributes
    ----------
    name
        The group's.
    generations, best, mean
        As long as each other.
    """

    name: str
    generations: list[int]
    best: list[float]
    mean: list[float]


def lines_of(folder: RunFolder, score: str) -> list[Line]:
    """Read a score's lines; of each generation those count who were scored in it, for the first time or again.

    Raises
    ------
    InputError
        For a score that the log does not have.
    """
    known = [FITNESS, *(str(name) for (name,) in ask(folder.log, NAMES).rows)]
    if score not in known:
        raise InputError("--score", "a score of this run", f"'{score}'", near(score, known))
    column = FITNESS if score == FITNESS else f"scores['{score}']"
    found: dict[str, Line] = {}
    for name, generation, best, mean in ask(folder.log, SERIES.format(score=column)).rows:
        line = found.setdefault(name, Line(name, [], [], []))
        line.generations.append(int(generation))
        line.best.append(float(best))
        line.mean.append(float(mean))
    return list(found.values())


def write_chart(folder: RunFolder, score: str, path: Path) -> None:
    """Draw a score to a PNG or SVG file, whole or not at all.

    Raises
    ------
    InputError
        For another suffix, a score that the log does not have, or one without values.
    """
    suffix = path.suffix.lower().lstrip(".")
    if suffix not in FORMATS:
        raise InputError("-o", f"a file that ends with .{' or .'.join(FORMATS)}", f"'{path.name}'")
    lines = lines_of(folder, score)
    if not lines:
        raise InputError("--score", "a score that some valid individual has", f"'{score}'")
    write_whole(path, _drawn(lines, score, folder.name, suffix))


def _drawn(lines: list[Line], score: str, title: str, suffix: str) -> bytes:
    import io

    import matplotlib as mpl
    from matplotlib.figure import Figure

    with mpl.rc_context({"svg.hashsalt": "atoll", "font.size": 10, "svg.fonttype": "none"}):
        figure = Figure(figsize=(8, 4.5), layout="constrained")
        axes = figure.add_subplot()
        for place, line in enumerate(lines):
            shade = colour(place)
            axes.plot(line.generations, line.best, color=shade, linewidth=1.8, label=f"{line.name}: best")
            axes.plot(line.generations, line.mean, color=shade, linewidth=1.0, linestyle=":", label="mean")
        axes.set_xlabel("generation")
        axes.set_ylabel(score)
        axes.set_title(title, loc="left", fontsize=11)
        axes.grid(visible=True, color="#dddddd", linewidth=0.6)
        axes.spines[["top", "right"]].set_visible(False)
        axes.legend(frameon=False, fontsize=9, ncols=2 if len(lines) > 3 else 1)
        stream = io.BytesIO()
        # Without the date, so that the same log gives the same bytes.
        figure.savefig(stream, format=suffix, dpi=120, metadata={"Date": None} if suffix == "svg" else {"Software": ""})
    return stream.getvalue()
