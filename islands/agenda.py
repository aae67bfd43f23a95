"""Which island may step next: pure bookkeeping over epochs finished and packets that are in.

The rule by which islands take in packets makes the schedules what they are:

- :class:`Complete`: an island begins an epoch once every packet of the epoch before is in, one from each edge. Whatever
  the order in which islands step and packets come, it takes in the same: ``barrier`` and ``dataflow`` are alike.
- :class:`Present`: an island never waits; it takes in whatever is in by then. Packets of an island that is ahead of it
  stay until it has come as far, so that no epoch builds on a later one and a run can be cut off at any.
- :class:`Recorded`: an island takes in exactly what a record says, and waits for it: a replay.

Islands that are ready step in the order of their epochs, each of them later by its rank, then of their numbers. Ranks
let those go ahead that other hosts wait for (:func:`ranks`).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Mapping, Sequence
from heapq import heappop, heappush
from typing import Final, Protocol, final

from islands.migration.channel import Edge, Packet
from islands.migration.routes import Routes

Mark = tuple[int, int, int]
"""A packet as its target knows it: channel, source, and the epoch at whose end it was sent."""

REMEMBERED: Final = 256
"""Epochs for which packets taken in are remembered, so that none counts twice; more than hosts may be apart."""


MOST_RANKS: Final = 8
"""Epochs that an island lags behind at most for another's sake: the states in between take memory."""


class Rule(Protocol):
    """Says which packets an island waits for, and which it takes in.

    Attributes
    ----------
    remembered
        For how many epochs packets that were taken in must be remembered, beyond the one before an island's next.
    """

    @property
    def remembered(self) -> int:
        """See above."""
        ...

    def needed(self, island: int, epoch: int) -> Sequence[Mark]:
        """Give what must be in before the island begins this epoch."""
        ...

    def taken(self, island: int, epoch: int, present: Mapping[Mark, Packet]) -> Sequence[Mark]:
        """Give what the island takes in at the start of this epoch, of the packets that are in."""
        ...


@final
class Complete:
    """Every packet of the epoch before; see the module's docstring."""

    remembered: Final = 0

    def __init__(self, routes: Routes) -> None:
        self._routes = routes

    def needed(self, island: int, epoch: int) -> Sequence[Mark]:
        """Give one mark for each edge that leads to the island at the end of the epoch before."""
        before = epoch - 1
        if before < 0:
            return ()
        return [(edge.channel.number, edge.source, before) for edge in self._routes.incoming(island, before)]

    def taken(self, island: int, epoch: int, present: Mapping[Mark, Packet]) -> Sequence[Mark]:
        """Give what was needed."""
        del present
        return self.needed(island, epoch)


@final
class Present:
    """Whatever is in, of epochs that the island has finished itself."""

    remembered: Final = REMEMBERED

    def needed(self, island: int, epoch: int) -> Sequence[Mark]:
        """Give nothing."""
        del island, epoch
        return ()

    def taken(self, island: int, epoch: int, present: Mapping[Mark, Packet]) -> Sequence[Mark]:
        """Give all but those of islands that are ahead, in order."""
        del island
        return sorted(mark for mark in present if mark[2] < epoch)


@final
class Recorded:
    """What the record says for each island and epoch; nothing where it is silent."""

    remembered: Final = REMEMBERED

    def __init__(self, record: Mapping[tuple[int, int], Sequence[Mark]]) -> None:
        self._record = record

    def needed(self, island: int, epoch: int) -> Sequence[Mark]:
        """Give the marks of the record."""
        return self._record.get((island, epoch), ())

    def taken(self, island: int, epoch: int, present: Mapping[Mark, Packet]) -> Sequence[Mark]:
        """Give what was needed."""
        del present
        return self.needed(island, epoch)


@final
class _Place:
    """An island on the agenda: its next epoch, the packets that are in, those it lacks, and those it had."""

    __slots__ = ("box", "epoch", "had", "lacks")

    def __init__(self, epoch: int) -> None:
        self.epoch = epoch
        self.box: dict[Mark, Packet] = {}
        self.lacks: set[Mark] = set()
        self.had: dict[int, set[Mark]] = {}


@final
class Agenda:
    """The epochs of some islands.

    A step costs a few operations on a heap, and a few for each packet, however many islands there are.

    Parameters
    ----------
    islands
        Their numbers.
    rule
        Which packets they wait for and take in.
    ranks
        For islands that may lag behind, by how many epochs.
    finished
        The epoch that all of them have finished before, as when they go on from a checkpoint.
    """

    def __init__(
        self, islands: Iterable[int], rule: Rule, ranks: Mapping[int, int] | None = None, finished: int = -1
    ) -> None:
        self._rule = rule
        self._ranks = ranks or {}
        self._parked: list[tuple[int, int, int]] = []
        self._horizon = -1
        self._places = {island: _Place(finished + 1) for island in islands}
        self._ready: list[tuple[int, int, int]] = []
        self._finished: dict[int, int] = {}
        self._floor = finished
        for island in self._places:
            self._await(island)

    @property
    def floor(self) -> int:
        """The last epoch that all islands have finished; -1 at first."""
        return self._floor

    def put(self, packet: Packet) -> bool:
        """Take a packet; ``False`` when it came before, or comes later than anybody remembers."""
        place = self._places[packet.target]
        mark = (packet.channel, packet.source, packet.epoch)
        if mark in place.box or mark in place.had.get(packet.epoch, ()):
            return False
        if packet.epoch < place.epoch - 1 - self._rule.remembered:
            return False
        place.box[mark] = packet
        if mark in place.lacks:
            place.lacks.discard(mark)
            if not place.lacks:
                self._queue(packet.target)
        return True

    def next(self, horizon: int) -> tuple[int, int] | None:
        """Give the island that is to step next and the epoch it begins; ``None`` while none up to the horizon can."""
        if horizon != self._horizon:
            for entry in self._parked:
                heappush(self._ready, entry)
            self._parked, self._horizon = [], horizon
        while self._ready and self._ready[0][1] > horizon:
            self._parked.append(heappop(self._ready))
        if not self._ready:
            return None
        _, epoch, island = self._ready[0]
        return island, epoch

    def take(self, island: int) -> list[Packet]:
        """Give the packets that the island takes in as it begins its next epoch, and forget them."""
        place = self._places[island]
        marks = self._rule.taken(island, place.epoch, place.box)
        packets = [place.box.pop(mark) for mark in marks]
        if self._rule.remembered:
            for mark in marks:
                place.had.setdefault(mark[2], set()).add(mark)
            place.had.pop(place.epoch - 1 - self._rule.remembered, None)
        return packets

    def done(self, island: int) -> None:
        """Note that the island that was next has finished its epoch."""
        _, epoch, first = heappop(self._ready)
        place = self._places[island]
        if first != island or epoch != place.epoch:
            text = f"island {island} stepped through epoch {place.epoch}, island {first} was next, to step {epoch}"
            raise RuntimeError(text)
        place.epoch += 1
        self._finished[epoch] = self._finished.get(epoch, 0) + 1
        while self._finished.get(self._floor + 1) == len(self._places):
            self._floor += 1
            del self._finished[self._floor]
        self._await(island)

    def present(self) -> Iterator[Packet]:
        """Give the packets that are in and not taken yet."""
        return (packet for place in self._places.values() for packet in place.box.values())

    def awaited(self) -> tuple[int, int, tuple[Mark, ...]] | None:
        """Give, of the islands that wait, the one of the lowest epoch, that epoch, and what it lacks, in order."""
        waiting = [(place.epoch, island) for island, place in self._places.items() if place.lacks]
        if not waiting:
            return None
        epoch, island = min(waiting)
        return island, epoch, tuple(sorted(self._places[island].lacks))

    def _await(self, island: int) -> None:
        place = self._places[island]
        place.lacks = {mark for mark in self._rule.needed(island, place.epoch) if mark not in place.box}
        if not place.lacks:
            self._queue(island)

    def _queue(self, island: int) -> None:
        epoch = self._places[island].epoch
        heappush(self._ready, (epoch + self._ranks.get(island, 0), epoch, island))


def ranks(placement: Sequence[int], host: int, edges: Iterable[Edge]) -> dict[int, int]:
    """Give each island of a host its distance, in edges within the host, from one that another host waits for.

    Islands that go ahead by as much as they are nearer to it keep the other hosts supplied for longest. Islands that no
    other host ever waits for come last.
    """
    here = [island for island, place in enumerate(placement) if place == host]
    before: dict[int, list[int]] = {island: [] for island in here}
    found: dict[int, int] = {}
    for edge in edges:
        if placement[edge.source] == host:
            if placement[edge.target] == host:
                before[edge.target].append(edge.source)
            else:
                found[edge.source] = 0
    queue = deque(sorted(found))
    while queue:
        island = queue.popleft()
        for source in before[island]:
            if source not in found:
                found[source] = found[island] + 1
                queue.append(source)
    last = max(found.values(), default=-1) + 1
    return {island: min(found.get(island, last), MOST_RANKS) for island in here}
