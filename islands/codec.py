"""An island's state as plain values and back, to the same bits: what a checkpoint writes.

A deme becomes columns, a list of values for each; all else becomes one JSON text, whose floats read back to the same
bits, the infinite ones too. A field that joins :class:`~islands.state.State` joins :func:`state_text` and
:func:`read_state` here.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any, Final

from islands.holdings import NOTHING, Held, Holdings, Past
from islands.individual import Individual, Outcomes, Scores
from islands.kinds.protocol import Biology
from islands.migration.channel import Migrant
from islands.state import Deme, State
from islands.steered import Steered
from islands.tally import Champion
from islands.watch import Known, Watch

MEMBER: Final = ("ids", "genotypes", "fitness", "scores", "errors", "since", "outcomes")
"""The columns of a deme; the last is not in checkpoints of version 1."""


def deme_columns(biology: Biology[Any], deme: Deme[Any]) -> dict[str, list[Any]]:
    """Give a deme's members in their order, a list for each of the columns ``MEMBER``."""
    return {
        "ids": [one.id for one in deme],
        "genotypes": [biology.encode(one.genotype) for one in deme],
        "fitness": [one.fitness for one in deme],
        "scores": [one.scores for one in deme],
        "errors": [one.error for one in deme],
        "since": [one.since for one in deme],
        "outcomes": [one.outcomes for one in deme],
    }


def read_deme(biology: Biology[Any], columns: Mapping[str, Sequence[Any]]) -> Deme[Any]:
    """Read what :func:`deme_columns` gave; whatever the biology raises for a genotype that it cannot read passes."""
    whole = {"outcomes": [()] * len(columns["ids"]), **columns}
    return tuple(
        Individual(identity, biology.decode(text), fitness, _scores(scores), error, since, _outcomes(outcomes))
        for identity, text, fitness, scores, error, since, outcomes in zip(
            *(whole[name] for name in MEMBER), strict=True
        )
    )


def state_text(state: State[Any], champion: Champion | None) -> str:
    """Write all of a state but its deme, and the island's champion."""
    held = state.held
    return json.dumps(
        {
            "epoch": state.epoch,
            "generation": state.generation,
            "counter": state.counter,
            "best": state.best,
            "stagnant": state.stagnant,
            "scoring": state.scoring,
            "steered": state.steered.to_json(),
            "held": {} if held == NOTHING else held._asdict(),
            "champion": champion,
            "watched": state.watched,
        },
        separators=(",", ":"),
    )


def read_state(text: str, deme: Deme[Any]) -> tuple[State[Any], Champion | None]:
    """Read what :func:`state_text` wrote: give the state with its deme, and the champion.

    Raises
    ------
    ValueError, KeyError, TypeError
        For a text that it did not write.
    """
    told = json.loads(text)
    state = State(
        deme=deme,
        epoch=told["epoch"],
        generation=told["generation"],
        counter=told["counter"],
        best=told["best"],
        stagnant=told["stagnant"],
        held=_holdings(told["held"]),
        scoring=told["scoring"],
        steered=Steered.from_json(told["steered"]),
        watched=_watches(told.get("watched", ())),  # not in checkpoints of version 1
    )
    champion = told["champion"]
    return state, None if champion is None else (champion[0], champion[1])


def _watches(told: Sequence[Any]) -> tuple[Watch, ...]:
    return tuple(
        Watch(channel, tuple(Known(identity, text) for identity, text in champions), stalled)
        for channel, champions, stalled in told
    )


def _holdings(told: Mapping[str, Any]) -> Holdings:
    # An island that holds nothing is told by the object, not by its value.
    if not told:
        return NOTHING
    return Holdings(
        partners=_held(told["partners"]),
        components=_held(told["components"]),
        surroundings=_held(told["surroundings"]),
        archives=tuple(Past(channel, _migrants(travellers)) for channel, travellers in told["archives"]),
    )


def _held(told: Sequence[Any]) -> tuple[Held, ...]:
    return tuple(Held(channel, source, _migrants(travellers)) for channel, source, travellers in told)


def _migrants(told: Sequence[Any]) -> tuple[Migrant, ...]:
    return tuple(
        Migrant(identity, text, fitness, _scores(scores), error) for identity, text, fitness, scores, error in told
    )


def _outcomes(told: Sequence[Any]) -> Outcomes:
    return tuple((partners, fitness) for partners, fitness in told)


def _scores(told: Sequence[Any]) -> Scores:
    return tuple((name, value) for name, value in told)
