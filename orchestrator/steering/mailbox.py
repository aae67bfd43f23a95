"""How a command gets to a run that another process drives, perhaps on another machine: through the run's folder.

Whoever steers leaves a letter, ``inbox/TOKEN.json``, and looks for ``outbox/TOKEN.json``. The driver answers a letter
before it removes it, and its journal remembers the token: one found again after a crash is answered from there,
and does not count twice.
"""

from __future__ import annotations

import json
import secrets
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

from genome.errors import InputError
from genome.settings import describe
from islands.store import Store
from orchestrator.steering.command import VERBS, Command, Request

INBOX: Final = "inbox"
OUTBOX: Final = "outbox"
LOOK_S: Final = 0.1
"""Seconds between two looks for an answer, at first; each is longer than the one before by half, up to a second."""

LONGEST_LOOK_S: Final = 1.0


@dataclass(frozen=True, slots=True)
class Letter:
    """A command on its way; see :class:`~orchestrator.steering.command.Command`."""

    token: str
    time: str
    by: str
    request: Request


@dataclass(frozen=True, slots=True)
class Answer:
    """What the run said: whether it takes the command, at the start of which epoch, and why not."""

    accepted: bool
    epoch: int | None
    reason: str = ""


# -- whoever steers ----------------------------------------------------------------------------------------------------


def post(store: Store, request: Request, time: str, by: str) -> str:
    """Leave a letter for the run in this folder; give its token."""
    token = secrets.token_hex(16)
    told = {"time": time, "by": by, "verb": request.verb, "arguments": dict(request.arguments)}
    store.write(f"{INBOX}/{token}.json", json.dumps(told, allow_nan=False).encode())
    return token


def await_answer(
    store: Store,
    token: str,
    seconds: float,
    clock: Callable[[], float],
    sleep: Callable[[float], None],
    is_running: Callable[[], bool] = lambda: True,
) -> Answer | None:
    """Wait for the answer to a letter; without one it is withdrawn.

    Parameters
    ----------
    store, token
        The run's folder, and the letter.
    seconds
        How long.
    clock, sleep
        Of this process.
    is_running
        Tells whether there is anybody to answer; asked when there is no answer yet.

    Returns
    -------
    The answer; ``None`` when none came in time, or nobody is there to give one.
    """
    ends, pause = clock() + seconds, LOOK_S
    while True:
        answer = _answer(store, token)
        if answer is None and (clock() >= ends or not is_running()):
            store.remove(f"{INBOX}/{token}.json")
            # It may have come in the meantime.
            answer = _answer(store, token)
            if answer is None:
                return None
        if answer is not None:
            store.remove(f"{OUTBOX}/{token}.json")
            return answer
        sleep(min(pause, max(ends - clock(), 0.0)))
        pause = min(1.5 * pause, LONGEST_LOOK_S)


def _answer(store: Store, token: str) -> Answer | None:
    try:
        told = json.loads(store.read(f"{OUTBOX}/{token}.json"))
    except FileNotFoundError:
        return None
    match told:
        case {"accepted": bool(accepted), "epoch": int() | None as epoch, "reason": str(reason)}:
            return Answer(accepted, epoch, reason)
    place = str(store.at(OUTBOX, f"{token}.json"))
    raise InputError(place, "an answer: accepted, epoch and reason", describe(told))


# -- the run's driver --------------------------------------------------------------------------------------------------


def letters(store: Store) -> list[Letter]:
    """Give the letters that wait, the oldest first. What is no letter is answered and removed."""
    found = []
    for name in store.names(INBOX):
        token = name.removesuffix(".json")
        try:
            told = json.loads(store.read(f"{INBOX}/{name}"))
        except FileNotFoundError:  # withdrawn
            continue
        except ValueError:
            told = None
        letter = _letter(token, told)
        if letter is None:
            reply(store, token, Answer(accepted=False, epoch=None, reason=f"no command: {describe(told)}"))
        else:
            found.append(letter)
    return sorted(found, key=lambda one: (one.time, one.token))


def _letter(token: str, told: object) -> Letter | None:
    match told:
        case {"time": str(time), "by": str(by), "verb": str(verb), "arguments": dict(arguments)} if verb in VERBS:
            return Letter(token, time, by, Request(verb, arguments))
    return None


def reply(store: Store, token: str, answer: Answer) -> None:
    """Answer a letter, and remove it."""
    told: dict[str, Any] = {"accepted": answer.accepted, "epoch": answer.epoch, "reason": answer.reason}
    store.write(f"{OUTBOX}/{token}.json", json.dumps(told).encode())
    store.remove(f"{INBOX}/{token}.json")


def answer_of(command: Command) -> Answer:
    """Give the answer to the letter that brought a command."""
    if command.is_accepted:
        return Answer(accepted=True, epoch=command.epoch)
    return Answer(accepted=False, epoch=None, reason=command.outcome)


def refuse_all(store: Store, reason: str) -> None:
    """Answer all letters that wait with a no: the run is over."""
    for letter in letters(store):
        reply(store, letter.token, Answer(accepted=False, epoch=None, reason=reason))


def sweep(store: Store) -> None:
    """Remove answers that nobody fetched: for a run that begins, or goes on, in this folder."""
    store.remove_tree(OUTBOX)
