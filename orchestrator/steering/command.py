"""Commands as plain values: what is asked of a run, and what became of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from genome.errors import InputError
from genome.settings import describe
from islands.interventions.intervention import Intervention
from islands.interventions.registry import KINDS

RUN: Final = ("pause", "resume", "stop", "checkpoint")
"""Verbs that are about the run as a whole, and take no arguments."""

ISLANDS: Final = KINDS
"""Verbs that islands carry out; their arguments are an intervention's, and ``islands``."""

STRUCTURE: Final = ("add-island", "remove-island", "connect", "disconnect")
"""Verbs that change which islands and channels there are."""

VERBS: Final = (*RUN, *ISLANDS, *STRUCTURE)
ACCEPTED: Final = "accepted"


@dataclass(frozen=True, slots=True)
class Request:
    """What somebody asks for: a verb, and its arguments as plain JSON values."""

    verb: str
    arguments: Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Command:
    """A line of ``commands.jsonl``.

    Attributes
    ----------
    number
        Place in the file, from 0; ``n`` there.
    time
        When it was asked for, ISO 8601 in UTC.
    verb, arguments
        As of :class:`Request`.
    epoch
        At whose start it takes effect; ``None`` when it does not.
    by
        Who asked.
    outcome
        ``accepted``, or the reason why not.
    token
        Names the letter that brought it, so that none counts twice.
    """

    number: int
    time: str
    verb: str
    arguments: Mapping[str, Any]
    epoch: int | None
    by: str
    outcome: str = ACCEPTED
    token: str = ""

    @property
    def is_accepted(self) -> bool:
        """Whether it takes effect, or has taken it."""
        return self.outcome == ACCEPTED and self.epoch is not None

    def intervention(self) -> Intervention:
        """Give what islands are told of it, where it is one of theirs."""
        arguments = {key: value for key, value in self.arguments.items() if key != "islands"}
        return Intervention(self.verb, arguments, tuple(self.arguments.get("islands", ())), self.number)

    def to_json(self) -> dict[str, Any]:
        """Give plain JSON values."""
        return {
            "n": self.number,
            "time": self.time,
            "verb": self.verb,
            "arguments": dict(self.arguments),
            "epoch": self.epoch,
            "by": self.by,
            "outcome": self.outcome,
            "token": self.token,
        }

    @staticmethod
    def from_json(told: object) -> Command:
        """Read what :meth:`to_json` gave; further keys are passed over.

        Raises
        ------
        InputError
            For anything else.
        """
        match told:
            case {
                "n": int(number), "time": str(time), "verb": str(verb), "arguments": dict(arguments),
                "epoch": int() | None as epoch, "by": str(by), "outcome": str(outcome), **more
            } if verb in VERBS:  # fmt: skip
                return Command(number, time, verb, arguments, epoch, by, outcome, str(more.get("token", "")))
        raise InputError("command", "n, time, verb, arguments, epoch, by and outcome", describe(told))
