"""Who steers a run while it goes on: commands left in its folder as if by another process."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from experiments import Silent
from islands.store import Store
from orchestrator.steering.command import Request
from orchestrator.steering.mailbox import post


class Helmsman(Silent):
    """Leaves letters once an epoch is done."""

    def __init__(self, letters: Mapping[int, list[Request]]) -> None:
        self.letters, self.store, self.notes = dict(letters), None, []

    def begin(self, plan: Any, experiment: Any, folder: Store) -> None:
        self.store = folder

    def epoch(self, epoch: int, rows: Any) -> None:
        for at in [at for at in self.letters if at <= epoch]:
            for place, request in enumerate(self.letters.pop(at)):
                post(self.store, request, f"2026-01-01T00:00:{at:02d}.{place:03d}+00:00", "test")

    def note(self, text: str) -> None:
        self.notes.append(text)
