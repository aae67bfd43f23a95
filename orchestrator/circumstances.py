"""What individuals of a log were scored in: the forms around them, and the partners that they were paired with.

An island's surroundings and partners are no columns of their own; they follow from who arrived, which the log tells. So
the circumstances of any epoch can be made again, and an individual scored as it was.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final, NamedTuple, TypeVar, final

from genome.errors import InputError
from islands.context import Context, Contexts
from islands.holdings import NOTHING, Held, Holdings
from islands.individual import Evaluation
from islands.kinds.protocol import Biology, Offering
from islands.migration.channel import Channel, ChannelKind, Migrant
from islands.migration.routes import Routes
from islands.pairings import combined
from islands.scoring import scored, scored_with
from islands.spec import IslandSpec
from islands.streams import EpochStreams
from orchestrator.folder import RunFolder
from orchestrator.plan import Plan
from orchestrator.query import ask

K = TypeVar("K")
V = TypeVar("V")

CAME: Final = """
    select channel, source, epoch, id, fitness from migrations
    where kind = '{kind}' and target = '{island}' and epoch <= {epoch}
"""
"""In the log's own order, which is that of arrival."""


class Came(NamedTuple):
    """One that arrived: on which channel, from which island, at the start of which epoch, its id and fitness there."""

    channel: str
    source: str
    epoch: int
    id: int
    fitness: float | None


@final
class Circumstances:
    """Makes the circumstances of a run's islands again.

    Parameters
    ----------
    folder
        The run.
    plan
        Its islands and edges.
    seed
        The run's seed.
    biology
        Gives the biology of an island that holds nothing, by its name.
    """

    def __init__(self, folder: RunFolder, plan: Plan, seed: int, biology: Callable[[str], Biology[Any]]) -> None:
        self._log: Final = folder.log
        self._specs: Final[dict[str, IslandSpec]] = {spec.name: spec for spec in plan.islands}
        self._routes: Final = Routes(plan.edges, plan.redrawn, seed)
        self._seed: Final = seed
        self._biology: Final = biology
        self._made: Final[dict[tuple[str, int], Context[Any]]] = {}
        self._partners: Final[dict[tuple[str, int], dict[tuple[str, int], Migrant]]] = {}

    def biology(self, island: str, epoch: int) -> Biology[Any]:
        """Give the biology of an island in the surroundings that it had in an epoch."""
        found: Biology[Any] = self._context(island, epoch).biology
        return found

    def score(self, island: str, epoch: int, genotype: str, partners: Sequence[int]) -> Evaluation:
        """Score a genotype as an island did in an epoch, with the partners of its pairings, pairing by pairing."""
        context = self._context(island, epoch)
        decoded = context.biology.decode(genotype)
        channels = self._channels(island, "partners")
        if not partners or context.symbiotic is None or not channels:
            return scored(context.biology, decoded)
        shown = self._shown(island, epoch)
        found = []
        for place in range(0, len(partners), len(channels)):
            pairing = zip(channels, partners[place : place + len(channels)], strict=True)
            together = tuple(_known(shown, (channel.name, one), one) for channel, one in pairing)
            found.append(scored_with(context.symbiotic, decoded, together))
        first = channels[0].pairing
        assert first is not None, "a channel of partners has a pairing"
        return combined(found, first)

    def _channels(self, island: str, kind: ChannelKind) -> list[Channel]:
        return [one for one in self._routes.channels_into(self._specs[island].number) if one.kind == kind]

    def _context(self, island: str, epoch: int) -> Context[Any]:
        """Give the context of an island in an epoch, its partners and parts aside."""
        if (island, epoch) not in self._made:
            channels = self._routes.channels_into(self._specs[island].number)
            held = self._surroundings(island, epoch) if self._channels(island, "surroundings") else NOTHING
            streams = EpochStreams(self._seed, self._specs[island].number, epoch)
            self._made[island, epoch] = Contexts(self._biology(island), channels).of(held, streams)
        return self._made[island, epoch]

    def _surroundings(self, island: str, epoch: int) -> Holdings:
        """Give the forms that an island held in an epoch: of each source those that came last."""
        channels = {one.name: one for one in self._channels(island, "surroundings")}
        came: dict[tuple[int, int], list[Came]] = {}
        for one in self._came(island, epoch, "surroundings"):
            key = channels[one.channel].number, self._specs[one.source].number
            before = came.setdefault(key, [])
            came[key] = [*before, one] if before and before[0].epoch == one.epoch else [one]
        held = []
        for (number, source), forms in sorted(came.items()):
            # Where several packets of one source came at once, the last of them counts.
            most = channels[forms[0].channel].size(self._specs[forms[0].source].population)
            last = {one.id: one for one in forms[-most:]}
            held.append(Held(number, source, self._travellers(list(last.values()), "surroundings")))
        return Holdings(surroundings=tuple(held))

    def _shown(self, island: str, epoch: int) -> dict[tuple[str, int], Migrant]:
        """Give by channel and id how partners were shown to an island last; of several sources by the best."""
        if (island, epoch) in self._partners:
            return self._partners[island, epoch]
        shown: dict[tuple[str, int], Came] = {}
        for one in self._came(island, epoch, "partners"):
            before = shown.get((one.channel, one.id))
            worse = before is not None and before.epoch == one.epoch and not _better(one, before)
            if not worse:
                shown[one.channel, one.id] = one
        found = dict(zip(shown, self._travellers(list(shown.values()), "partners"), strict=True))
        self._partners[island, epoch] = found
        return found

    def _came(self, island: str, epoch: int, kind: ChannelKind) -> list[Came]:
        sql = CAME.format(kind=kind, island=island, epoch=int(epoch))
        return [Came(*row) for row in ask(self._log, sql).rows]

    def _travellers(self, came: Sequence[Came], kind: ChannelKind) -> tuple[Migrant, ...]:
        """Give those who came as they travelled: with what their sources offered of them then."""
        ids = ", ".join(str(one.id) for one in came)
        genotypes = ask(self._log, f"select id, genotype, scores, error from individuals where id in ({ids})")  # noqa: S608
        known = {identity: rest for identity, *rest in genotypes.rows}
        found = []
        for one in came:
            text, scores, error = _known(known, one.id, one.id)
            # They left at the end of the epoch before (with the schedule async perhaps earlier, among other forms).
            source = self.biology(one.source, one.epoch - 1)
            offering: object = source
            if isinstance(offering, Offering):
                text = offering.offer(source.decode(text), kind)
            found.append(Migrant(one.id, text, one.fitness, tuple(sorted((scores or {}).items())), error))
        return tuple(found)


def _better(one: Came, other: Came) -> bool:
    return one.fitness is not None and (other.fitness is None or one.fitness > other.fitness)


def _known(found: Mapping[K, V], key: K, identity: int) -> V:
    """Give what the log has of one that arrived somewhere; a killed run's may lack it."""
    if key in found:
        return found[key]
    got = f"a log without {identity}, which was there"
    raise InputError("--id", "an individual whose partners and surroundings are in the log", got, "choose another")
