"""What a run was steered to in an epoch, read from its commands: for scoring an individual as it was scored then."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Final, final

from genome.errors import InputError
from islands.interventions.goals import TARGET, WEIGHT
from islands.interventions.intervention import Subject
from islands.interventions.registry import EFFECTS
from islands.interventions.strengths import STRENGTH
from islands.spec import IslandSpec
from islands.steered import UNSTEERED, Steered
from orchestrator.steering.command import Command


@final
class Past:
    """Gives islands' settings with the goals and strengths that they had in an epoch.

    Parameters
    ----------
    commands
        Of the run, in order.
    islands
        With their spans.
    """

    def __init__(self, commands: Iterable[Command], islands: Iterable[IslandSpec]) -> None:
        self._commands: Final = tuple(
            one for one in commands if one.is_accepted and one.verb in (WEIGHT, TARGET, STRENGTH)
        )
        self._specs: Final[Mapping[str, IslandSpec]] = {spec.name: spec for spec in islands}
        self._known: Final[dict[tuple[str, int], Steered]] = {}

    def spec(self, island: str, epoch: int) -> IslandSpec:
        """Give an island's settings as they were while an epoch went on."""
        return self._steered(island, epoch).spec(self._specs[island])

    def _steered(self, island: str, epoch: int) -> Steered:
        spec = self._specs[island]
        # The first population of an island that is added takes no commands.
        told = [one for one in self._commands if one.epoch is not None and spec.since < one.epoch <= epoch]
        place = island, len(told)
        if place not in self._known:
            subject: Subject[Any] = Subject(spec, (), UNSTEERED)
            for one in told:
                intervention = one.intervention()
                if intervention.concerns(island):
                    subject = _after(subject, intervention.kind, intervention.arguments)
            self._known[place] = subject.steered
        return self._known[place]


def _after(subject: Subject[Any], kind: str, arguments: Mapping[str, Any]) -> Subject[Any]:
    """Give an island after an intervention, as the island took it: one that did not suit it changed nothing."""
    try:
        found = EFFECTS[kind](subject, arguments)
    except InputError:
        return subject
    return subject if isinstance(found, str) else found
