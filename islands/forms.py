"""The forms that are written at a run's end: of each island the best ones that differ."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from genome.errors import InputError
from islands.individual import Individual
from islands.island import Island
from islands.kinds.protocol import Accompanied, Biology, Facts
from islands.migration.channel import Migrant
from islands.selection import different, ranked
from islands.state import State
from islands.store import Store


def best_forms(island: Island[Any], deme: Sequence[Individual[Any]], count: int) -> list[Individual[Any]]:
    """Give the best members of different forms, best first; fewer where the deme has no more forms.

    See :func:`islands.selection.different`.
    """
    return different(ranked(deme), count, island.biology)


def written(
    biology: Biology[Any],
    genotype: Any,  # noqa: ANN401 - whatever the biology breeds
    partners: Sequence[Migrant],
    stem: Path,
    formats: Sequence[str],
    facts: Facts,
) -> list[Path]:
    """Write one form, among its partners' where the biology can show them together; give the files.

    Parameters
    ----------
    biology, genotype, stem, formats, facts
        As of :meth:`~islands.kinds.protocol.Biology.write_forms`; the ids of partners that are shown join the facts.
    partners
        One of each channel, or none.
    """
    if partners and isinstance(biology, Accompanied):
        facts = {**facts, "partners": ", ".join(str(one.id) for one in partners)}
        return biology.write_forms_with(genotype, tuple(partners), stem, formats, facts)
    return biology.write_forms(genotype, stem, formats, facts)


def write_forms(
    island: Island[Any],
    state: State[Any],
    members: Sequence[Individual[Any]],
    folder: Store,
    run: str,
    failed: Callable[[dict[str, Any]], None],
) -> list[str]:
    """Write members' forms as ``ISLAND-best1``, ``ISLAND-best2``, ...; give the files' names.

    They are in the surroundings that the island holds, and among partners that they are scored with.

    Parameters
    ----------
    island
        Where they live.
    state
        Its last.
    members
        Best first.
    folder
        Where the files go. Kinds write to a disk: they write to a folder of this machine first.
    run
        The run's name, for the files' own facts.
    failed
        Is told of each form that could not be written.
    """
    files: list[str] = []
    context = island.context(state)
    partners = () if context.company is None else context.company.foremost
    for rank, member in enumerate(members, start=1):
        facts: dict[str, str | float | bool] = {
            "run": run,
            "island": island.spec.name,
            "id": str(member.id),
            "fitness": member.fitness or 0.0,
        }
        with tempfile.TemporaryDirectory(prefix="atoll-") as here:
            stem = Path(here) / f"{island.spec.name}-best{rank}"
            try:
                for path in written(context.biology, member.genotype, partners, stem, (), facts):
                    folder.write(path.name, path.read_bytes())
                    files.append(path.name)
            except InputError as error:
                failed({"id": member.id, "detail": str(error)})
    return files
