"""What an event works on, and with."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import final

import numpy as np

from genome.timed.system import Production
from genome.timed.variation.writer import Writer


@final
@dataclass(frozen=True, slots=True)
class Site:
    """A production that is mutated.

    Attributes
    ----------
    production
        As it is.
    siblings
        How many other productions its symbol has.
    writer
        What writes parts anew.
    """

    production: Production
    siblings: int
    writer: Writer


Event = Callable[[Site, np.random.Generator], tuple[Production, ...] | None]
"""Gives what stands in the production's place from then on; ``None`` where there is nothing to do."""
