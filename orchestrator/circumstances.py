"""What individuals of a log were scored in: the forms around them, and the partners that they were paired with.

An island's surroundings and partners are no columns of their own; they follow from who arrived, which the log tells
(:mod:`orchestrator.history`). So what an island held in any epoch can be made again, by the functions that it made it
with, and an individual scored as it was. What one shows may hang on what surrounds it: everyone is made again as it
was shown then, among the forms of the island and the epoch that it was sent from.

Parts are left aside: a genotype carries its own.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence
from typing import Any, Final, final

from islands.context import Context, Contexts
from islands.holdings import NOTHING, Holdings, archived, taken_in
from islands.individual import Evaluation, merit
from islands.kinds.protocol import Biology, Offering, Situated
from islands.migration.channel import Channel, ChannelKind, Migrant, Packet
from islands.migration.routes import Routes
from islands.pairings import Side, Sides, combined, sides_of
from islands.scoring import scored, scored_with
from islands.spec import IslandSpec
from islands.streams import EpochStreams
from orchestrator.folder import RunFolder
from orchestrator.history import Came, History, Parcel, lacking
from orchestrator.plan import Plan

Marks = tuple[tuple[str, str, int], ...]
"""Packets of one island: channel, source, and the epoch at whose end each was sent."""

Key = tuple[str, str, Marks]
"""An island, how it scored while it held nothing, and the packets whose forms it had around it."""


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
    late
        As :class:`~orchestrator.history.History` takes it.
    biology
        Gives the biology of an island that holds nothing, by its name, and by its goals in an epoch.
    """

    def __init__(
        self, folder: RunFolder, plan: Plan, seed: int, late: bool, biology: Callable[[str, int], Biology[Any]]
    ) -> None:
        channels = [edge.channel for edge in plan.edges] + [redrawn.channel for redrawn in plan.redrawn]
        self._channels: Final = {channel.name: channel for channel in channels}
        numbers = {name: channel.number for name, channel in self._channels.items()}
        self._history: Final = History(folder.log, plan.islands, numbers, late)
        self._specs: Final[dict[str, IslandSpec]] = {spec.name: spec for spec in plan.islands}
        self._routes: Final = Routes(plan.edges, plan.redrawn, seed)
        self._seed: Final = seed
        self._biology: Final = biology
        self._made: Final[dict[Key, Context[Any]]] = {}
        self._texts: Final[dict[tuple[str, str, Marks, ChannelKind, int], str]] = {}
        self._companies: Final[dict[tuple[str, int], Sides | None]] = {}

    def biology(self, island: str, epoch: int) -> Biology[Any]:
        """Give the biology of an island in the surroundings that it had in an epoch."""
        found: Biology[Any] = self._context(island, epoch).biology
        return found

    def score(self, island: str, epoch: int, genotype: str, partners: Sequence[int]) -> Evaluation:
        """Score a genotype as an island did in an epoch, with the partners of its pairings, pairing by pairing.

        Raises
        ------
        InputError
            When the log does not have what it was scored in.
        """
        context = self._context(island, epoch)
        decoded = context.biology.decode(genotype)
        if not partners or context.symbiotic is None:
            return scored(context.biology, decoded)
        company, pairings = self._paired(island, epoch, partners)
        found = [scored_with(context.symbiotic, decoded, chosen) for chosen in pairings]
        return combined(found, company.pairing)

    def partners(self, island: str, epoch: int, partners: Sequence[int]) -> tuple[Migrant, ...]:
        """Give the partners of the first of an individual's pairings, as they were shown to its island in an epoch.

        Raises
        ------
        InputError
            When the log does not have them.
        """
        return self._paired(island, epoch, partners)[1][0] if partners else ()

    # -- surroundings --------------------------------------------------------------------------------------------

    def _context(self, island: str, epoch: int) -> Context[Any]:
        """Give the context of an island in an epoch, its partners and parts aside.

        It may hang on that of another island in an epoch before, and so on: those are made first, the earliest before
        all others.
        """
        pending = [(island, epoch)]
        while pending:
            name, then = pending[-1]
            around = self._around(name, then)
            key = self._key(name, then)
            before = [] if key in self._made else [(one.source, one.sent) for one in around]
            before = [(source, sent) for source, sent in before if self._key(source, sent) not in self._made]
            if before:
                pending += before
                continue
            if key not in self._made:
                self._made[key] = self._among(name, then, around)
            pending.pop()
        return self._made[self._key(island, epoch)]

    def _around(self, island: str, epoch: int) -> list[Parcel]:
        """Give the packets whose forms an island had around it in an epoch."""
        biology: object = self._biology(island, epoch)
        return self._shown(island, "surroundings", epoch) if isinstance(biology, Situated) else []

    def _shown(self, island: str, kind: ChannelKind, epoch: int) -> list[Parcel]:
        """Give the last that each source had brought an island, of edges that were there still."""
        found = self._history.last(island, kind, epoch)
        live = self._routes.live(self._specs[island].number, epoch - 1)
        if live is None:
            return found
        ways = [(self._channels[one.channel].number, self._specs[one.source].number) for one in found]
        return [one for one, way in zip(found, ways, strict=True) if way in live]

    def _key(self, island: str, epoch: int) -> Key:
        return island, self._biology(island, epoch).scoring, _marks(self._around(island, epoch))

    def _among(self, island: str, epoch: int, around: Sequence[Parcel]) -> Context[Any]:
        held = NOTHING
        for parcel in around:
            held = self._taken(held, island, parcel, "surroundings")
        return Contexts(self._biology(island, epoch), ()).among(held)

    # -- partners ------------------------------------------------------------------------------------------------

    def _company(self, island: str, epoch: int) -> Sides | None:
        """Give the partners that an island paired its members with in an epoch, or drew from for each of them."""
        if (island, epoch) not in self._companies:
            number = self._specs[island].number
            channels = [one for one in self._routes.channels_into(number) if one.kind == "partners"]
            live = self._routes.live(number, epoch - 1)
            if live is not None:
                channels = [one for one in channels if any(one.number == channel for channel, _ in live)]
            held = NOTHING
            for channel in channels:
                if channel.pairing is not None and channel.pairing.archive:
                    held = self._archived(held, island, epoch, channel)
            for parcel in self._shown(island, "partners", epoch):
                held = self._taken(held, island, parcel, "partners")
            self._companies[island, epoch] = sides_of(channels, held, EpochStreams(self._seed, number, epoch))
        return self._companies[island, epoch]

    def _archived(self, held: Holdings, island: str, epoch: int, channel: Channel) -> Holdings:
        """Let the best one shown in each epoch join the archive of a channel, from the first one on."""
        shown: dict[int, list[tuple[Came, Parcel]]] = defaultdict(list)
        for parcel in self._history.parcels(island, "partners"):
            if parcel.channel == channel.name and parcel.epoch <= epoch:
                shown[parcel.epoch] += [(one, parcel) for one in parcel.came]
        best = [min(shown[then], key=lambda pair: merit(pair[0])) for then in sorted(shown)]
        self._history.learn(one.id for one, _ in best)
        for one, parcel in best:
            held = archived(held, channel, [self._traveller(one, parcel, "partners")])
        return held

    def _paired(self, island: str, epoch: int, partners: Sequence[int]) -> tuple[Sides, list[tuple[Migrant, ...]]]:
        """Give an island's partners in an epoch, and those of one individual's pairings, pairing by pairing."""
        company = self._company(island, epoch)
        if company is None:
            raise lacking(partners[0])
        found = []
        for pairing, place in enumerate(range(0, len(partners), len(company.sides))):
            together = zip(company.sides, partners[place : place + len(company.sides)], strict=True)
            found.append(tuple(_partner(side, pairing, identity) for side, identity in together))
        return company, found

    # -- who travelled -------------------------------------------------------------------------------------------

    def _taken(self, held: Holdings, island: str, parcel: Parcel, kind: ChannelKind) -> Holdings:
        channel, ends = self._channels[parcel.channel], (self._specs[parcel.source].number, self._specs[island].number)
        self._history.learn(one.id for one in parcel.came)
        travellers = tuple(self._traveller(one, parcel, kind) for one in parcel.came)
        return taken_in(held, channel, Packet(channel.number, *ends, parcel.sent, "", travellers))[0]

    def _traveller(self, one: Came, parcel: Parcel, kind: ChannelKind) -> Migrant:
        """Give one as it travelled in a packet."""
        key = (*self._key(parcel.source, parcel.sent), kind, one.id)
        if key not in self._texts:
            text = self._history.genotype(one.id)
            biology = self.biology(parcel.source, parcel.sent)
            offering: object = biology
            if isinstance(offering, Offering):
                text = offering.offer(biology.decode(text), kind)
            self._texts[key] = text
        return Migrant(
            one.id, self._texts[key], one.fitness, *self._history.standing(one.id, parcel.source, parcel.sent)
        )


def _marks(around: Sequence[Parcel]) -> Marks:
    return tuple((one.channel, one.source, one.sent) for one in around)


def _partner(side: Side, pairing: int, identity: int) -> Migrant:
    """Give the partner of a pairing, who has this id."""
    if side.drawn:
        chosen = [one for one in side.partners if one.id == identity]
    else:
        chosen = [side.partners[pairing % len(side.partners)]]
    if not chosen or chosen[0].id != identity:
        raise lacking(identity)
    return chosen[0]
