"""What ran: the run in numbers, and what it ran on."""

from __future__ import annotations

from typing import Any, Final

from analysis.report.parts import Figure, Section, asked, cell_text
from genome.errors import InputError
from orchestrator.folder import RunFolder

ISLANDS: Final = """
with latest as (
    select island, any_value(species) as species, max(generation) as generation,
           sum(evaluations)::bigint as evaluations,
           arg_max_null(best, generation) as best, arg_max_null(mean, generation) as mean,
           arg_max_null(diversity, generation) as diversity
    from generations group by island
), bred as (
    select island, min(id) as first_id, count(*) as bred, count(*) filter (not valid) as invalid
    from individuals group by island
)
select l.island, l.species, l.generation, l.evaluations, b.bred, b.invalid, l.best, l.mean, l.diversity
from latest l left join bred b using (island) order by b.first_id
"""

WHOLE: Final = """
select (select sum(evaluations) from generations)::bigint as scored,
       (select count(*) from individuals) + (select count(*) from evaluations) as "rows of the log"
"""


def opening(folder: RunFolder, found: dict[str, Any]) -> Section:
    """Say what ran, and how far it came.

    Parameters
    ----------
    folder
        The run.
    found
        How it stands, as of :func:`orchestrator.standing.standing`.
    """
    try:
        manifest = folder.manifest()
    except InputError:
        manifest = {}
    best = found["best"]
    facts = {
        "status": _status(found),
        "islands": len(found["islands"]),
        "generations": found["generations"],
        "evaluations": found["evaluations"],
        "best": f"{best['fitness']:.6g}: {best['id']} of {best['island']}" if best else "nobody is valid",
        "seed": manifest.get("seed"),
        "started": found["started"],
        "ended": found["ended"],
        "took": _seconds(manifest.get("wall_s")),
        "on": _machine(manifest),
        "versions": ", ".join(f"{name} {number}" for name, number in dict(manifest.get("versions") or {}).items()),
        "error": found["error"],
    }
    told = tuple((name, cell_text(value)) for name, value in facts.items() if value not in (None, ""))
    sql, islands = asked(folder, ISLANDS)
    whole, rows = asked(folder, WHOLE)
    figures = [Figure("The islands at the end", sql, islands, shown=True)] if islands.rows else []
    scored, kept = rows.rows[0]
    troubles: tuple[str, ...] = ()
    if (scored or 0) != kept:
        troubles = (f"The log counts {scored or 0} scorings and holds {kept} rows of them: files are missing.",)
        figures.append(Figure("Scorings and rows", whole, rows, shown=True))
    return Section("run", "What ran", _note(found), tuple(figures), facts=told, troubles=troubles)


def _status(found: dict[str, Any]) -> str:
    gone = "; its process is gone" if found["alive"] is False else ""
    return f"{found['status']}{gone}"


def _note(found: dict[str, Any]) -> str:
    if found["alive"] is False:
        return f"The run was killed: this is what its log has. It goes on with: atoll resume {found['run']}"
    if found["alive"]:
        return "The run goes on: this is as far as its log had come when the report was written."
    return ""


def _seconds(value: object) -> str:
    return f"{float(value):.1f} s" if isinstance(value, (int, float)) else ""


def _machine(manifest: dict[str, Any]) -> str:
    backend, hosts = manifest.get("backend"), manifest.get("hosts")
    return f"{hosts} hosts, backend {backend}" if backend and hosts else ""
