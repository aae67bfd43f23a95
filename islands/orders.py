"""What hosts are told, and what they answer: plain values that travel between the driver and hosts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, Literal, NamedTuple

from islands.checkpoint import Part
from islands.interventions.intervention import Intervention
from islands.log import LogFile
from islands.migration.channel import Edge, Packet
from islands.migration.routes import Redrawn
from islands.spec import IslandSpec
from islands.tally import IslandSummary

Schedule = Literal["barrier", "dataflow", "async"]
Box = tuple[Packet, ...]
"""What one host sends to another at a time."""

Post = Callable[[int, Box], bool]
"""Hands packets to another host; ``False`` when so many are on their way to it that these have to wait."""


NOWHERE: Final = -1
"""In place of a host, for islands that are not there."""


class Start(NamedTuple):
    """A checkpoint that hosts go on from: its epoch, and the parts of all hosts. Islands in no part begin after it."""

    epoch: int
    parts: tuple[Part, ...]


@dataclass(frozen=True, slots=True)
class HostPlan:
    """What one host is to do.

    Attributes
    ----------
    host, hosts
        Its number, and how many there are.
    run, seed
        The run's name and seed.
    folder
        The run's folder: the place of a store.
    islands
        Its islands, in order.
    edges
        Every edge that begins or ends at one of them, in the order of channels, then sources.
    placement
        For each island of the run, by number, the host that holds it.
    generations
        Generations of an epoch.
    flush_epochs
        The log is written every so many epochs.
    best_forms
        How many different forms of each island are written at the end.
    epochs
        Epochs of the run.
    redrawn
        Channels whose edges are drawn anew for each epoch.
    foreign
        Islands of other hosts that adapters have to know.
    schedule
        Which packets islands wait for.
    replay
        The ``log`` folder of a run whose arrivals are to be repeated; empty for none.
    start
        What the islands go on from; ``None`` for the beginning.
    interventions
        Those known already, each with the epoch in which it takes effect, in their order.
    round
        How often all hosts have begun anew; letters of another round are not taken.
    patience
        Seconds without any packet after which a host that waits gives up.
    """

    host: int
    hosts: int
    run: str
    seed: int
    folder: str
    islands: tuple[IslandSpec, ...]
    edges: tuple[Edge, ...]
    placement: tuple[int, ...]
    generations: int
    flush_epochs: int
    best_forms: int
    epochs: int | None = None
    redrawn: tuple[Redrawn, ...] = ()
    foreign: tuple[IslandSpec, ...] = ()
    schedule: Schedule = "barrier"
    replay: str = ""
    patience: float = 600.0
    start: Start | None = None
    interventions: tuple[tuple[int, Intervention], ...] = ()
    round: int = 0

    @property
    def neighbours(self) -> tuple[int, ...]:
        """The other hosts that islands of this one may send to or hear from, ascending; each is a neighbour of them."""
        found = {self.placement[number] for edge in self.edges for number in (edge.source, edge.target)}
        for channel in self.redrawn:
            homes = {self.placement[number] for number, _ in channel.members}
            found |= homes if self.host in homes else set()
        return tuple(sorted(host for host in found if host not in (self.host, NOWHERE)))


class Advanced(NamedTuple):
    """How far a host has come.

    Attributes
    ----------
    epoch
        The last epoch that all of its islands have finished; -1 for none.
    summaries
        How they stood at its end, counting from the call before; empty when there is trouble.
    busy_s, waited_s
        Seconds spent on stepping islands, and on waiting for packets.
    trouble
        Why it broke off; empty when it did not.
    stopped
        Whether it broke off because it was asked to.
    """

    epoch: int
    summaries: tuple[IslandSummary, ...]
    busy_s: float
    waited_s: float
    trouble: str = ""
    stopped: bool = False


class Step(NamedTuple):
    """What a host is at: which island, which epoch, for how many seconds; an empty name while it waits."""

    island: str
    epoch: int
    seconds: float


class Saved(NamedTuple):
    """A host's part of a checkpoint, and all log files that it has written since it stands."""

    part: Part
    files: tuple[LogFile, ...]


class Finished(NamedTuple):
    """What a host left behind: the names of its forms, and how its islands stood at the end of the log."""

    forms: tuple[str, ...]
    summaries: tuple[IslandSummary, ...]


class StoppedError(Exception):
    """The run was asked to stop: the epoch in hand is abandoned, the states are those of its beginning."""


class StarvedError(Exception):
    """The host waited in vain for packets of other hosts."""
