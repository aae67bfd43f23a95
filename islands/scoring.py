"""Scoring one individual so that whatever goes wrong stays with that individual."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TypeVar

from genome.mishaps import let_pass, one_line, told
from islands.individual import Evaluation
from islands.kinds.protocol import Biology

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
    try:
        found = biology.evaluate(genotype)
    except BaseException as error:  # noqa: BLE001 - a plug-in's SystemExit must not end the run either
        let_pass(error)
        return Evaluation(None, error=one_line(f"exception: {told(error)}"))
    if found.fitness is not None and not math.isfinite(found.fitness):
        return Evaluation(None, error=f"evaluation: the fitness is {found.fitness}")
    line = one_line(found.error)
    return found if line == found.error else replace(found, error=line)
