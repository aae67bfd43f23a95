"""Watching coevolution for its known troubles: how an island's best fares against the partners of the past.

Fitness says how members do against the partners of now, who change. Whether anything is gained, lost or merely turned
over shows against those who were there before: the champion, the best member at an epoch's end, is scored against each
past representative that the archive of a channel of partners holds, and so are the champions of earlier epochs. From
that come measures of three troubles (Rosin and Belew 1997; Cliff and Miller 1995, "Tracking the Red Queen"; Watson and
Pollack 2001, "Coevolutionary dynamics in a minimal substrate"):

- cycling: an earlier champion does better against the same archive than today's (``forgetting`` above 0);
- disengagement: members cannot be told apart by their fitness (``distinct`` and ``spread`` near 0);
- a mediocre stable state: no new champion does better against the same archive than all earlier ones (``stalled``).

Nothing is drawn, and what breeds does not see it: a run has the same digest, watched or not.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, Final, Generic, NamedTuple, TypeVar, final

from genome.mishaps import let_pass
from islands.context import Context
from islands.holdings import Holdings
from islands.individual import Individual, merit
from islands.migration.channel import Channel, Migrant
from islands.pairings import Sides, past_ones
from islands.scoring import scored_with

G = TypeVar("G")

TOLERANCE: Final = 0.01
"""A champion is better than those before it if its score exceeds theirs by more than this share of its size."""


class Known(NamedTuple):
    """A champion of an epoch, by its id and its encoded genotype."""

    id: int
    text: str


class Watch(NamedTuple):
    """What is remembered for one watched channel.

    Attributes
    ----------
    channel
        Its number.
    champions
        Of the epochs so far, each once, the newest first; as many as the archive may hold.
    stalled
        Epochs since a new champion was better than all others known, against the archive of that time.
    """

    channel: int
    champions: tuple[Known, ...] = ()
    stalled: int = 0


Scores = tuple[float | None, ...]
"""Fitness against each of an archive, ``None`` where invalid."""


@final
class Watcher(Generic[G]):
    """Takes the measures of one island.

    What one scored against another is remembered from epoch to epoch: only who is new on either side is scored. It
    would score the same again, so that it makes no difference where a run begins.

    Parameters
    ----------
    channels
        All channels that reach the island.
    pulse
        Called before each scoring; it may raise.
    """

    def __init__(self, channels: Sequence[Channel], pulse: Callable[[], None]) -> None:
        watched = [one for one in channels if one.pairing is not None and one.pairing.measures]
        self._channels: Final = {channel.number: channel for channel in watched}
        self._pulse: Final = pulse
        self._memory: dict[tuple[str, str, tuple[Migrant, ...]], float | None] = {}
        self._used: dict[tuple[str, str, tuple[Migrant, ...]], float | None] = {}

    def look(
        self, deme: Sequence[Individual[G]], context: Context[G], held: Holdings, watches: Sequence[Watch]
    ) -> tuple[tuple[Watch, ...], list[dict[str, Any]]]:
        """Take the measures at an epoch's end.

        Parameters
        ----------
        deme
            The members.
        context
            By which they are scored.
        held
            What the island holds.
        watches
            As they were at the end of the epoch before.

        Returns
        -------
        The watches now, by channel, and an event's detail for each: of the channels that have shown someone.
        """
        company = context.company
        if not self._channels or company is None or not deme:
            return tuple(watches), []
        before = {watch.channel: watch for watch in watches}
        self._used = {}
        found, details = [], []
        for place, side in enumerate(company.sides):
            if side.channel in self._channels:
                watch = before.get(side.channel, Watch(side.channel))
                watch, detail = self._measured(deme, context, company, place, held, watch)
                found.append(watch)
                details.append(detail)
        self._memory, self._used = self._used, {}
        return tuple(found), details

    def _measured(
        self,
        deme: Sequence[Individual[G]],
        context: Context[G],
        company: Sides,
        place: int,
        held: Holdings,
        watch: Watch,
    ) -> tuple[Watch, dict[str, Any]]:
        channel = self._channels[watch.channel]
        past = past_ones(channel, held, company.sides[place].partners[:1])
        opponents = [_beside(company, place, one) for one in past]
        best = min(deme, key=merit)
        champion = None if best.fitness is None else Known(best.id, context.biology.encode(best.genotype))
        earlier = tuple(one for one in watch.champions if champion is None or one.id != champion.id)
        scores = () if champion is None else self._scores(context, champion, opponents)
        means = [mean for one in earlier if (mean := _mean(self._scores(context, one, opponents))) is not None]
        score, record = _mean(scores), max(means, default=None)
        forgetting = None if score is None or record is None else record - score
        stalled = watch.stalled + 1
        if champion not in watch.champions and (forgetting is None or forgetting < -TOLERANCE * abs(record or 0.0)):
            stalled = 0
        detail = {
            "channel": channel.name,
            "champion": None if champion is None else champion.id,
            "fitness": best.fitness,
            "archive": {
                "mean": score,
                "worst": min((one for one in scores if one is not None), default=None),
                "number": len(scores),
                "invalid": scores.count(None),
                "each": [[one.id, value] for one, value in zip(past, scores, strict=False)],
            },
            "forgetting": forgetting,
            **_variety(deme),
            "stalled": stalled,
        }
        kept = (earlier if champion is None else (champion, *earlier))[
            : channel.pairing.archive if channel.pairing else 0
        ]
        return Watch(watch.channel, kept, stalled), detail

    def _scores(self, context: Context[G], one: Known, opponents: Sequence[tuple[Migrant, ...]]) -> Scores:
        return tuple(self._score(context, one, partners) for partners in opponents)

    def _score(self, context: Context[G], one: Known, partners: tuple[Migrant, ...]) -> float | None:
        key = (context.biology.scoring, one.text, partners)
        if key not in self._used:
            self._used[key] = self._memory[key] if key in self._memory else self._scored(context, one, partners)
        return self._used[key]

    def _scored(self, context: Context[G], one: Known, partners: tuple[Migrant, ...]) -> float | None:
        self._pulse()
        try:
            genotype = context.biology.decode(one.text)
        except BaseException as error:  # noqa: BLE001 - whatever a plug-in raises must not end the run
            let_pass(error)
            return None
        assert context.symbiotic is not None
        return scored_with(context.symbiotic, genotype, partners).fitness


def _beside(company: Sides, place: int, past: Migrant) -> tuple[Migrant, ...]:
    """Give a past partner of one channel with the best that the others show now."""
    return tuple(past if place == number else side.partners[0] for number, side in enumerate(company.sides))


def _mean(scores: Scores) -> float | None:
    """Give the mean of the valid."""
    valid = [one for one in scores if one is not None]
    return math.fsum(valid) / len(valid) if valid else None


def _variety(deme: Sequence[Individual[Any]]) -> dict[str, float | None]:
    """Give the share of valid members with different fitness, and their standard deviation over the mean's size.

    Both are ``None`` where no member is valid, the second also where the mean is 0 and not all are.
    """
    valid = [one.fitness for one in deme if one.fitness is not None]
    if not valid:
        return {"distinct": None, "spread": None}
    mean = math.fsum(valid) / len(valid)
    std = math.sqrt(math.fsum((value - mean) ** 2 for value in valid) / len(valid))
    spread = 0.0 if std == 0 else std / abs(mean) if mean else None
    return {"distinct": len(frozenset(valid)) / len(valid), "spread": spread}
