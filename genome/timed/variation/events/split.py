"""A production more."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from genome.timed.system import Production
from genome.timed.variation.events.site import Site


def split(site: Site, rng: np.random.Generator) -> tuple[Production, ...] | None:
    """Put a production of the same symbol before this one: under a condition, and with a successor, written anew."""
    written = site.writer.condition(site.production, rng)
    word = None if written is None else site.writer.successor(site.production, rng)
    if written is None or word is None:
        return None
    return replace(site.production, condition=written, chance=None, successor=word), site.production
