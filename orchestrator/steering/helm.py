"""The driver's side of steering: commands come in, are checked and written down, and are answered."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import Final, final

from genome.errors import InputError
from islands.store import Store
from orchestrator.steering.checks import checked
from orchestrator.steering.command import RUN, STRUCTURE, Command, Request
from orchestrator.steering.journal import Journal
from orchestrator.steering.mailbox import Answer, Letter, answer_of, letters, refuse_all, reply, sweep
from orchestrator.steering.restructuring import replayed
from orchestrator.steering.structure import Structure

FAR_S: Final = 2.0
"""Seconds between two looks into the inbox of a run that is in a bucket, where each look costs a request."""


@final
class Helm:
    """See the module's docstring.

    Parameters
    ----------
    store
        The run's folder.
    structure
        As the experiment has it.
    epochs
        Of the run.
    """

    def __init__(self, store: Store, structure: Structure, epochs: int) -> None:
        self._store: Final = store
        self._journal: Final = Journal(store)
        self._structure = replayed(structure, self._journal.commands)
        self._epochs: Final = epochs
        self._looked = 0.0
        sweep(store)

    @property
    def commands(self) -> tuple[Command, ...]:
        """All that was asked of the run, in order."""
        return self._journal.commands

    def taken(self, ungranted: int) -> Iterator[Command]:
        """Take the commands that wait; give those that are to be carried out.

        Parameters
        ----------
        ungranted
            The first epoch that no host can have begun.
        """
        now = time.monotonic()
        if self._store.local is None and now - self._looked < FAR_S:
            return
        self._looked = now
        for letter in letters(self._store):
            known = self._journal.by_token(letter.token)
            command = known or self._written(letter, ungranted)
            reply(self._store, letter.token, answer_of(command))
            if known is None and command.is_accepted:
                yield command

    def _written(self, letter: Letter, ungranted: int) -> Command:
        """Decide about a letter, and write the decision down."""
        request, by = letter.request, letter.by
        epoch = ungranted if request.verb in RUN else self._journal.earliest(ungranted)
        try:
            if request.verb not in RUN and epoch > self._epochs:
                got = f"epoch {epoch}, the first that can still be changed"
                raise InputError(f"steer {request.verb}", f"a run of more than {self._epochs} epochs", got)
            request = checked(request, self._structure, epoch)
        except InputError as error:
            return self._refused(letter, request, str(error))
        command = self._journal.append(
            letter.time, request.verb, request.arguments, min(epoch, self._epochs), by, token=letter.token
        )
        if command.verb in STRUCTURE:
            self._structure = replayed(self._structure, [command])
        return command

    def _refused(self, letter: Letter, request: Request, reason: str) -> Command:
        told = (letter.time, request.verb, request.arguments, None, letter.by)
        return self._journal.append(*told, outcome=reason, token=letter.token)

    def close(self, reason: str) -> None:
        """Answer what waits: the run is over."""
        refuse_all(self._store, reason)


__all__ = ["Answer", "Helm"]
