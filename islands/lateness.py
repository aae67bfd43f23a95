"""Partners that are late: where no island waits, one goes on with those it holds, and the log says so, once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final, final

from islands.migration.channel import Edge, Packet
from islands.migration.routes import Routes

Way = tuple[int, int]
"""Channel and source."""


@final
class Lateness:
    """Remembers what came of which epoch to some islands on channels of partners.

    A source is late at the start of an epoch when the packet is not in that it sent when its channel carried last. It
    is told of once, until a packet of then or later has come. Nothing of this is in a checkpoint: that waits for all
    packets of its epoch, so that nobody is late in the one after it.

    Parameters
    ----------
    routes
        The edges of the run.
    before
        The last epoch of which all packets came, as when islands go on from a checkpoint; -1 for none.
    """

    def __init__(self, routes: Routes, before: int) -> None:
        self._routes: Final = routes
        self._before: Final = before
        self._heard: Final[dict[tuple[int, Way], int]] = {}
        self._late: Final[dict[int, frozenset[Way]]] = {}

    def told(self, island: int, epoch: int, packets: Sequence[Packet]) -> list[dict[str, Any]]:
        """Take note of the packets that an island takes in as it begins an epoch; give the details of ``late`` events.

        Each has the names of the ``channel`` and of the ``source`` that is late from now on, and ``since``: the last
        epoch at whose end it sent anything that came; -1 where nothing ever did.
        """
        for packet in packets:
            key = (island, (packet.channel, packet.source))
            self._heard[key] = max(self._heard.get(key, self._before), packet.epoch)
        late = {(edge.channel.number, edge.source): edge for edge in self._lacking(island, epoch)}
        known = self._late.get(island, frozenset())
        self._late[island] = frozenset(late)
        return [
            {"channel": edge.channel.name, "source": edge.source_name, "since": self._since(island, way)}
            for way, edge in late.items()
            if way not in known
        ]

    def _lacking(self, island: int, epoch: int) -> list[Edge]:
        """Give the edges whose last packet that may hold partners is not in, by channel, then source."""
        found = []
        for channel in self._routes.channels_into(island):
            if channel.kind == "partners":
                due = (epoch - 1) // channel.every * channel.every
                found += [
                    edge
                    for edge in self._routes.incoming(island, due)
                    if edge.channel.number == channel.number
                    and edge.is_there(epoch - 1)
                    and self._since(island, (channel.number, edge.source)) < due
                ]
        return found

    def _since(self, island: int, way: Way) -> int:
        return self._heard.get((island, way), self._before)
