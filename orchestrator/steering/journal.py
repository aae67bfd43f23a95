"""``commands.jsonl``: all that was asked of a run, in order, a JSON object a line.

The run's driver alone writes it, always whole, so that a reader sees whole lines. A last line without its end, as a
copy of a file that was cut off may have, is passed over, and gone with the next command.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from typing import Any, Final, final

from genome.errors import InputError
from islands.interventions.intervention import Intervention
from islands.store import Store
from orchestrator.steering.command import ACCEPTED, ISLANDS, STRUCTURE, Command

FILE: Final = "commands.jsonl"


def read_commands(store: Store) -> tuple[Command, ...]:
    """Read the commands of a run, in order; none when there is no file.

    Raises
    ------
    InputError
        For a line that is none, or is not in its place.
    """
    try:
        text = store.read(FILE).decode("utf-8", "replace")
    except FileNotFoundError:
        return ()
    found: list[Command] = []
    *lines, torn = text.split("\n")
    del torn
    for place, line in enumerate(lines):
        where = f"{store.at(FILE)}:{place + 1}"
        try:
            command = Command.from_json(json.loads(line))
        except InputError as error:
            raise InputError(where, error.expected, error.got) from None
        except ValueError as error:
            raise InputError(where, "a line of JSON", str(error)) from None
        if command.number != place:
            raise InputError(where, f"the command of number {place}", f"that of number {command.number}")
        found.append(command)
    return tuple(found)


def interventions_at(commands: Iterable[Command], epoch: int) -> tuple[Intervention, ...]:
    """Give what islands are told as an epoch begins, in the commands' order."""
    return tuple(
        one.intervention() for one in commands if one.is_accepted and one.epoch == epoch and one.verb in ISLANDS
    )


def structural(commands: Iterable[Command]) -> tuple[Command, ...]:
    """Give the commands that change which islands and channels there are, in order."""
    return tuple(one for one in commands if one.is_accepted and one.verb in STRUCTURE)


@final
class Journal:
    """The file as its one writer has it.

    Parameters
    ----------
    store
        The run's folder.

    Raises
    ------
    InputError
        As :func:`read_commands`.
    """

    def __init__(self, store: Store) -> None:
        self._store: Final = store
        self._commands: list[Command] = list(read_commands(store))

    @property
    def commands(self) -> tuple[Command, ...]:
        """All of them, in order."""
        return tuple(self._commands)

    def by_token(self, token: str) -> Command | None:
        """Give the command that a letter brought, if it is here already."""
        return next((one for one in self._commands if one.token == token), None)

    def earliest(self, ungranted: int) -> int:
        """Give the first epoch at which a new command may take effect.

        Parameters
        ----------
        ungranted
            The first epoch that no host was granted yet. After a rollback it may lie before what was decided.
        """
        return max([ungranted, *(one.epoch for one in self._commands if one.epoch is not None)])

    def append(
        self,
        time: str,
        verb: str,
        arguments: Mapping[str, Any],
        epoch: int | None,
        by: str,
        outcome: str = ACCEPTED,
        token: str = "",
    ) -> Command:
        """Write one more, before anybody acts on it; give it.

        Raises
        ------
        StoreError
            When the file cannot be written: the command is not there then.
        """
        command = Command(len(self._commands), time, verb, arguments, epoch, by, outcome, token)
        lines = (json.dumps(one.to_json(), allow_nan=False) for one in (*self._commands, command))
        self._store.write(FILE, "".join(f"{line}\n" for line in lines).encode())
        self._commands.append(command)
        return command
