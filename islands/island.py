"""The island: a deme that evolves, as a pure function of its state and of who arrives.

``advance`` reads nothing but its arguments and the island's own fixed settings, and draws from streams named by
(island, purpose, epoch): the same state and the same arrivals give the same result, bit for bit, in any process.
Only the clock's columns differ from run to run.

An epoch goes so: interventions that begin with it change goals, rates and members; what channels of partners,
components and surroundings bring is taken in, and where any of that changes how members score, the deme is scored
again; those who are inserted join, then migrants; then generations are bred; then what is watched is measured, and
each edge's packet is made.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from operator import itemgetter
from typing import Final, Generic, TypeVar, final

from growth.protocol import Clock
from islands.algorithms.breeding import Birth, breed
from islands.algorithms.scheme import SCHEMES
from islands.biologies import Biologies
from islands.context import Context
from islands.figures import figures
from islands.holdings import NOTHING, Holdings
from islands.individual import Individual
from islands.interventions.intervention import Intervention, Subject, concerning
from islands.interventions.registry import changed, joined
from islands.kinds.protocol import Biology, is_ready
from islands.migration.channel import Edge, Packet
from islands.migration.departures import Bundle, Departures, Standing, bundled
from islands.migration.gate import Adapters, Gate
from islands.migration.routes import Routes
from islands.reception import Arrived, reason_of, received, rescored, steered_reason
from islands.regime import Build, Regimes
from islands.registrar import Registrar
from islands.selection import different, ranked
from islands.sharing import judged, survivors
from islands.spec import IslandSpec
from islands.state import Advance, Deme, State
from islands.steered import Steered
from islands.streams import EpochStreams, Purpose
from islands.watch import Watcher

__all__ = ["Advance", "Island", "Pulse", "State"]

G = TypeVar("G")
Pulse = Callable[[], None]

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
    build
        Makes the biology of goals or strengths that were steered; islands that share one share what it makes.
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
        build: Build | None = None,
    ) -> None:
        self.spec: Final = spec
        self.biology: Final = biology
        self._seed: Final = seed
        self._routes: Final = routes
        self._clock: Final = clock
        self._pulse: Final = pulse
        self._adapters: Final[Adapters] = adapters or {}
        self._scheme: Final = SCHEMES[spec.algorithm.name]
        into = routes.channels_into(spec.number)
        self._regimes: Final = Regimes(spec, biology, into, build or Biologies(clock))
        self._watcher: Final[Watcher[G]] = Watcher(into, pulse)
        # Edges as they are looked up, and the routes' own tuple that they were made of.
        self._doors: tuple[tuple[Edge, ...], Mapping[tuple[int, int], Edge]] = ((), {})
        self._bundles: tuple[tuple[Edge, ...], tuple[Bundle, ...]] = ((), ())

    def begin(self, epoch: int = 0) -> Advance[G]:
        """Make and score the first population: generation 0, in epoch 0, or in that in which the island is added."""
        started = self._clock()
        streams = EpochStreams(self._seed, self.spec.number, epoch)
        context = self._regimes.usual.contexts.alone
        registrar = self._registrar(epoch, 0, 0, context, streams)
        if not is_ready(context.biology):
            registrar.note("waiting", {"detail": "no parts of each name yet"})
            return self._ended(State((), epoch, 0, 0), None, registrar, streams)
        deme = self._settled_anew(registrar, streams)
        diversity = self._summarise(deme, registrar, started)
        best = registrar.generations[-1].best
        return self._ended(State(deme, epoch, 0, registrar.counter, best), diversity, registrar, streams)

    def advance(
        self,
        state: State[G],
        generations: int,
        arrivals: Sequence[Packet],
        interventions: Sequence[Intervention] = (),
    ) -> Advance[G]:
        """Take in what arrived and breed one epoch of ``generations`` generations.

        Parameters
        ----------
        state
            The state at the end of the epoch before.
        generations
            How many to breed, at least 1.
        arrivals
            Packets in any order; they are taken in by channel, then source, then the epoch that they were sent in.
        interventions
            Those that take effect in this epoch, in their order; what is for other islands is passed over.
        """
        started = self._clock()
        number, epoch = self.spec.number, state.epoch + 1
        streams = EpochStreams(self._seed, number, epoch)
        context = self._regimes.of(state.steered).contexts.alone
        registrar = self._registrar(epoch, state.generation, state.counter, context, streams)
        own = concerning(interventions, self.spec.name)
        migrants, others = self._sorted(arrivals)
        subject, held, best = self._settled(state, own, others, registrar)
        deme, steered, stagnant = subject.deme, subject.steered, state.stagnant
        if migrants:
            gate = Gate(deme, self.spec.population, registrar, streams, self._adapters, steered)
            for edge, packet in migrants:
                gate.enter(edge, packet)
            deme = gate.deme()
        diversity = None
        if not registrar.counter and not deme and is_ready(registrar.context.biology):
            deme = self._settled_anew(registrar, streams)
            diversity = self._summarise(deme, registrar, started)
            started, best = self._clock(), registrar.generations[-1].best
        for _ in range(self._due(state, deme, generations, registrar)):
            registrar.generation += 1
            if self._is_renewed(registrar.generation, steered):
                deme, stagnant = self._renewed(deme, steered, registrar, streams), 0
            else:
                deme = self._bred(deme, steered, registrar, streams)
            diversity = self._summarise(deme, registrar, started)
            started, stagnant = self._clock(), stagnant + 1
            now = registrar.generations[-1].best
            if now is not None and (best is None or now > best):
                best, stagnant = now, 0
        watched, details = self._watcher.look(deme, registrar.context, held, state.watched)
        for detail in details:
            registrar.note("coevolution", detail)
        after = State(deme, epoch, registrar.generation, registrar.counter, best, stagnant, held, "", steered, watched)
        return self._ended(after, diversity, registrar, streams)

    def context(self, state: State[G]) -> Context[G]:
        """Give the context in which the members of a state are scored."""
        usual = self._regimes.of(state.steered).contexts
        if state.held == NOTHING:
            return usual.alone
        streams = EpochStreams(self._seed, self.spec.number, state.epoch)
        return usual.of(state.held, streams, self._routes.live(self.spec.number, state.epoch - 1))

    def _registrar(
        self, epoch: int, generation: int, counter: int, context: Context[G], streams: EpochStreams
    ) -> Registrar[G]:
        sharing = self.spec.algorithm.sharing != "none"
        return Registrar(self.spec.number, epoch, generation, counter, context, streams, self._pulse, sharing=sharing)

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

    def _settled(
        self, state: State[G], interventions: Sequence[Intervention], others: Sequence[Arrived], registrar: Registrar[G]
    ) -> tuple[Subject[G], Holdings, float | None]:
        """Let interventions, and all that arrived but migrants, take effect.

        Gives the island as it is then, what it holds, and its best so far: once the scores are others, those of before
        are no measure.
        """
        subject = changed(Subject(self.spec, state.deme, state.steered), interventions, registrar)
        held, best = state.held, state.best
        is_measure_new = subject.steered.measure != state.steered.measure
        if others or held is not NOTHING or is_measure_new:
            live = self._routes.live(self.spec.number, state.epoch)
            held = received(held if live is None else held.only(live), others, registrar)
            contexts = self._regimes.of(subject.steered).contexts
            context = registrar.context = contexts.of(held, registrar.streams, live)
            if context.mishap and others:
                registrar.note("holdings", {"detail": context.mishap})
            if context.scoring != (state.scoring or self._regimes.usual.contexts.alone.scoring):
                reason = steered_reason(state.steered, subject.steered)
                reason = reason or reason_of(state.scoring, contexts.among(held).scoring)
                subject = subject._replace(deme=rescored(subject.deme, reason, registrar))
                best = max((one.fitness for one in subject.deme if one.fitness is not None), default=None)
        return joined(subject, interventions, registrar), held, best

    # -- breeding ------------------------------------------------------------------------------------------------

    def _due(self, state: State[G], deme: Deme[G], generations: int, registrar: Registrar[G]) -> int:
        """Give how many generations are to be bred: none while the island waits for parts, or once it rests."""
        if not deme and not is_ready(registrar.context.biology):
            return 0
        most = self.spec.epochs
        return 0 if most is not None and state.generation >= most * generations else generations

    def _is_renewed(self, generation: int, steered: Steered) -> bool:
        """Tell whether a new run of the algorithm begins with this generation."""
        every = self._regimes.of(steered).algorithm.restart
        return every is not None and generation > 1 and (generation - 1) % every == 0

    def _renewed(self, deme: Deme[G], steered: Steered, registrar: Registrar[G], streams: EpochStreams) -> Deme[G]:
        """Give a fresh population, in which the best different ones of before stay, and those who are locked."""
        locked = [one for one in deme if one.id in steered.locked]
        free = [one for one in ranked(deme, steered.promoted) if one.id not in steered.locked]
        count = min(self._regimes.of(steered).algorithm.restart_keep, self.spec.population - len(locked))
        kept = [*locked, *different(free, count, registrar.context.biology)]
        return (*kept, *self._settled_anew(registrar, streams, len(kept)))

    def _bred(self, deme: Deme[G], steered: Steered, registrar: Registrar[G], streams: EpochStreams) -> Deme[G]:
        """Give the deme of the next generation; where all have moved away, it is settled anew.

        Those who are locked breed with the others, and live beside those whom the algorithm lets live.
        """
        if not deme:
            return self._settled_anew(registrar, streams)
        settings = self._regimes.of(steered).algorithm
        order = free = ranked(judged(deme, settings), steered.promoted)
        kept: list[Individual[G]] = []
        if steered.locked:
            kept = [one for one in order if one.id in steered.locked]
            free = [one for one in order if one.id not in steered.locked]
        places = self.spec.population - len(kept)
        if not places:
            return deme
        count = self._scheme.offspring(settings, places, len(free))
        breeders = self._scheme.breeders(settings, self.spec.population, order)
        births = breed(registrar.context.biology, breeders, count, settings, streams)
        children = [registrar.bear(birth) for birth in births]
        if settings.sharing != "none":
            own = {one.id: one for one in deme}
            kept, free = [own[one.id] for one in kept], [own[one.id] for one in free]
        return (*kept, *survivors(self._scheme, settings, places, free, children, steered.promoted))

    def _settled_anew(self, registrar: Registrar[G], streams: EpochStreams, kept: int = 0) -> Deme[G]:
        biology, rng = registrar.context.biology, streams(Purpose.INITIAL)
        births: list[Birth[G]] = [Birth(biology.random(rng), (), "random") for _ in range(self.spec.population - kept)]
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
            leaving = Departures(deme, context.biology, standing, streams, state.steered)
            packets = leaving.packets(self._bundles[1])
            for identity, why in leaving.mishaps:
                registrar.note("offer", {"id": identity, "detail": why})
            if leaving.gone:
                deme = tuple(member for member in deme if member.id not in leaving.gone)
        steered = state.steered.among(one.id for one in deme)
        after = State(
            deme, state.epoch, state.generation, state.counter, state.best, state.stagnant, state.held,
            context.scoring, steered, state.watched,
        )  # fmt: skip
        return Advance(after, packets, registrar.records())
