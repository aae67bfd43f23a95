"""The island: a deme that evolves, as a pure function of its state and of who arrives.

``advance`` reads nothing but its arguments and the island's own fixed settings, and draws from streams named by
(island, purpose, epoch): the same state and the same arrivals give the same result, bit for bit, in any process.
Only the clock's columns differ from run to run.

An epoch goes so: what channels of partners, components and surroundings bring is taken in, and where that changes how
members score, the deme is scored again; then migrants join; then generations are bred; then each edge's packet is made.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from operator import itemgetter
from typing import Final, Generic, TypeVar, final

from growth.protocol import Clock
from islands.algorithms.breeding import Birth, breed
from islands.algorithms.scheme import SCHEMES
from islands.context import Contexts
from islands.figures import figures
from islands.holdings import NOTHING, Holdings, archived, taken_in
from islands.individual import Individual
from islands.kinds.protocol import Biology
from islands.migration.channel import Channel, Edge, Migrant, Packet
from islands.migration.departures import Bundle, Departures, Standing, bundled
from islands.migration.gate import Adapters, Gate
from islands.migration.routes import Routes
from islands.records import Crossing
from islands.registrar import Registrar
from islands.selection import ranked
from islands.spec import IslandSpec
from islands.state import Advance, Deme, State
from islands.streams import EpochStreams, Purpose

__all__ = ["Advance", "Island", "Pulse", "State"]

G = TypeVar("G")
Pulse = Callable[[], None]
Arrived = tuple[Edge, Packet]

_ORDER: Final = itemgetter(*map(Packet._fields.index, ("channel", "source", "epoch")))


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
    adapters
        The built adapters of the edges that end here and have one; see
        :func:`islands.migration.adapters.adapters_into`.
    """

    def __init__(
        self,
        spec: IslandSpec,
        biology: Biology[G],
        seed: int,
        routes: Routes,
        clock: Clock,
        pulse: Pulse,
        adapters: Adapters | None = None,
    ) -> None:
        self.spec: Final = spec
        self.biology: Final = biology
        self._seed: Final = seed
        self._routes: Final = routes
        self._clock: Final = clock
        self._pulse: Final = pulse
        self._adapters: Final[Adapters] = adapters or {}
        self._scheme: Final = SCHEMES[spec.algorithm.name]
        self._contexts: Final = Contexts(biology, routes.channels_into(spec.number))
        # Edges as they are looked up, and the routes' own tuple that they were made of.
        self._doors: tuple[tuple[Edge, ...], Mapping[tuple[int, int], Edge]] = ((), {})
        self._bundles: tuple[tuple[Edge, ...], tuple[Bundle, ...]] = ((), ())

    def begin(self) -> Advance[G]:
        """Make and score the first population: epoch 0, generation 0."""
        started = self._clock()
        streams = EpochStreams(self._seed, self.spec.number, 0)
        registrar = Registrar(self.spec.number, 0, 0, 0, self._contexts.alone, streams, self._pulse)
        deme = self._settled_anew(registrar, streams)
        diversity = self._summarise(deme, registrar, started)
        best = registrar.generations[-1].best
        return self._ended(State(deme, 0, 0, registrar.counter, best), diversity, registrar, streams)

    def advance(self, state: State[G], generations: int, arrivals: Sequence[Packet]) -> Advance[G]:
        """Take in what arrived and breed one epoch of ``generations`` generations.

        Parameters
        ----------
        state
            The state at the end of the epoch before.
        generations
            How many to breed, at least 1.
        arrivals
            Packets in any order; they are taken in by channel, then source, then the epoch that they were sent in.
        """
        started = self._clock()
        number, epoch = self.spec.number, state.epoch + 1
        streams = EpochStreams(self._seed, number, epoch)
        context = self._contexts.alone
        registrar = Registrar(number, epoch, state.generation, state.counter, context, streams, self._pulse)
        deme, held, best, stagnant = state.deme, state.held, state.best, state.stagnant
        migrants, others = self._sorted(arrivals)
        if others or held is not NOTHING:
            held = self._taken_in(held, others, registrar)
            deme, best = self._rescored(state, held, registrar, streams, told=bool(others))
        if migrants:
            gate = Gate(deme, self.spec.population, registrar, streams, self._adapters)
            for edge, packet in migrants:
                gate.enter(edge, packet)
            deme = gate.deme()
        diversity = None
        for _ in range(generations):
            registrar.generation += 1
            deme = self._bred(deme, registrar, streams)
            diversity = self._summarise(deme, registrar, started)
            started, stagnant = self._clock(), stagnant + 1
            now = registrar.generations[-1].best
            if now is not None and (best is None or now > best):
                best, stagnant = now, 0
        after = State(deme, epoch, registrar.generation, registrar.counter, best, stagnant, held)
        return self._ended(after, diversity, registrar, streams)

    # -- arriving ------------------------------------------------------------------------------------------------

    def _sorted(self, arrivals: Sequence[Packet]) -> tuple[list[Arrived], list[Arrived]]:
        """Give the packets that hold anything with their edges, in order: those of migrants, and the others."""
        migrants: list[Arrived] = []
        others: list[Arrived] = []
        for packet in sorted(arrivals, key=_ORDER):
            if packet.migrants:
                edge = self._edge(packet)
                (migrants if edge.channel.kind == "migrants" else others).append((edge, packet))
        return migrants, others

    def _edge(self, packet: Packet) -> Edge:
        edges = self._routes.incoming(self.spec.number, packet.epoch)
        if self._doors[0] is not edges:
            self._doors = (edges, {(edge.channel.number, edge.source): edge for edge in edges})
        return self._doors[1][packet.channel, packet.source]

    def _taken_in(self, held: Holdings, others: Sequence[Arrived], registrar: Registrar[G]) -> Holdings:
        """Take in partners, components and surroundings, a row each."""
        shown: dict[Channel, list[Migrant]] = {}
        for edge, packet in others:
            channel = edge.channel
            held, reasons = taken_in(held, channel, packet)
            ends = (registrar.epoch, channel.name, channel.kind, edge.source_name, edge.target_name)
            for one, reason in zip(packet.migrants, reasons, strict=True):
                registrar.crossings.append(Crossing(*ends, one.id, one.fitness, not reason, reason))
            if channel.kind == "partners":
                shown.setdefault(channel, []).extend(packet.migrants)
        for channel, partners in shown.items():
            held = archived(held, channel, partners)
        return held

    def _rescored(
        self, state: State[G], held: Holdings, registrar: Registrar[G], streams: EpochStreams, *, told: bool
    ) -> tuple[Deme[G], float | None]:
        """Make the epoch's context; where it scores otherwise than the last one, score the deme again.

        Gives the deme and its best so far: once the scores are others, those of before are no measure.
        """
        context = registrar.context = self._contexts.of(held, streams)
        if context.mishap and told:
            registrar.note("holdings", {"detail": context.mishap})
        if context.scoring == (state.scoring or self._contexts.alone.scoring):
            return state.deme, state.best
        among = self._contexts.among(held).scoring
        alike = (state.scoring or among) == among or state.scoring.startswith(f"{among}+")
        reason = "partners" if alike else "surroundings"
        deme = tuple(registrar.score_again(one.id, one.genotype, reason, one.since) for one in state.deme)
        return deme, max((one.fitness for one in deme if one.fitness is not None), default=None)

    # -- breeding ------------------------------------------------------------------------------------------------

    def _bred(self, deme: Deme[G], registrar: Registrar[G], streams: EpochStreams) -> Deme[G]:
        """Give the deme of the next generation; where all have moved away, it is settled anew."""
        if not deme:
            return self._settled_anew(registrar, streams)
        settings, population = self.spec.algorithm, self.spec.population
        order = ranked(deme)
        count = self._scheme.offspring(settings, population, len(order))
        births = breed(registrar.context.biology, order, count, settings, streams)
        children = [registrar.bear(birth) for birth in births]
        return self._scheme.survivors(settings, population, order, children)

    def _settled_anew(self, registrar: Registrar[G], streams: EpochStreams) -> Deme[G]:
        biology, rng = registrar.context.biology, streams(Purpose.INITIAL)
        births: list[Birth[G]] = [Birth(biology.random(rng), (), "random") for _ in range(self.spec.population)]
        return tuple([registrar.bear(birth) for birth in births])

    def _summarise(self, deme: Sequence[Individual[G]], registrar: Registrar[G], started: float) -> float | None:
        """Record the generation, and give the deme's diversity."""
        diversity = self.biology.diversity([member.genotype for member in deme])
        evaluations, registrar.evaluations = registrar.evaluations, 0
        wall = (self._clock() - started) * 1e3
        registrar.generations.append(figures(deme, registrar.generation, registrar.epoch, evaluations, diversity, wall))
        return diversity

    # -- leaving -------------------------------------------------------------------------------------------------

    def _ended(
        self, state: State[G], diversity: float | None, registrar: Registrar[G], streams: EpochStreams
    ) -> Advance[G]:
        """Make the packets, take those who moved out of the deme, and give what the epoch made."""
        edges = self._routes.outgoing(self.spec.number, state.epoch)
        if self._bundles[0] is not edges:
            self._bundles = (edges, bundled(edges))
        context, deme = registrar.context, state.deme
        packets: tuple[Packet, ...] = ()
        if edges:
            standing = Standing(state.epoch, state.stagnant, diversity, context.scoring)
            leaving = Departures(deme, context.biology, standing, streams)
            packets = leaving.packets(self._bundles[1])
            for identity, why in leaving.mishaps:
                registrar.note("offer", {"id": identity, "detail": why})
            if leaving.gone:
                deme = tuple(member for member in deme if member.id not in leaving.gone)
        after = State(
            deme, state.epoch, state.generation, state.counter, state.best, state.stagnant, state.held, context.scoring
        )
        return Advance(after, packets, registrar.records())
