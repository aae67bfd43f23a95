"""What an island goes by, steered or not: the settings of its algorithm, and the contexts in which it scores."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Final, Generic, NamedTuple, TypeVar, final

from islands.context import Contexts
from islands.kinds.protocol import Biology
from islands.migration.channel import Channel
from islands.settings import Algorithm
from islands.spec import IslandSpec
from islands.steered import UNSTEERED, Steered

G = TypeVar("G")
Build = Callable[[IslandSpec], Biology[Any]]
"""Makes the biology of an island's settings; :class:`islands.biologies.Biologies` is one that remembers."""


class Regime(NamedTuple, Generic[G]):
    """See the module's docstring."""

    algorithm: Algorithm
    contexts: Contexts[G]


@final
class Regimes(Generic[G]):
    """Gives the regime for what an island is steered to.

    Parameters
    ----------
    spec, biology
        Of the island as the experiment has it.
    channels
        All channels that reach it, by number.
    build
        Makes the biology of changed goals or strengths.
    """

    def __init__(self, spec: IslandSpec, biology: Biology[G], channels: Sequence[Channel], build: Build) -> None:
        self._spec: Final = spec
        self._channels: Final = tuple(channels)
        self._build: Final = build
        self.usual: Final = Regime(spec.algorithm, Contexts(biology, self._channels))
        # The last one made, with what it was made for.
        self._made: tuple[Steered, Regime[G]] = (UNSTEERED, self.usual)

    def of(self, steered: Steered) -> Regime[G]:
        """Give the regime of an island that is steered so."""
        last, regime = self._made
        if steered.measure == last.measure and steered.rates == last.rates:
            return regime
        spec = steered.spec(self._spec)
        contexts = regime.contexts
        if steered.measure == UNSTEERED.measure:
            contexts = self.usual.contexts
        elif steered.measure != last.measure:
            contexts = Contexts(self._build(spec), self._channels)
        self._made = (steered, Regime(spec.algorithm, contexts))
        return self._made[1]
