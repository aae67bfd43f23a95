"""The island kind ``room``: one room of a brief, cells conjoined to a compact shape (Rosenman 1997, section 3).

Chosen members rise on channels of components to the islands that assemble them. Where such an island shows itself on a
channel of partners, and does not have what it wants, rooms of other shapes than the one it uses are ``fresh``.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, ClassVar, Final, Literal, final

import numpy as np
from pydantic import Field

from evaluators.plans import Brief, Layout, laid_out
from evaluators.rooms import ROOM_CRITERIA, resolve, score
from genome.polyform import Conjoining, Room, crossover, decode_room, encode
from genome.settings import Settings
from growth.polyforms import TILINGS, Plan, draw_room, form_of, grow_room, redraw_room
from growth.protocol import Clock, Failure
from islands.individual import Evaluation
from islands.kinds.measures import Criteria, Scoring
from islands.kinds.parts import DEMAND, part_text
from islands.kinds.planned import FRESH, PlannedBiology, freshness
from islands.kinds.plans import write_plans
from islands.kinds.protocol import Facts, Keep
from islands.migration.channel import ChannelKind, Migrant
from islands.spec import IslandSpec

ROOM: Final = Criteria(tuple(ROOM_CRITERIA), resolve, score)
"""How rooms are measured."""


class RoomGenome(Settings):
    """Rooms of so many cells.

    Attributes
    ----------
    cells
        The room's area.
    tiling
        What the cells are.
    part
        The name under which it rises; the island's group without.
    """

    cells: Annotated[int, Field(ge=1, le=2000)]
    tiling: Literal["square", "triangle", "hexagon", "cube"] = "square"
    part: str | None = None


class RoomGrowth(Settings):
    """Nothing: a room of cells grows in one way.

    Attributes
    ----------
    unit
        The length of a cell's edge in metres, for drawings.
    """

    unit: Annotated[float, Field(gt=0, le=1000)] = 1.0


@final
class RoomBiology(PlannedBiology[Room]):
    """Breeds and scores rooms; see :class:`islands.kinds.protocol.Biology`.

    Parameters
    ----------
    spec
        The island's settings.
    clock
        For the ``*_ms`` columns.
    """

    def __init__(self, spec: IslandSpec, clock: Clock) -> None:
        self._genome: Final = RoomGenome.model_validate(dict(spec.genome))
        super().__init__(TILINGS[self._genome.tiling])
        self._growth: Final = RoomGrowth.model_validate(dict(spec.growth))
        self._name: Final = part_of(spec)
        self._clock: Final = clock
        self._scoring: Final = Scoring(spec.fitness, ROOM, (FRESH,), spec.where, clock)
        self.scoring: Final = self._scoring.key("room", self._genome.model_dump(mode="json"))

    def random(self, rng: np.random.Generator) -> Room:
        """Draw a room, edge by edge."""
        return draw_room(self._genome.cells, self._tiling, rng)

    def crossover(self, first: Room, second: Room, rng: np.random.Generator) -> tuple[Room, Room]:
        """Cross two rooms at a site where both children can be grown (Rosenman 1997, section 3.3.2)."""
        if first.first != second.first:
            return first, second

        def valid(genes: tuple[Conjoining, ...]) -> bool:
            return isinstance(form_of(Room(genes, first.first), self._tiling), Plan)

        one, other = crossover(first.joins, second.joins, rng, valid)
        return Room(one, first.first), Room(other, first.first)

    def mutate(self, genotype: Room, rng: np.random.Generator) -> Room:
        """Draw one conjoining anew, and those behind it that no longer fit."""
        if not genotype.joins:
            return genotype
        return redraw_room(genotype, int(rng.integers(0, len(genotype.joins))), self._tiling, rng)

    def decode(self, text: str) -> Room:
        """Read a room."""
        return decode_room(text)

    def offer(self, genotype: Room, kind: ChannelKind) -> str:
        """Give a named part to components, the room to others."""
        return part_text(self._name, genotype) if kind == "components" else encode(genotype)

    def write_forms(self, genotype: Room, stem: Path, formats: Sequence[str], facts: Facts) -> list[Path]:
        """Draw a room; see :mod:`islands.kinds.plans`."""
        return write_plans(genotype, form_of(genotype, self._tiling), self._brief(), stem, formats, facts)

    def layout(self, genotype: Room) -> Layout | Failure:
        """Grow a room and lay it out as a plan of its own."""
        plan = form_of(genotype, self._tiling)
        return plan if isinstance(plan, Failure) else laid_out(plan, self._brief())

    def _brief(self) -> Brief:
        rooms = {self._name: {"cells": self._genome.cells}}
        return Brief.model_validate({"tiling": self._genome.tiling, "unit": self._growth.unit, "rooms": rooms})

    def scored(self, genotype: Room, partners: tuple[Migrant, ...]) -> Evaluation:
        """Grow and score a room by its shape, and by what the islands above use and miss."""
        started = self._clock()
        form = grow_room(genotype, self._tiling)
        if isinstance(form, Failure):
            return self._scoring.failed(form, started)
        grown = self._clock()
        return self._scoring.of(form, {FRESH: freshness(form, self._name, partners)}, started, grown)


def part_of(spec: IslandSpec) -> str:
    """Give the name under which members of an island rise: its own, or its group's."""
    return str(spec.genome.get("part") or spec.group)


@final
class RoomKind:
    """The kind ``room``."""

    name: ClassVar[str] = "room"
    genome: ClassVar[type[Settings]] = RoomGenome
    growth: ClassVar[type[Settings]] = RoomGrowth

    def gives(self, spec: IslandSpec) -> Mapping[ChannelKind, str]:
        """Give a part by its name."""
        return {"components": f"part {part_of(spec)}"}

    def takes(self, spec: IslandSpec) -> Mapping[ChannelKind, tuple[str, ...]]:
        """Take what is asked for from above."""
        del spec
        return {"partners": (DEMAND,)}

    def compile_kernels(self) -> None:
        """Compile the growth's and the criteria's."""
        from evaluators.plans.warm import compile_kernels

        compile_kernels()

    def build(self, spec: IslandSpec, clock: Clock) -> RoomBiology:
        """Find the criteria."""
        return RoomBiology(spec, clock)

    def keep_files(self, spec: IslandSpec, keep: Keep) -> tuple[Mapping[str, Any], Mapping[str, Any]]:
        """Keep nothing: no setting names a file."""
        del keep
        return spec.genome, spec.growth
