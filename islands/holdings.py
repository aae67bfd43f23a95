"""What an island holds of what channels brought it, from one epoch to the next: partners, components, surroundings."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final, NamedTuple

from islands.individual import merit
from islands.migration.channel import Channel, Migrant, Packet

ALREADY_HERE: Final = "already here"
NO_PLACE: Final = "no place left"


class Held(NamedTuple):
    """What came on one channel from one source."""

    channel: int
    source: int
    travellers: tuple[Migrant, ...]


class Past(NamedTuple):
    """The archive of one channel of partners: the best one shown in each epoch, the newest first.

    One id may be there several times, each time as it was shown then. There is one more than the channel's pairing
    says: the newest is as a rule the best one shown now, which is no past one yet.
    """

    channel: int
    travellers: tuple[Migrant, ...]


class Holdings(NamedTuple):
    """All that an island holds, each by channel, then source.

    Attributes
    ----------
    partners
        Those shown last by each source.
    components
        Parts of each source, the newest first.
    surroundings
        Forms of each source, the ones sent last.
    archives
        Of the channels of partners that keep one.
    """

    partners: tuple[Held, ...] = ()
    components: tuple[Held, ...] = ()
    surroundings: tuple[Held, ...] = ()
    archives: tuple[Past, ...] = ()

    def only(self, ways: frozenset[tuple[int, int]]) -> Holdings:
        """Give what came on edges that are there still, by channel and source: all else is let go.

        An archive stays for as long as its channel has an edge.
        """
        channels = {channel for channel, _ in ways}
        left = Holdings(
            _among(self.partners, ways),
            _among(self.components, ways),
            _among(self.surroundings, ways),
            tuple(one for one in self.archives if one.channel in channels),
        )
        return left if left != NOTHING else NOTHING


NOTHING: Final = Holdings()


def taken_in(holdings: Holdings, channel: Channel, packet: Packet) -> tuple[Holdings, tuple[str, ...]]:
    """Take in a packet of partners, components or surroundings.

    Partners and surroundings take the place of what the channel had brought from that source. Components join what it
    had brought: the newest first, ``keep`` different ids of a source. An empty packet changes nothing.

    Returns
    -------
    The holdings after it, and for each traveller the reason why it was not taken, or nothing: ``already here`` where
    just the same is held, or came in this packet before; ``no place left`` beyond a channel's ``keep``.
    """
    if not packet.migrants:
        return holdings, ()
    entries: dict[tuple[int, int], tuple[Migrant, ...]] = {
        (one.channel, one.source): one.travellers for one in _entries(holdings, channel)
    }
    before = entries.get((channel.number, packet.source), ())
    known = {one.id: one.text for one in before}
    fresh: dict[int, Migrant] = {}
    reasons = []
    most = channel.keep if channel.kind == "components" else len(packet.migrants)
    for one in packet.migrants:
        reason = ""
        if one.id in fresh or known.get(one.id) == one.text:
            reason = ALREADY_HERE
        elif len(fresh) >= most:
            reason = NO_PLACE
        if one.id not in fresh and len(fresh) < most:
            fresh[one.id] = one
        reasons.append(reason)
    if channel.kind == "components":
        fresh.update((one.id, one) for one in before if one.id not in fresh)
    entries[channel.number, packet.source] = tuple(fresh.values())[:most]
    held = tuple(Held(number, source, entries[number, source]) for number, source in sorted(entries))
    if channel.kind == "partners":
        return holdings._replace(partners=held), tuple(reasons)
    if channel.kind == "components":
        return holdings._replace(components=held), tuple(reasons)
    return holdings._replace(surroundings=held), tuple(reasons)


def archived(holdings: Holdings, channel: Channel, shown: Iterable[Migrant]) -> Holdings:
    """Let the best of those that a channel showed in this epoch join its archive, unless it is there as it is now.

    The oldest go first, when there is one more than the channel's pairing says; see :class:`Past`.
    """
    size = channel.pairing.archive if channel.pairing is not None else 0
    best = min(shown, key=merit, default=None)
    if best is None or size == 0:
        return holdings
    archives = {one.channel: one.travellers for one in holdings.archives}
    before = archives.get(channel.number, ())
    if any((one.id, one.text) == (best.id, best.text) for one in before):
        return holdings
    archives[channel.number] = (best, *before)[: size + 1]
    return holdings._replace(archives=tuple(Past(number, archives[number]) for number in sorted(archives)))


def pool(holdings: Holdings, channel: int) -> tuple[Migrant, ...]:
    """Give all partners that a channel's sources show, best first.

    One shown by several sources is there once, as the source shows it where it is the fittest, of equals the first.
    """
    shown = sorted((one for held in holdings.partners if held.channel == channel for one in held.travellers), key=merit)
    found: dict[int, Migrant] = {}
    for one in shown:
        found.setdefault(one.id, one)
    return tuple(found.values())


def everything(entries: Iterable[Held]) -> tuple[Migrant, ...]:
    """Give all travellers of the entries in their order, each id once: as it came first."""
    found: dict[int, Migrant] = {}
    for held in entries:
        for one in held.travellers:
            found.setdefault(one.id, one)
    return tuple(found.values())


def _entries(holdings: Holdings, channel: Channel) -> tuple[Held, ...]:
    if channel.kind == "partners":
        return holdings.partners
    return holdings.components if channel.kind == "components" else holdings.surroundings


def _among(entries: Iterable[Held], ways: frozenset[tuple[int, int]]) -> tuple[Held, ...]:
    return tuple(one for one in entries if (one.channel, one.source) in ways)
