"""Which packets were on their way at an epoch's end, told later: when islands have gone on and taken some in."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Final, final

from islands.migration.channel import Packet
from islands.migration.routes import Routes


@final
class Transit:
    """Remembers what islands took in since the last epoch that is settled.

    A checkpoint of a settled epoch keeps the packets that were sent at its end or before and that no island had taken
    in by then. Islands that are ahead have taken in some of them since.
    """

    def __init__(self) -> None:
        self._taken: Final[dict[int, list[Packet]]] = {}

    def take(self, epoch: int, packets: Iterable[Packet]) -> None:
        """Note what an island takes in at the start of an epoch."""
        self._taken.setdefault(epoch, []).extend(packets)

    def forget(self, settled: int) -> None:
        """Forget what was taken in up to an epoch: no checkpoint of an epoch before it will be asked for."""
        for epoch in [epoch for epoch in self._taken if epoch <= settled]:
            del self._taken[epoch]

    def pending(self, epoch: int, islands: Iterable[int], present: Iterable[Packet]) -> dict[int, tuple[Packet, ...]]:
        """Give for islands what was on its way to them at the end of an epoch.

        Parameters
        ----------
        epoch
            It is not before one that was forgotten.
        islands
            Their numbers.
        present
            What is in by now and was not taken in yet.

        Returns
        -------
        By the islands' numbers, in their order, packets by channel, source and epoch.
        """
        found: dict[int, list[Packet]] = {island: [] for island in islands}
        taken = (packet for later, packets in self._taken.items() if later > epoch for packet in packets)
        for packet in (*taken, *present):
            if packet.epoch <= epoch:
                found[packet.target].append(packet)
        return {
            island: tuple(sorted(packets, key=lambda packet: (packet.channel, packet.source, packet.epoch)))
            for island, packets in found.items()
        }


def lacking(routes: Routes, epoch: int, pending: Mapping[int, Sequence[Packet]]) -> tuple[tuple[int, int, int], ...]:
    """Give what was sent at the end of an epoch and is still between two hosts: channel, source, target, in order.

    Each edge sends a packet at each epoch's end. Until none is lacking, a checkpoint of that epoch would lose some.
    """
    found: list[tuple[int, int, int]] = []
    for island, packets in pending.items():
        here = {(packet.channel, packet.source) for packet in packets if packet.epoch == epoch}
        edges = routes.incoming(island, epoch)
        marks = [(edge.channel.number, edge.source) for edge in edges]
        found.extend((channel, source, island) for channel, source in marks if (channel, source) not in here)
    return tuple(sorted(found))
