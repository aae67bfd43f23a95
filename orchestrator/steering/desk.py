"""The desk of a run's driver: takes letters in, checks them, decides when they take effect, and remembers it all."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, final

from genome.errors import InputError
from islands.interventions.intervention import Intervention
from islands.store import Store, StoreError
from orchestrator.loading import Loaded
from orchestrator.plan import Plan
from orchestrator.steering.checks import checked
from orchestrator.steering.command import STRUCTURE, Command, Request
from orchestrator.steering.journal import Journal, interventions_at
from orchestrator.steering.mailbox import Letter, answer_of, letters, refuse_all, reply, sweep
from orchestrator.steering.restructuring import replayed
from orchestrator.steering.structure import Structure, structure_of

Objection = Callable[[Request, int], str]
"""Says why the run cannot take a request now, at the start of an epoch; empty when it can."""


def _none(request: Request, epoch: int) -> str:
    del request, epoch
    return ""


@final
class Desk:
    """See the module's docstring. What it has decided outlives its process: a new one of the same run goes on from it.

    Parameters
    ----------
    store
        The run's folder.
    loaded
        The experiment as the run began with it.

    Raises
    ------
    InputError
        When ``commands.jsonl`` is not right.
    """

    def __init__(self, store: Store, loaded: Loaded) -> None:
        self._store: Final = store
        self._journal: Final = Journal(store)
        self._structure = replayed(structure_of(loaded), self._journal.commands)
        sweep(store)

    @property
    def commands(self) -> tuple[Command, ...]:
        """All that was asked for, in order."""
        return self._journal.commands

    @property
    def structure(self) -> Structure:
        """The islands and channels, as decided by now."""
        return self._structure

    def plan(self) -> Plan:
        """Give all islands and edges, with their spans."""
        return self._structure.plan()

    def interventions(self, epoch: int) -> tuple[Intervention, ...]:
        """Give what islands are told as an epoch begins."""
        return interventions_at(self._journal.commands, epoch)

    def look(self, ungranted: int, objection: Objection = _none) -> list[Command]:
        """Take in the letters that wait.

        Each is written into the journal, then answered; the caller tells the hosts afterwards, before it grants the
        epoch of any.

        Parameters
        ----------
        ungranted
            The first epoch that no host was granted yet.
        objection
            Of the run.

        Returns
        -------
        Those accepted, in order.

        Raises
        ------
        StoreError
            When the folder cannot be read or written, and nothing was decided: what was decided before that is
            given back, and the rest waits for the next look.
        """
        taken: list[Command] = []
        try:
            for letter in letters(self._store):
                command = self._journal.by_token(letter.token)
                if command is None:
                    command = self._decided(letter, max(1, self._journal.earliest(ungranted)), objection)
                    if command.is_accepted:
                        taken.append(command)
                reply(self._store, letter.token, answer_of(command))
        except StoreError:
            if not taken:
                raise
        return taken

    def _decided(self, letter: Letter, epoch: int, objection: Objection) -> Command:
        request, reason = letter.request, ""
        structure = self._structure
        try:
            request = checked(request, structure, epoch)
            reason = objection(request, epoch)
            if not reason and request.verb in STRUCTURE:
                structure = _after(structure, request, epoch)
        except InputError as error:
            reason = str(error)
        told = (letter.time, request.verb, request.arguments)
        if reason:
            return self._journal.append(*told, None, letter.by, reason, letter.token)
        command = self._journal.append(*told, epoch, letter.by, token=letter.token)
        self._structure = structure
        return command

    def close(self, reason: str) -> None:
        """Answer whoever waits still that the run is over."""
        refuse_all(self._store, reason)


def _after(structure: Structure, request: Request, epoch: int) -> Structure:
    return replayed(structure, [Command(0, "", request.verb, request.arguments, epoch, "")])
