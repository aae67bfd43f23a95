"""Individuals of a log, brought back to life with the settings of the island that bred them."""

from __future__ import annotations

import re
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from evaluators.plans import Layout
from genome.errors import InputError
from genome.settings import near
from growth.protocol import Failure
from islands.biologies import Biologies
from islands.forms import written
from islands.individual import Evaluation, Scores
from islands.kinds.plans import Planner
from islands.kinds.protocol import Accompanied, Biology, Pictured
from islands.migration.channel import Migrant
from orchestrator.circumstances import Circumstances
from orchestrator.folder import RunFolder
from orchestrator.loading import load_experiment
from orchestrator.query import ask
from orchestrator.steering.journal import read_commands
from orchestrator.steering.past import Past
from orchestrator.steering.restructuring import replayed
from orchestrator.steering.structure import structure_of

if TYPE_CHECKING:
    from PIL.Image import Image

COLUMNS = "id, island, epoch, genotype, fitness, scores, error, partners"

FORMS = """
    with top as (
        select id, fitness, if(cardinality(scores) = 0, genotype, scores::varchar) as form
        from individuals where fitness is not null {which} order by fitness desc, id limit {among}
    ), alike as (
        select form, fitness, min(id) as id from top group by form, fitness
    ), forms as (
        select max(fitness) as fitness, arg_max(id, fitness) as id from alike group by form
    )
    select id from forms order by fitness desc, id limit {count}
"""


@dataclass(frozen=True, slots=True)
class Logged:
    """An individual as the log has it: as first scored, on the island that bred it."""

    id: int
    island: str
    epoch: int
    genotype: str
    fitness: float | None
    scores: Scores
    error: str
    partners: tuple[int, ...] = ()


def by_id(folder: RunFolder, ids: Sequence[int]) -> list[Logged]:
    """Find individuals by their ids, in the order given.

    Raises
    ------
    InputError
        For an id that the log does not have.
    """
    listed = ", ".join(str(int(identity)) for identity in ids)
    found = {row.id: row for row in _logged(folder, f"where id in ({listed})")} if ids else {}
    for identity in ids:
        if identity not in found:
            remedy = 'find one with: atoll query RUN "select id, fitness from individuals order by fitness desc"'
            raise InputError("--id", "an individual of the log", str(identity), remedy)
    return [found[identity] for identity in ids]


def islands_named(folder: RunFolder, names: Sequence[str]) -> list[str]:
    """Give the islands of a log that have these names, or are of groups that do.

    Raises
    ------
    InputError
        For a name that no island and no group has.
    """
    known = [str(name) for (name,) in ask(folder.log, "select distinct island from individuals order by island").rows]
    found: dict[str, None] = {}
    for name in names:
        meant = [one for one in known if one == name or re.fullmatch(rf"{re.escape(name)}-[0-9]+", one)]
        if not meant:
            raise InputError("--island", "an island of this run, or a group", f"'{name}'", near(name, known))
        found.update(dict.fromkeys(meant))
    return list(found)


def best(folder: RunFolder, count: int, islands: Sequence[str] = ()) -> list[Logged]:
    """Find the best individuals of different forms, best first; of equal fitness the lower id.

    Of some islands alone where any are named.

    Those whose scores are equal to the last bit count as one form, whatever their genotypes and islands: the one of
    the highest fitness stands for it, of equal ones the lowest id. Of a kind without scores genotypes are compared.
    """
    named = ", ".join("'" + name.replace("'", "''") + "'" for name in islands)
    which = f"and island in ({named})" if named else ""
    among, everyone = count if count == 1 else 64 * count, 0
    while True:
        # Sought among the best alone first, since a log may hold millions.
        rows = ask(folder.log, FORMS.format(among=int(among), count=int(count), which=which)).rows
        everyone = everyone or int(ask(folder.log, "select count(fitness) from individuals").rows[0][0])
        if len(rows) == count or among >= everyone:
            return by_id(folder, [int(identity) for (identity,) in rows])
        among *= 16


def _logged(folder: RunFolder, clause: str) -> list[Logged]:
    answer = ask(folder.log, f"select {COLUMNS} from individuals {clause}")  # noqa: S608 - numbers alone go in
    return [
        Logged(
            identity, island, epoch, genotype, fitness, tuple(sorted((scores or {}).items())), error, tuple(partners)
        )
        for identity, island, epoch, genotype, fitness, scores, error, partners in answer.rows
    ]


class Nursery:
    """Makes the biology of each island of a run, once.

    Attributes
    ----------
    specs
        All islands that the run ever had.
    """

    def __init__(self, folder: RunFolder) -> None:
        loaded = load_experiment(folder.experiment)
        self._run = folder.name
        commands = read_commands(folder.store)
        plan = replayed(structure_of(loaded), commands).plan()
        self.specs = plan.islands
        self._past = Past(commands, plan.islands)
        self._biologies = Biologies(time.thread_time)
        late = loaded.experiment.schedule == "async"
        self._circumstances = Circumstances(folder, plan, loaded.experiment.seed, late, self.biology)

    def biology(self, island: str, epoch: int = 0) -> Biology[Any]:
        """Give the biology of an island by name, by its goals in an epoch, as it is while it holds nothing."""
        return self._biologies(self._past.spec(island, epoch))

    def score(self, logged: Logged) -> Evaluation:
        """Grow and score an individual again: among the forms, and with the partners, that it was first scored with."""
        return self._circumstances.score(logged.island, logged.epoch, logged.genotype, logged.partners)

    def layout(self, logged: Logged) -> Layout | Failure:
        """Grow an individual's plan anew and lay it out.

        Raises
        ------
        InputError
            When the kind of its island draws no plans.
        """
        biology = self.biology(logged.island, logged.epoch)
        if not isinstance(biology, Planner):
            raise InputError(logged.island, "an island of rooms, zones or houses", "one of another kind")
        return biology.layout(biology.decode(logged.genotype))

    def picture(self, logged: Logged, size: tuple[int, int]) -> Image | None:
        """Draw an individual's form, among the partners that it was first scored with.

        Returns
        -------
        An RGB image; ``None`` for one that grows to no form, and for kinds that have no pictures.
        """
        biology = self._circumstances.biology(logged.island, logged.epoch)
        if not isinstance(biology, Pictured):
            return None
        return biology.picture(biology.decode(logged.genotype), self._partners(biology, logged), size)

    def _partners(self, biology: Biology[Any], logged: Logged) -> tuple[Migrant, ...]:
        if not isinstance(biology, Accompanied):
            return ()
        return self._circumstances.partners(logged.island, logged.epoch, logged.partners)

    def write_forms(self, logged: Logged, folder: Path, formats: Sequence[str]) -> list[Path]:
        """Write an individual's form as ISLAND-ID.SUFFIX, among the partners that it was first scored with."""
        biology = self._circumstances.biology(logged.island, logged.epoch)
        stem = folder / f"{logged.island}-{logged.id}"
        facts: dict[str, str | float | bool] = {"run": self._run, "island": logged.island, "id": str(logged.id)}
        if logged.fitness is not None:
            facts["fitness"] = logged.fitness
        partners = self._partners(biology, logged)
        return written(biology, biology.decode(logged.genotype), partners, stem, formats, facts)


def same(logged: Logged, found: Evaluation) -> bool:
    """Tell whether a scoring gave bit for bit what the log has.

    A growth that the clock broke off is replayed as such: how far it came is no property of the individual.
    """
    if logged.error.startswith("clock:"):
        return True
    return (logged.fitness, logged.scores, logged.error) == (found.fitness, found.scores, found.error)
