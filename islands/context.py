"""What an island scores by in one epoch: its biology, in the surroundings and with the parts and partners it holds.

Two contexts with one ``scoring`` give one genotype one fitness (or, where partners are drawn for each member,
fitnesses of one distribution), so that a migrant between them need not be scored again, and a deme whose context stays
the same neither.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final, Generic, TypeVar, final

from genome.mishaps import let_pass, told
from islands.holdings import NOTHING, Holdings, everything
from islands.kinds.protocol import Assembling, Biology, Situated, Symbiotic
from islands.migration.channel import Channel, Migrant
from islands.pairings import Scored, Sides, scored_in_pairs, sides_of
from islands.scoring import scored
from islands.streams import EpochStreams

G = TypeVar("G")
Forms = tuple[Migrant, ...]


@final
class Context(Generic[G]):
    """See the module's docstring.

    Parameters
    ----------
    biology
        As what is held makes it.
    company
        The partners of members; ``None`` where they are scored alone.
    mishap
        Why something that is held could not be made use of; empty when all could.

    Attributes
    ----------
    scoring
        Names the context; what packets carry.
    """

    __slots__ = ("_assembling", "biology", "company", "mishap", "scoring", "symbiotic")

    def __init__(self, biology: Biology[G], company: Sides | None = None, mishap: str = "") -> None:
        self.biology: Final = biology
        self.mishap: Final = mishap
        self.scoring: Final = biology.scoring if company is None else f"{biology.scoring}+{company.key}"
        self.symbiotic: Final[Symbiotic[G] | None] = biology if isinstance(biology, Symbiotic) else None
        self.company: Final = company
        self._assembling: Final[Assembling[G] | None] = biology if isinstance(biology, Assembling) else None

    def score(self, genotype: G, streams: EpochStreams, pulse: Callable[[], None]) -> Scored:
        """Score a genotype, alone or with the partners of its pairings."""
        if self.company is None or self.symbiotic is None:
            pulse()
            return Scored(scored(self.biology, genotype))
        return scored_in_pairs(self.symbiotic, genotype, self.company, streams, pulse)

    def components(self, genotype: G) -> tuple[int, ...]:
        """Give the ids of the parts that a genotype is assembled from."""
        return () if self._assembling is None else self._assembling.components(genotype)


@final
class Contexts(Generic[G]):
    """Makes the contexts of an island's epochs.

    Parameters
    ----------
    biology
        Of the island that holds nothing.
    channels
        All channels that reach the island, by number.
    """

    def __init__(self, biology: Biology[G], channels: Sequence[Channel]) -> None:
        self._partners: Final = tuple(channel for channel in channels if channel.kind == "partners")
        self.alone: Final = Context(biology)
        # The last ones made, with what they were made for: an environment may take long to build.
        self._among: tuple[Forms, Context[G]] = ((), self.alone)
        self._with: tuple[Context[G], Forms, Context[G]] = (self.alone, (), self.alone)

    def of(
        self, holdings: Holdings, streams: EpochStreams, live: frozenset[tuple[int, int]] | None = None
    ) -> Context[G]:
        """Give the context of an epoch in which the island holds this.

        Where channels come and go, ``live`` says which edges, by channel and source, lead to the island as it begins.
        """
        if holdings == NOTHING:
            return self.alone
        context = self._with_parts(self.among(holdings), everything(holdings.components))
        partners = self._partners
        if live is not None:
            here = {channel for channel, _ in live}
            partners = tuple(channel for channel in partners if channel.number in here)
        if not partners or context.symbiotic is None:
            return context
        company = sides_of(partners, holdings, streams)
        return context if company is None else Context(context.biology, company, context.mishap)

    def among(self, holdings: Holdings) -> Context[G]:
        """Give the context in the surroundings that the island holds, without partners and parts."""
        forms = everything(holdings.surroundings)
        if forms != self._among[0]:
            biology: object = self.alone.biology
            made = self.alone
            if forms and isinstance(biology, Situated):
                made = _made(self.alone, lambda: biology.surrounded(forms), "surroundings")
            self._among = (forms, made)
        return self._among[1]

    def _with_parts(self, context: Context[G], parts: Forms) -> Context[G]:
        biology: object = context.biology
        if not parts or not isinstance(biology, Assembling):
            return context
        if self._with[0] is not context or self._with[1] != parts:
            self._with = (context, parts, _made(context, lambda: biology.supplied(parts), "components"))
        return self._with[2]


def _made(context: Context[G], make: Callable[[], Biology[G]], what: str) -> Context[G]:
    """Make the context of a changed biology; where a kind cannot make that of what came, the context stays."""
    try:
        return Context(make(), None, context.mishap)
    except BaseException as error:  # noqa: BLE001 - whatever a plug-in raises must not end the run
        let_pass(error)
        return Context(context.biology, None, "; ".join(filter(None, (context.mishap, f"{what}: {told(error)}"))))
