"""How a run stands, read from its manifest and log: also of one that still goes on, or was killed."""

from __future__ import annotations

import os
import platform
from typing import Any, Final

from orchestrator.folder import RunFolder
from orchestrator.lease import is_driven
from orchestrator.query import as_rows, ask
from orchestrator.regrow import best

GOING: Final = ("running", "paused")
"""Statuses of a run that has not ended."""

ISLANDS = """
    with latest as (
        select island, any_value(species) as species, max(generation) as generation,
               sum(evaluations)::bigint as evaluations, arg_max_null(best, generation) as best,
               arg_max_null(mean, generation) as mean, arg_max(invalid, generation) as invalid,
               sum(wall_ms) as wall_ms
        from generations group by island
    ), joined as (
        select island, count(*) as migrants from migrations where accepted and kind = 'migrants' group by island
    ), first_bred as (
        select island, min(id) as first_id from individuals group by island
    )
    select l.island, l.species, l.generation, l.evaluations, l.best, l.mean, l.invalid,
           coalesce(j.migrants, 0) as migrants, l.wall_ms
    from latest l left join joined j using (island) left join first_bred f using (island)
    order by f.first_id
"""


def standing(folder: RunFolder) -> dict[str, Any]:
    """Give a run's status, islands, best so far, and rates.

    ``generations`` counts those of islands that were there from the beginning to now, ``evaluations`` all scorings in
    the log, and ``evaluations_per_s`` compares these with the time that the islands spent on them, all together.
    ``alive`` tells whether a process drives a run that is marked as going on; it is ``None`` for one that has ended.
    """
    manifest = folder.manifest()
    going = is_driven(folder.store) if manifest.get("status") in GOING else None
    return {
        "run": folder.name,
        "status": manifest.get("status"),
        "alive": going,
        "error": manifest.get("error", ""),
        "started": manifest.get("started"),
        "ended": manifest.get("ended"),
        **progress(folder),
    }


def progress(folder: RunFolder) -> dict[str, Any]:
    """Give what the log alone tells of how a run stands: generations, evaluations, rates, the best, the islands."""
    islands = as_rows(ask(folder.log, ISLANDS))
    evaluations = sum(int(row["evaluations"]) for row in islands)
    busy = sum(float(row.pop("wall_ms")) for row in islands) / 1e3
    return {
        "generations": max((int(row["generation"]) for row in islands), default=0),
        "evaluations": evaluations,
        "evaluations_per_s": round(evaluations / busy, 3) if busy > 0 else None,
        "best": champion(folder),
        "islands": islands,
    }


def champion(folder: RunFolder) -> dict[str, Any] | None:
    """Give the best individual of a log: ``island``, ``id``, ``fitness``; ``None`` where nobody is valid."""
    top = best(folder, 1)
    return {"island": top[0].island, "id": top[0].id, "fitness": top[0].fitness} if top else None


def alive(manifest: dict[str, Any]) -> bool | None:
    """Tell whether the process of a run that is marked as going on is there; ``None`` where that cannot be known."""
    if manifest.get("status") not in GOING or manifest.get("machine") != platform.node():
        return None
    try:
        os.kill(int(manifest["process"]), 0)
    except ProcessLookupError:
        return False
    except (KeyError, ValueError, TypeError, OSError):
        return None
    return True
