"""A house as one flat genotype, which Rosenman 1997 (section 4, after Jo 1993) says does not converge: to compare with.

One sequence of conjoinings places all cells of the house; the first cells are the first room's, the next the second's.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar, Final, final

import numpy as np

from evaluators.plans import PLAN_CRITERIA, Layout, laid_out, resolve, score
from evaluators.rooms import corners, perimeter_to_area
from genome.polyform import Conjoining, Room, crossover, decode_room, encode
from genome.settings import Settings
from growth.polyforms import Plan, Polyform, draw_room, form_of, redraw_room
from growth.protocol import Clock, Failure
from islands.individual import Evaluation
from islands.kinds.assemblies import AssemblyGrowth
from islands.kinds.measures import Criteria, Scoring
from islands.kinds.planned import shape_diversity
from islands.kinds.protocol import Facts, Keep
from islands.spec import IslandSpec

ROOMS: Final = ("shape", "whole")
"""``shape``: the sum over the rooms of what rooms minimise; ``whole``: the share of rooms that are in one piece."""

PLAN: Final = Criteria(tuple(PLAN_CRITERIA), resolve, score)


class FlatGenome(Settings):
    """Nothing: the brief says how many cells there are."""


@final
class FlatHouseBiology:
    """Breeds and scores flat houses; see :class:`islands.kinds.protocol.Biology`."""

    seconds: Final = 1.0

    def __init__(self, spec: IslandSpec, clock: Clock) -> None:
        self._brief: Final = AssemblyGrowth.model_validate(dict(spec.growth)).brief
        self._tiling: Final = self._brief.cells
        sizes = [wish.cells for wish in self._brief.rooms.values()]
        self._owners: Final = np.repeat(np.arange(len(sizes)), sizes)
        self._clock: Final = clock
        self._scoring: Final = Scoring(spec.fitness, PLAN, ROOMS, spec.where, clock)
        self.scoring: Final = self._scoring.key("flat", self._brief.model_dump(mode="json"))

    def random(self, rng: np.random.Generator) -> Room:
        """Draw all cells, edge by edge."""
        return draw_room(len(self._owners), self._tiling, rng)

    def crossover(self, first: Room, second: Room, rng: np.random.Generator) -> tuple[Room, Room]:
        """Cross at a site where both children can be grown."""

        def valid(genes: tuple[Conjoining, ...]) -> bool:
            return isinstance(form_of(Room(genes), self._tiling), Plan)

        one, other = crossover(first.joins, second.joins, rng, valid)
        return Room(one), Room(other)

    def mutate(self, genotype: Room, rng: np.random.Generator) -> Room:
        """Draw one conjoining anew, and those behind it that no longer fit."""
        return redraw_room(genotype, int(rng.integers(0, len(genotype.joins))), self._tiling, rng)

    def encode(self, genotype: Room) -> str:
        """Write all conjoinings as JSON."""
        return encode(genotype)

    def decode(self, text: str) -> Room:
        """Read them."""
        return decode_room(text)

    def evaluate(self, genotype: Room) -> Evaluation:
        """Judge the plan, and its rooms."""
        started = self._clock()
        form = form_of(genotype, self._tiling)
        if isinstance(form, Failure):
            return self._scoring.failed(form, started)
        layout = laid_out(Plan(self._tiling, form.cells, self._owners), self._brief)
        return self._scoring.of(layout, _of_rooms(layout), started, self._clock())

    def diversity(self, genotypes: Sequence[Room]) -> float | None:
        """Give the mean distance of the forms."""
        return shape_diversity([form_of(one, self._tiling) for one in genotypes])

    def write_forms(self, genotype: Room, stem: Path, formats: Sequence[str], facts: Facts) -> list[Path]:
        """Write nothing."""
        del genotype, stem, formats, facts
        return []


def _of_rooms(layout: Layout) -> dict[str, float]:
    plan = layout.plan
    shape, whole = 0.0, 0
    for room in range(plan.count):
        cells = plan.cells[plan.rooms == room]
        form = Polyform(plan.tiling, cells)
        shape += perimeter_to_area(form) + corners(form) / 20.0
        whole += _in_one_piece(cells)
    return {"shape": shape, "whole": whole / plan.count}


def _in_one_piece(cells: np.ndarray[Any, Any]) -> bool:
    there = {tuple(cell) for cell in cells.tolist()}
    todo = [next(iter(sorted(there)))]
    there.discard(todo[0])
    while todo:
        x, y, z = todo.pop()
        for other in ((x + 1, y, z), (x - 1, y, z), (x, y + 1, z), (x, y - 1, z)):
            if other in there:
                there.discard(other)
                todo.append(other)
    return not there


@final
class FlatHouseKind:
    """The kind ``benchmarks.flat_house:FlatHouseKind``."""

    name: ClassVar[str] = "flat_house"
    genome: ClassVar[type[Settings]] = FlatGenome
    growth: ClassVar[type[Settings]] = AssemblyGrowth

    def build(self, spec: IslandSpec, clock: Clock) -> FlatHouseBiology:
        """Find the criteria."""
        return FlatHouseBiology(spec, clock)

    def keep_files(self, spec: IslandSpec, keep: Keep) -> tuple[Mapping[str, Any], Mapping[str, Any]]:
        """Keep nothing."""
        del keep
        return spec.genome, spec.growth
