"""What a log tells of who went where: what came to an island in which packet, and how one stood where it lived.

Read from the log alone, island by island and individual by individual, as far as it is asked for.
"""

from __future__ import annotations

from bisect import bisect_right
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, Final, NamedTuple, final

from genome.errors import InputError
from islands.arrivals import Sizes, recorded_sizes
from islands.individual import Scores
from islands.migration.channel import ChannelKind
from islands.spec import IslandSpec
from islands.store import Anywhere
from orchestrator.query import ask

CAME: Final = "select epoch, channel, source, id, fitness from migrations where kind = '{kind}' and target = '{island}'"
"""In the log's own order, which is that of arrival."""

FIRST: Final = "select id, genotype, scores, error from individuals"
RESCORED: Final = "select id, epoch, island, reason, scores, error from evaluations"
MOVES: Final = "select id, epoch, target, source, channel from migrations where kind = 'migrants' and accepted"


class Came(NamedTuple):
    """One that arrived, and its fitness where it came from."""

    id: int
    fitness: float | None


class Parcel(NamedTuple):
    """A packet that was not empty, as the log tells it.

    Attributes
    ----------
    epoch
        The one at whose start it was taken in.
    channel, source
        By name.
    sent
        The epoch at whose end it was sent.
    came
        Those in it, in its order.
    """

    epoch: int
    channel: str
    source: str
    sent: int
    came: tuple[Came, ...]


class Life(NamedTuple):
    """What became of an individual.

    Attributes
    ----------
    genotype
        Its encoding.
    first
        Its scores and error as first scored.
    rescored
        Epoch, island, reason, scores and error of each later scoring, by epoch.
    moves
        Epoch, island, source and channel of each time that it joined a deme, by epoch.
    """

    genotype: str
    first: tuple[Scores, str]
    rescored: tuple[tuple[int, str, str, Scores, str], ...]
    moves: tuple[tuple[int, str, str, str], ...]


@final
class History:
    """See the module's docstring.

    Parameters
    ----------
    log
        The run's ``log`` folder.
    islands
        All islands.
    numbers
        Of the channels, by name.
    late
        Whether packets may have been taken in later than at the next epoch's start, as with the schedule ``async``.
    """

    def __init__(self, log: Anywhere, islands: Sequence[IslandSpec], numbers: Mapping[str, int], late: bool) -> None:
        self._log: Final = log
        self._places: Final = {spec.name: spec.number for spec in islands}
        self._channels: Final = numbers
        self._sizes: Final[Sizes | None] = recorded_sizes(log, islands) if late else None
        self._parcels: Final[dict[tuple[str, str], tuple[Parcel, ...]]] = {}
        self._latest: Final[dict[tuple[str, str], list[tuple[list[int], list[Parcel]]]]] = {}
        self._lives: Final[dict[int, Life]] = {}

    def parcels(self, island: str, kind: ChannelKind) -> tuple[Parcel, ...]:
        """Give what channels of a kind brought an island in all epochs, in the order in which it was taken in."""
        if (island, kind) not in self._parcels:
            rows: dict[tuple[int, str, str], list[Came]] = defaultdict(list)
            for epoch, channel, source, *came in self._of(CAME.format(kind=kind, island=island)):
                rows[epoch, channel, source].append(Came(*came))
            found = [one for place, came in rows.items() for one in self._parted(island, *place, came)]
            self._parcels[island, kind] = tuple(found)
        return self._parcels[island, kind]

    def last(self, island: str, kind: ChannelKind, epoch: int) -> list[Parcel]:
        """Give the last that each source had brought an island by the start of an epoch, by channel, then source."""
        if (island, kind) not in self._latest:
            ways: dict[tuple[int, int], list[Parcel]] = defaultdict(list)
            for one in self.parcels(island, kind):
                ways[self._channels[one.channel], self._places[one.source]].append(one)
            self._latest[island, kind] = [([one.epoch for one in ways[way]], ways[way]) for way in sorted(ways)]
        places = ((found, bisect_right(epochs, epoch)) for epochs, found in self._latest[island, kind])
        return [found[place - 1] for found, place in places if place]

    def genotype(self, identity: int) -> str:
        """Give an individual's genotype, encoded."""
        return self._life(identity).genotype

    def standing(self, identity: int, island: str, epoch: int) -> tuple[Scores, str]:
        """Give the scores and the error that an individual had as a member of an island at the end of an epoch.

        They are those of its last scoring there, or those with which it came from elsewhere.
        """
        life = self._life(identity)
        while True:
            scored = [one for one in life.rescored if one[1] == island and one[0] <= epoch]
            moved = [one for one in life.moves if one[1] == island and one[0] <= epoch]
            # A deme is scored again before migrants join it; a migrant is as it joins.
            if scored and (not moved or (scored[-1][0], scored[-1][2] == "migrant") >= (moved[-1][0], True)):
                return scored[-1][3:]
            if not moved:
                return life.first
            epoch, island = self._departed(identity, *moved[-1])

    def learn(self, identities: Iterable[int]) -> None:
        """Read what became of individuals, all at once, which is quicker than one by one."""
        wanted = sorted({*identities} - self._lives.keys())
        if not wanted:
            return
        these = f"id in ({', '.join(map(str, wanted))})"
        rescored: dict[int, list[Any]] = defaultdict(list)
        for identity, *row, scores, error in self._of(f"{RESCORED} where {these}"):
            rescored[identity].append((*row, _scores(scores), error))
        moves: dict[int, list[Any]] = defaultdict(list)
        for identity, *row in self._of(f"{MOVES} and {these}"):
            moves[identity].append((*row,))
        for identity, genotype, scores, error in self._of(f"{FIRST} where {these}"):
            then = tuple(sorted(rescored[identity], key=_epoch)), tuple(sorted(moves[identity], key=_epoch))
            self._lives[identity] = Life(genotype, (_scores(scores), error), *then)

    def _life(self, identity: int) -> Life:
        self.learn((identity,))
        if identity not in self._lives:
            raise lacking(identity)
        return self._lives[identity]

    def _of(self, sql: str) -> list[Any]:
        return ask(self._log, sql).rows

    def _departed(self, identity: int, epoch: int, island: str, source: str, channel: str) -> tuple[int, str]:
        """Give the end of which epoch, and from where, one left that joined an island."""
        way = (epoch, channel, source)
        for one in self.parcels(island, "migrants"):
            if (one.epoch, one.channel, one.source) == way and any(came.id == identity for came in one.came):
                return one.sent, source
        raise lacking(identity)

    def _parted(self, island: str, epoch: int, channel: str, source: str, came: Sequence[Came]) -> Iterator[Parcel]:
        """Part what came from one source at once by packets."""
        if self._sizes is None:
            yield Parcel(epoch, channel, source, epoch - 1, tuple(came))
            return
        way = self._channels[channel], self._places[source]
        marks = self._sizes.get((self._places[island], epoch), [])
        sizes = sorted((sent, size) for number, place, sent, size in marks if (number, place) == way)
        if sum(size for _, size in sizes) != len(came):
            got = f"none of what {source} sent {island} on channel '{channel}' before epoch {epoch}"
            raise InputError("--id", "a log with the arrivals of a run of schedule async", got, "choose another")
        start = 0
        for sent, size in sizes:
            if size:
                yield Parcel(epoch, channel, source, sent, tuple(came[start : start + size]))
            start += size


def lacking(identity: int) -> InputError:
    """Give the complaint that the log does not have one that was somewhere; a killed run's may not."""
    got = f"a log without {identity}, which was there"
    return InputError("--id", "an individual whose partners and surroundings are in the log", got, "choose another")


def _scores(found: Mapping[str, float] | None) -> Scores:
    return tuple(sorted((found or {}).items()))


def _epoch(row: tuple[Any, ...]) -> int:
    return int(row[0])
