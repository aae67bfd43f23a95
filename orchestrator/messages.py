"""What the archipelago hears and what it orders: events and instructions, plain values."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

from islands.interventions.intervention import Intervention

Status = Literal["finished", "failed", "stopped"]

# -- events ------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Begun:
    """The run was asked for."""


@dataclass(frozen=True, slots=True)
class HostReady:
    """A host stands."""

    host: int


@dataclass(frozen=True, slots=True)
class EpochDone:
    """A host has stepped its islands through an epoch that was a mark; ``seconds`` is what the call took."""

    host: int
    epoch: int
    seconds: float = 0.0


@dataclass(frozen=True, slots=True)
class EpochAbandoned:
    """A host broke off because it was asked to stop; ``epoch`` is the last that all of its islands have finished."""

    host: int
    epoch: int


@dataclass(frozen=True, slots=True)
class PartSaved:
    """A host has written its part of a checkpoint."""

    host: int
    epoch: int


@dataclass(frozen=True, slots=True)
class HostFinished:
    """A host has written the last of its log and its forms."""

    host: int


@dataclass(frozen=True, slots=True)
class HostFailed:
    """A host raised an error, died, or did not answer within its deadline.

    ``epoch`` is the last that all of its islands have finished, where the host could still say so; ``part`` is set when
    it was its part of a checkpoint that it could not write.
    """

    host: int
    reason: str
    alive: bool
    epoch: int = -1
    part: bool = False


@dataclass(frozen=True, slots=True)
class StopAsked:
    """Somebody wants the run to stop."""


@dataclass(frozen=True, slots=True)
class PauseAsked:
    """Somebody wants the run to pause: no further epoch begins."""


@dataclass(frozen=True, slots=True)
class ResumeAsked:
    """Somebody wants a paused run to go on."""


@dataclass(frozen=True, slots=True)
class SaveAsked:
    """Somebody wants a checkpoint, of the next epoch that all hosts have finished."""


@dataclass(frozen=True, slots=True)
class RestructureAsked:
    """Islands or channels will be others from an epoch on, which no host was granted yet."""

    epoch: int


@dataclass(frozen=True, slots=True)
class Rewound:
    """All is set for the hosts to begin anew from the checkpoint of an epoch, or from the start for -1.

    ``limit`` is the last epoch before islands or channels change again, if they are to.
    """

    epoch: int
    hosts: int
    limit: int | None = None


Event: TypeAlias = (
    Begun
    | HostReady
    | EpochDone
    | EpochAbandoned
    | PartSaved
    | HostFinished
    | HostFailed
    | StopAsked
    | PauseAsked
    | ResumeAsked
    | SaveAsked
    | RestructureAsked
    | Rewound
)

# -- instructions ------------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Spawn:
    """Make a host."""

    host: int


@dataclass(frozen=True, slots=True)
class Advance:
    """Let a host step its islands.

    Attributes
    ----------
    host
        Which.
    through
        The mark: all of its islands are to finish this epoch.
    horizon
        How far they may go while others of them wait for packets.
    settled
        The last mark that all hosts have finished.
    """

    host: int
    through: int
    horizon: int
    settled: int


@dataclass(frozen=True, slots=True)
class Report:
    """Every host has finished an epoch: tell how the islands stand."""

    epoch: int


@dataclass(frozen=True, slots=True)
class AskStop:
    """Ask a host to abandon the epoch in hand; with ``lost``, also to wait no more: what it waits for may not come."""

    host: int
    lost: bool = False


@dataclass(frozen=True, slots=True)
class Save:
    """Let a host write its part of the checkpoint of a settled epoch."""

    host: int
    epoch: int


@dataclass(frozen=True, slots=True)
class Seal:
    """All parts of a checkpoint are written: make it whole."""

    epoch: int


@dataclass(frozen=True, slots=True)
class Steer:
    """Tell a host of an intervention and the epoch in which it takes effect."""

    host: int
    epoch: int
    intervention: Intervention


@dataclass(frozen=True, slots=True)
class Pause:
    """The run stands still, at this epoch."""

    epoch: int


@dataclass(frozen=True, slots=True)
class Rewind:
    """Make ready to begin anew from the last checkpoint; the answer is :class:`Rewound`.

    Attributes
    ----------
    lost
        Hosts that are gone, ascending; none where islands or channels are to be others.
    reason
        Why.
    """

    lost: tuple[int, ...]
    reason: str


@dataclass(frozen=True, slots=True)
class Finish:
    """Let a host write the last of its log, and its forms if asked.

    Attributes
    ----------
    host
        Which.
    forms
        Whether to write forms.
    settled
        The last epoch reported.
    through
        The last epoch that every host has finished: where all logs are to end.
    """

    host: int
    forms: bool
    settled: int
    through: int


@dataclass(frozen=True, slots=True)
class Conclude:
    """The run is over.

    Attributes
    ----------
    status, reason
        How, and why.
    settled
        Whether its first populations were ever scored.
    torn
        Whether a host is lost whose part of the log was not written: what counts is the last checkpoint.
    """

    status: Status
    reason: str
    settled: bool
    torn: bool = False


Instruction: TypeAlias = Spawn | Advance | Report | AskStop | Save | Seal | Pause | Rewind | Finish | Conclude

Order: TypeAlias = Spawn | Advance | AskStop | Save | Steer | Finish
"""What a host is told."""
