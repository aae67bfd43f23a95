"""Scoring one individual so that whatever goes wrong stays with that individual."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any, TypeVar

from genome.mishaps import let_pass, one_line, told
from islands.individual import Evaluation
from islands.kinds.protocol import Biology, Symbiotic
from islands.migration.channel import Migrant

G = TypeVar("G")


def scored(biology: Biology[G], genotype: G) -> Evaluation:
    """Grow and score a genotype.

    Whatever a plug-in raises, ``sys.exit`` included, gives an invalid evaluation with its reason, and so does a
    fitness that is not finite. The error is one line of valid UTF-8.

    Raises
    ------
    KeyboardInterrupt
        On Ctrl-C.
    """
    return _guarded(biology.evaluate, genotype)


def scored_with(biology: Symbiotic[G], genotype: G, partners: tuple[Migrant, ...]) -> Evaluation:
    """Score a genotype together with partners; as :func:`scored` otherwise."""
    return _guarded(biology.evaluate_with, genotype, partners)


def _guarded(evaluate: Callable[..., Evaluation], *given: Any) -> Evaluation:  # noqa: ANN401 - what is scored
    try:
        found = evaluate(*given)
    except BaseException as error:  # noqa: BLE001 - a plug-in's SystemExit must not end the run either
        let_pass(error)
        return Evaluation(None, error=one_line(f"exception: {told(error)}"))
    if found.fitness is not None and not math.isfinite(found.fitness):
        return Evaluation(None, error=f"evaluation: the fitness is {found.fitness}")
    if not found.error:
        return found
    line = one_line(found.error)
    return found if line == found.error else replace(found, error=line)
