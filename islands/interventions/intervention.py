"""An intervention: what somebody asks of islands while they evolve, as plain values."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Generic, NamedTuple, TypeVar

from genome.errors import InputError
from genome.settings import describe
from islands.individual import home_of
from islands.spec import IslandSpec
from islands.state import Deme
from islands.steered import Steered

G = TypeVar("G")
Arguments = Mapping[str, Any]
"""Plain JSON values; what there is depends on the kind."""


@dataclass(frozen=True, slots=True)
class Intervention:
    """See the module's docstring.

    Attributes
    ----------
    kind
        A name of :data:`islands.interventions.registry.EFFECTS`.
    arguments
        What it says.
    islands
        The islands that it is for, by name; empty for all.
    number
        Of the command that it comes from, for the log.
    """

    kind: str
    arguments: Arguments
    islands: tuple[str, ...] = ()
    number: int = 0

    def concerns(self, island: str) -> bool:
        """Tell whether it is for the island of this name."""
        return not self.islands or island in self.islands

    def to_json(self) -> dict[str, Any]:
        """Give plain JSON values."""
        return {
            "kind": self.kind,
            "arguments": dict(self.arguments),
            "islands": list(self.islands),
            "number": self.number,
        }

    @staticmethod
    def from_json(told: object) -> Intervention:
        """Read what :meth:`to_json` gave.

        Raises
        ------
        InputError
            For anything else.
        """
        match told:
            case {
                "kind": str(kind), "arguments": dict(arguments), "islands": list(islands), "number": int(number), **more
            } if not more and all(isinstance(name, str) for name in islands):  # fmt: skip
                return Intervention(kind, arguments, tuple(islands), number)
        raise InputError("intervention", "kind, arguments, islands and number", describe(told))


class Subject(NamedTuple, Generic[G]):
    """What an intervention may change of an island: who lives there, and what it is steered to; ``spec`` stays."""

    spec: IslandSpec
    deme: Deme[G]
    steered: Steered

    def has(self, identity: int) -> bool:
        """Tell whether an individual is a member."""
        return any(one.id == identity for one in self.deme)


def concerning(interventions: Iterable[Intervention], island: str) -> tuple[Intervention, ...]:
    """Give those that are for an island, in their order."""
    return tuple(one for one in interventions if one.concerns(island))


def is_elsewhere(intervention: Intervention, subject: Subject[Any]) -> bool:
    """Tell whether an intervention is about an individual that this island has nothing to do with.

    One that names no island is for each where the individual is a member; if it is none at all, the island that bred
    it is there to say so.
    """
    identity = intervention.arguments.get("id")
    if not isinstance(identity, int) or intervention.islands or subject.has(identity):
        return False
    return home_of(identity) != subject.spec.number
