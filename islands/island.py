"""The island: a deme that evolves, as a pure function of its state and of who arrives.

``advance`` reads nothing but its arguments and the island's own fixed settings, and draws from streams named by
(island, purpose, epoch): the same state and the same arrivals give the same result, bit for bit, in any process.
Only the clock's columns differ from run to run.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Final, Generic, TypeVar, final

import numpy as np

from growth.protocol import Clock
from islands.individual import Evaluation, Individual, Origin, make_id
from islands.kinds.protocol import Biology
from islands.migration.channel import Channel, Migrant, Packet
from islands.migration.emigrants import emigrants
from islands.migration.replacement import REPLACERS, beats
from islands.migration.routes import Routes
from islands.records import Born, Crossing, Generation, Note, Records, Rescored
from islands.scoring import scored
from islands.selection import ranked, tournaments
from islands.spec import IslandSpec
from islands.streams import Purpose, stream

G = TypeVar("G")
Deme = tuple[Individual[G], ...]
Pulse = Callable[[], None]


@dataclass(frozen=True, slots=True)
class State(Generic[G]):
    """All that an island carries from one epoch to the next.

    Attributes
    ----------
    deme
        Its members.
    epoch, generation
        The last ones finished; both 0 once the first population is scored.
    counter
        How many individuals it has bred.
    """

    deme: Deme[G]
    epoch: int
    generation: int
    counter: int


@dataclass(frozen=True, slots=True)
class Advance(Generic[G]):
    """What an epoch made: the next state, one packet for each outgoing edge, and the records."""

    state: State[G]
    departures: tuple[Packet, ...]
    records: Records


@dataclass(slots=True)
class _Scribe:
    """Collects the records of one call."""

    born: list[Born] = field(default_factory=list)
    rescored: list[Rescored] = field(default_factory=list)
    generations: list[Generation] = field(default_factory=list)
    crossings: list[Crossing] = field(default_factory=list)
    notes: list[Note] = field(default_factory=list)

    def records(self) -> Records:
        return Records(
            tuple(self.born),
            tuple(self.rescored),
            tuple(self.generations),
            tuple(self.crossings),
            tuple(self.notes),
        )


@dataclass(frozen=True, slots=True)
class _Birth(Generic[G]):
    genotype: G
    parents: tuple[int, ...]
    origin: Origin


@final
class Island(Generic[G]):
    """One island of a run.

    Parameters
    ----------
    spec
        Its settings.
    biology
        How it breeds and scores.
    seed
        The run's seed.
    routes
        The edges of the run, those that begin or end here at least.
    clock
        For the ``*_ms`` columns alone.
    pulse
        Called before each scoring; it may raise to abandon the epoch, which leaves the state as it was.
    """

    def __init__(
        self, spec: IslandSpec, biology: Biology[G], seed: int, routes: Routes, clock: Clock, pulse: Pulse
    ) -> None:
        self.spec: Final = spec
        self.biology: Final = biology
        self._seed: Final = seed
        self._routes: Final = routes
        self._clock: Final = clock
        self._pulse: Final = pulse

    def begin(self) -> Advance[G]:
        """Make and score the first population: epoch 0, generation 0."""
        scribe = _Scribe()
        started = self._clock()
        rng = stream(self._seed, self.spec.number, Purpose.INITIAL, 0)
        births = [_Birth(self.biology.random(rng), (), "random") for _ in range(self.spec.population)]
        empty: State[G] = State((), 0, 0, 0)
        state = self._born(births, empty, (), scribe)
        self._summarise(state, len(births), started, scribe)
        return Advance(state, self._departures(state), scribe.records())

    def advance(self, state: State[G], generations: int, arrivals: Sequence[Packet]) -> Advance[G]:
        """Let migrants join and breed one epoch of ``generations`` generations.

        Parameters
        ----------
        state
            The state at the end of the epoch before.
        generations
            How many to breed, at least 1.
        arrivals
            The packets of that epoch's end, in any order: they join in the order of channel, then of source.
        """
        scribe = _Scribe()
        started = self._clock()
        state = State(state.deme, state.epoch + 1, state.generation, state.counter)
        deme, rescored = self._arrive(state, arrivals, scribe)
        state = State(deme, state.epoch, state.generation, state.counter)
        chance = stream(self._seed, self.spec.number, Purpose.SELECTION, state.epoch)
        change = stream(self._seed, self.spec.number, Purpose.VARIATION, state.epoch)
        for _ in range(generations):
            order = ranked(state.deme)
            elite = tuple(order[: self.spec.algorithm.elite])
            births = self._breed(order, self.spec.population - len(elite), chance, change)
            following = State(state.deme, state.epoch, state.generation + 1, state.counter)
            state = self._born(births, following, elite, scribe)
            self._summarise(state, len(births) + rescored, started, scribe)
            started, rescored = self._clock(), 0
        return Advance(state, self._departures(state), scribe.records())

    # -- breeding ------------------------------------------------------------------------------------------------

    def _breed(
        self, order: Sequence[Individual[G]], count: int, chance: np.random.Generator, change: np.random.Generator
    ) -> list[_Birth[G]]:
        """Make ``count`` offspring, pair by pair; of an odd pair the second is dropped."""
        settings = self.spec.algorithm
        pairs = (count + 1) // 2
        places = tournaments(len(order), settings.tournament, 2 * pairs, chance).tolist()
        crossed = (change.random(pairs) < settings.crossover).tolist()
        mutated = (change.random(2 * pairs) < settings.mutation).tolist()
        births: list[_Birth[G]] = []
        for pair in range(pairs):
            mates = order[places[2 * pair]], order[places[2 * pair + 1]]
            genotypes = mates[0].genotype, mates[1].genotype
            if crossed[pair]:
                genotypes = self.biology.crossover(*genotypes, change)
            both = (mates[0].id,) if mates[0].id == mates[1].id else (mates[0].id, mates[1].id)
            for side in (0, 1):
                genotype, changed = genotypes[side], mutated[2 * pair + side] or not crossed[pair]
                if changed:
                    genotype = self.biology.mutate(genotype, change)
                origin: Origin = "mutation"
                if crossed[pair]:
                    origin = "crossover+mutation" if changed else "crossover"
                births.append(_Birth(genotype, both if crossed[pair] else (mates[side].id,), origin))
        return births[:count]

    def _born(self, births: Sequence[_Birth[G]], state: State[G], elite: Deme[G], scribe: _Scribe) -> State[G]:
        """Score the newborn and give the state in which they and the elite are the deme."""
        children = []
        for place, birth in enumerate(births):
            identity = make_id(self.spec.number, state.counter + place)
            found = self._score(birth.genotype, identity, state.epoch, scribe)
            children.append(Individual(identity, birth.genotype, found.fitness, found.scores, found.error))
            text = self.biology.encode(birth.genotype)
            row = (state.generation, state.epoch, identity, birth.parents, (), (), birth.origin, text)
            scribe.born.append(
                Born(*row, found.fitness, found.scores, found.error, found.growth_ms, found.evaluation_ms)
            )
        return State((*elite, *children), state.epoch, state.generation, state.counter + len(births))

    def _score(self, genotype: G, identity: int, epoch: int, scribe: _Scribe) -> Evaluation:
        self._pulse()
        found = scored(self.biology, genotype)
        for kind, detail in found.notes:
            scribe.notes.append(Note(epoch, kind, {"id": identity, **detail}))
        return found

    def _summarise(self, state: State[G], evaluations: int, started: float, scribe: _Scribe) -> None:
        """Record the generation: figures over the valid members, summed exactly so that no order matters."""
        fitness = [member.fitness for member in state.deme if member.fitness is not None]
        best = mean = std = worst = None
        if fitness:
            best, worst = max(fitness), min(fitness)
            mean = math.fsum(fitness) / len(fitness)
            std = math.sqrt(math.fsum((value - mean) ** 2 for value in fitness) / len(fitness))
        diversity = self.biology.diversity([member.genotype for member in state.deme])
        invalid = len(state.deme) - len(fitness)
        figures = (evaluations, best, mean, std, worst, diversity, invalid)
        wall = (self._clock() - started) * 1e3
        scribe.generations.append(Generation(state.generation, state.epoch, *figures, wall))

    # -- migration -----------------------------------------------------------------------------------------------

    def _departures(self, state: State[G]) -> tuple[Packet, ...]:
        outgoing = self._routes.outgoing(self.spec.number, state.epoch)
        order = ranked(state.deme) if any(edge.channel.carries(state.epoch) for edge in outgoing) else []
        packets = []
        for edge in outgoing:
            migrants: tuple[Migrant, ...] = ()
            if edge.channel.carries(state.epoch):
                extra = (edge.channel.number, edge.target)
                rng = stream(self._seed, self.spec.number, Purpose.EMIGRANTS, state.epoch, *extra)
                migrants = tuple(self._leave(member) for member in emigrants(order, edge.channel, rng))
            packet = (edge.channel.number, edge.source, edge.target, state.epoch, self.biology.scoring, migrants)
            packets.append(Packet(*packet))
        return tuple(packets)

    def _leave(self, member: Individual[G]) -> Migrant:
        return Migrant(member.id, self.biology.encode(member.genotype), member.fitness, member.scores, member.error)

    def _arrive(self, state: State[G], arrivals: Sequence[Packet], scribe: _Scribe) -> tuple[Deme[G], int]:
        """Give the deme once the packets' migrants stood at its gate, and how many of them were scored again."""
        residents = ranked(state.deme)
        settled: list[Individual[G]] = []
        rescored_before = len(scribe.rescored)
        streams: dict[int, np.random.Generator] = {}
        for packet in sorted(arrivals, key=lambda packet: (packet.channel, packet.source)):
            incoming = self._routes.incoming(self.spec.number, packet.epoch)
            edge = next(e for e in incoming if (e.channel.number, e.source) == (packet.channel, packet.source))
            number = edge.channel.number
            if number not in streams:
                streams[number] = stream(self._seed, self.spec.number, Purpose.REPLACEMENT, state.epoch, number)
            for migrant in packet.migrants:
                reason = self._admit(migrant, packet, edge.channel, state, residents, settled, streams[number], scribe)
                row = (state.epoch, edge.channel.name, edge.channel.kind, edge.source_name, edge.target_name)
                scribe.crossings.append(Crossing(*row, migrant.id, migrant.fitness, reason == "", reason))
        return (*residents, *settled), len(scribe.rescored) - rescored_before

    def _admit(
        self,
        migrant: Migrant,
        packet: Packet,
        channel: Channel,
        state: State[G],
        residents: list[Individual[G]],
        settled: list[Individual[G]],
        rng: np.random.Generator,
        scribe: _Scribe,
    ) -> str:
        """Let one migrant in, in place of a resident, or give the reason why not.

        Those who came in this epoch are no residents yet: a packet of k takes k places.
        """
        if any(member.id == migrant.id for member in (*residents, *settled)):
            return "already in deme"
        if not residents:
            return "no place left"
        newcomer = self._welcome(migrant, packet, state, scribe)
        place = REPLACERS[channel.replace](len(residents), rng)
        if channel.accept == "better" and not beats(newcomer, residents[place]):
            return "not better"
        residents.pop(place)
        settled.append(newcomer)
        return ""

    def _welcome(self, migrant: Migrant, packet: Packet, state: State[G], scribe: _Scribe) -> Individual[G]:
        """Make a member of the migrant, scored again where this island scores otherwise than its source."""
        genotype = self.biology.decode(migrant.text)
        if packet.scoring == self.biology.scoring:
            return Individual(migrant.id, genotype, migrant.fitness, migrant.scores, migrant.error)
        found = self._score(genotype, migrant.id, state.epoch, scribe)
        row = (state.generation, state.epoch, migrant.id, "migrant", found.fitness, found.scores, ())
        scribe.rescored.append(Rescored(*row, found.error, found.growth_ms + found.evaluation_ms))
        return Individual(migrant.id, genotype, found.fitness, found.scores, found.error)
