"""What zones and houses share: plans conjoined of parts that rose on channels of components (Rosenman 1997, section 3).

The order of the parts is one for the whole population, so that crossover loses none of them (section 3.2.2).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, ClassVar, Final, Self, final

import numpy as np
from pydantic import BeforeValidator, Field, model_validator

from evaluators.plans import COSTLY, PLAN_CRITERIA, Brief, Layout, laid_out, resolve, score
from evaluators.plans.adjacency import met
from genome.errors import InputError
from genome.polyform import Assembly, Attachment, Part, Room, crossover, decode_assembly, encode
from genome.settings import Settings, describe, near
from growth.polyforms import Plan, draw_assembly, form_of, mend_assembly, redraw_assembly
from growth.polyforms.solid import raised
from growth.protocol import Clock, Failure
from islands.individual import Evaluation
from islands.kinds.measures import Criteria, Scoring
from islands.kinds.meshes import mesh_text
from islands.kinds.parts import DEMAND, demand_text, part_text, read_part_text
from islands.kinds.planned import FRESH, PlannedBiology, freshness
from islands.kinds.plans import write_plans
from islands.kinds.protocol import Facts, Keep
from islands.kinds.room import part_of
from islands.migration.channel import ChannelKind, Migrant
from islands.spec import IslandSpec

PLAN: Final = Criteria(tuple(name for name in PLAN_CRITERIA if name not in COSTLY), resolve, score)
"""How plans are measured."""

STOREY: Final = 3.0
"""The height of a plan that stands in the surroundings of others, in edges of cells."""

TRIES: Final = 16
"""Sets of parts that are drawn until some can be conjoined."""


def _as_parts(value: object) -> object:
    """Take a list of rooms as parts of one room each."""
    if isinstance(value, list):
        for one in value:
            if not isinstance(one, str) or value.count(one) > 1:
                raise InputError("", "names of parts, each once", describe(one))
        return {one: [one] for one in value}
    return value


class AssemblyGenome(Settings):
    """What is assembled, and how it varies.

    Attributes
    ----------
    parts
        The parts in the order in which they are conjoined, and the rooms that each consists of, in their order; a list
        where each part is one room.
    part
        The name under which the whole rises; the island's group without.
    exchange
        How often mutation exchanges a part for another one of its name, rather than drawing an attachment anew.
    """

    parts: Annotated[dict[str, list[str]], BeforeValidator(_as_parts), Field(min_length=1)]
    part: str | None = None
    exchange: Annotated[float, Field(ge=0, le=1)] = 0.5

    @model_validator(mode="after")
    def _each_room_once(self) -> Self:
        rooms = self.rooms
        for name, own in self.parts.items():
            if not own:
                raise InputError("", "parts of one room at least", f"'{name}' without any")
        for room in rooms:
            if rooms.count(room) > 1:
                raise InputError("", "each room in one part", f"'{room}' twice")
        return self

    @property
    def rooms(self) -> list[str]:
        """All rooms, in their order."""
        return [room for own in self.parts.values() for room in own]


class AssemblyGrowth(Settings):
    """What a plan is to be.

    Attributes
    ----------
    brief
        Its rooms, and what they want.
    required
        By criterion what a plan must reach to be valid; short of it the plan is eliminated (section 3.3.1). What is a
        goal of the fitness alone is a penalty.
    """

    brief: Brief
    required: dict[str, float] = Field(default_factory=dict)


@final
class AssemblyBiology(PlannedBiology[Assembly]):
    """Breeds and scores zones, or houses; see :class:`islands.kinds.protocol.Biology`.

    Parameters
    ----------
    spec
        The island's settings.
    clock
        For the ``*_ms`` columns.
    parts
        Those to draw from, by name; none as long as nothing has risen.
    """

    def __init__(self, spec: IslandSpec, clock: Clock, parts: Mapping[str, Sequence[Part]] | None = None) -> None:
        self._spec: Final = spec
        self._clock: Final = clock
        self._genome: Final = AssemblyGenome.model_validate(dict(spec.genome))
        self._growth: Final = AssemblyGrowth.model_validate(dict(spec.growth))
        self._name: Final = part_of(spec)
        self._brief: Final = _in_order(self._growth.brief, self._genome.rooms, spec)
        super().__init__(self._brief.cells)
        self._parts: Final = {name: tuple((parts or {}).get(name, ())) for name in self._genome.parts}
        self._scoring: Final = Scoring(spec.fitness, PLAN, (FRESH,), spec.where, clock)
        for name in self._growth.required:
            if name not in PLAN.usual and name not in spec.fitness:
                remedy = near(name, list(PLAN_CRITERIA))
                raise InputError(spec.where("growth", "required", name), "a criterion of plans", f"'{name}'", remedy)
        self.scoring: Final = self._scoring.key(spec.kind, self._growth.model_dump(mode="json"))

    @property
    def ready(self) -> bool:
        """Whether there is a part of each name to draw from."""
        return all(self._parts.values())

    def supplied(self, parts: tuple[Migrant, ...]) -> AssemblyBiology:
        """Give the biology that draws from these parts."""
        found: dict[str, list[Part]] = {}
        for one in parts:
            name, genotype = read_part_text(one.text)
            found.setdefault(name, []).append(Part(one.id, genotype))
        return AssemblyBiology(self._spec, self._clock, found)

    def components(self, genotype: Assembly) -> tuple[int, ...]:
        """Give the ids of the parts."""
        return tuple(part.id for part in genotype.parts)

    def random(self, rng: np.random.Generator) -> Assembly:
        """Draw a part of each name, and how they are conjoined."""
        found: Assembly | Failure = Failure("conjoining", "nothing drawn")
        parts: list[Part] = []
        for _ in range(TRIES):
            parts = [own[int(rng.integers(0, len(own)))] for own in self._parts.values()]
            found = draw_assembly(parts, self._tiling, rng)
            if isinstance(found, Assembly):
                return found
        return Assembly(tuple(parts), (Attachment(0, 0, 0),) * (len(parts) - 1))

    def crossover(self, first: Assembly, second: Assembly, rng: np.random.Generator) -> tuple[Assembly, Assembly]:
        """Cross two plans at a site where both children can be conjoined: parts and attachments in turn.

        Where no such site is found, attachments that no longer fit are drawn anew: an attachment numbers the edges of
        the parts before it, which the other parent's have not.
        """

        def valid(genes: tuple[Part | Attachment, ...]) -> bool:
            return isinstance(form_of(_assembly(genes), self._tiling), Plan)

        ours, theirs = _genes(first), _genes(second)
        one, other = crossover(ours, theirs, rng, valid)
        if one != ours or other != theirs or first == second or len(ours) < 2:
            return _assembly(one), _assembly(other)
        cut = int(rng.integers(1, len(ours)))
        children = (_assembly(ours[:cut] + theirs[cut:]), _assembly(theirs[:cut] + ours[cut:]))
        mended = [mend_assembly(child, self._tiling, rng) for child in children]
        first, second = (
            child if isinstance(child, Assembly) else parent
            for child, parent in zip(mended, (first, second), strict=True)
        )
        return first, second

    def mutate(self, genotype: Assembly, rng: np.random.Generator) -> Assembly:
        """Exchange a part for another one of its name, or draw an attachment anew; mend what no longer fits."""
        exchanged = rng.random() < self._genome.exchange or not genotype.joins
        place = int(rng.integers(0, len(genotype.parts) if exchanged else len(genotype.joins)))
        if exchanged:
            others = [one for one in self._parts[list(self._parts)[place]] if one != genotype.parts[place]]
            if others:
                chosen = others[int(rng.integers(0, len(others)))]
                parts = (*genotype.parts[:place], chosen, *genotype.parts[place + 1 :])
                changed = mend_assembly(Assembly(parts, genotype.joins), self._tiling, rng)
                return changed if isinstance(changed, Assembly) else genotype
            place = min(place, len(genotype.joins) - 1)
        if place < 0:
            return genotype
        changed = redraw_assembly(genotype, place, self._tiling, rng)
        return changed if isinstance(changed, Assembly) else genotype

    def decode(self, text: str) -> Assembly:
        """Read a plan."""
        return decode_assembly(text)

    def offer(self, genotype: Assembly, kind: ChannelKind) -> str:
        """Give a named part to components, a demand to partners, the solid that it fills to surroundings."""
        if kind == "components":
            return part_text(self._name, genotype)
        if kind == "migrants":
            return encode(genotype)
        layout = self.layout(genotype)
        if isinstance(layout, Failure):
            raise InputError("offer", "a genotype that grows to a plan", str(layout))
        if kind == "surroundings":
            return mesh_text(*raised(layout.plan, STOREY))
        parts = dict(zip(self._genome.parts, (one.genotype for one in genotype.parts), strict=True))
        return demand_text(met(layout), parts)

    def write_forms(self, genotype: Assembly, stem: Path, formats: Sequence[str], facts: Facts) -> list[Path]:
        """Draw a plan; see :mod:`islands.kinds.plans`."""
        return write_plans(genotype, form_of(genotype, self._tiling), self._brief, stem, formats, facts)

    def layout(self, genotype: Assembly) -> Layout | Failure:
        """Grow a plan and lay it out for its brief."""
        names = list(self._genome.parts.values())
        for part, rooms in zip(genotype.parts, names, strict=True):
            inner = part.genotype
            count = 1 if isinstance(inner, Room) else len(inner.rooms())
            if count != len(rooms):
                return Failure("parts", f"a part of {count} rooms where {len(rooms)} are expected: {', '.join(rooms)}")
        plan = form_of(genotype, self._tiling)
        return plan if isinstance(plan, Failure) else laid_out(plan, self._brief)

    def scored(self, genotype: Assembly, partners: tuple[Migrant, ...]) -> Evaluation:
        """Conjoin the parts and judge the plan, by what the islands above use and miss, too."""
        started = self._clock()
        layout = self.layout(genotype)
        if isinstance(layout, Failure):
            return self._scoring.failed(layout, started)
        grown = self._clock()
        more = {FRESH: freshness(layout.plan, self._name, partners)}
        return self._eliminated(self._scoring.of(layout, more, started, grown))

    def _eliminated(self, found: Evaluation) -> Evaluation:
        """Make a plan invalid that falls short of what is required; its scores stay."""
        scores = dict(found.scores)
        for name, least in self._growth.required.items():
            if name in scores and scores[name] < least:
                why = str(Failure("constraint", f"{name} {scores[name]:g} where {least:g} is required"))
                return Evaluation(None, found.scores, why, found.growth_ms, found.evaluation_ms, found.notes)
        return found


def _in_order(brief: Brief, rooms: Sequence[str], spec: IslandSpec) -> Brief:
    """Give the brief with its rooms in the order of the parts.

    Raises
    ------
    InputError
        Where one has rooms that the other has not.
    """
    for name in rooms:
        if name not in brief.rooms:
            remedy = near(name, list(brief.rooms))
            raise InputError(spec.where("genome", "parts"), "rooms of the brief", f"'{name}'", remedy)
    for name in brief.rooms:
        if name not in rooms:
            raise InputError(spec.where("genome", "parts"), "each room of the brief", f"none named '{name}'")
    return brief.model_copy(update={"rooms": {name: brief.rooms[name] for name in rooms}})


def _genes(assembly: Assembly) -> tuple[Part | Attachment, ...]:
    """Give the sites of crossover: the first part, then each part and its attachment (Rosenman 1997, Figure 6)."""
    genes: list[Part | Attachment] = [assembly.parts[0]]
    for part, join in zip(assembly.parts[1:], assembly.joins, strict=True):
        genes += [part, join]
    return tuple(genes)


def _assembly(genes: Sequence[Part | Attachment]) -> Assembly:
    parts = tuple(one for one in genes if isinstance(one, Part))
    joins = tuple(one for one in genes if isinstance(one, Attachment))
    return Assembly(parts, joins)


class AssemblyKind(ABC):
    """What the kinds of zones and houses share."""

    genome: ClassVar[type[Settings]] = AssemblyGenome
    growth: ClassVar[type[Settings]] = AssemblyGrowth
    variation: ClassVar[frozenset[str]] = frozenset({"exchange"})
    needs: ClassVar[tuple[ChannelKind, ...]] = ("components",)

    @abstractmethod
    def gives(self, spec: IslandSpec) -> Mapping[ChannelKind, str]:
        """Say what it gives."""

    def takes(self, spec: IslandSpec) -> Mapping[ChannelKind, tuple[str, ...]]:
        """Take the parts, and what is asked for from above."""
        return {"components": _parts_of(spec), "partners": (DEMAND,)}

    def needed(self, spec: IslandSpec) -> Mapping[ChannelKind, tuple[str, ...]]:
        """Give each part."""
        return {"components": _parts_of(spec)}

    def compile_kernels(self) -> None:
        """Compile the growth's and the criteria's."""
        from evaluators.plans.warm import compile_kernels

        compile_kernels()

    def build(self, spec: IslandSpec, clock: Clock) -> AssemblyBiology:
        """Check the parts against the brief, and find the criteria."""
        return AssemblyBiology(spec, clock)

    def keep_files(self, spec: IslandSpec, keep: Keep) -> tuple[Mapping[str, Any], Mapping[str, Any]]:
        """Keep nothing: no setting names a file."""
        del keep
        return spec.genome, spec.growth


def _parts_of(spec: IslandSpec) -> tuple[str, ...]:
    return tuple(f"part {name}" for name in spec.genome["parts"])
