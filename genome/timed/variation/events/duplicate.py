"""A part of the successor twice."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from genome.timed.system import Production
from genome.timed.variation.events.site import Site
from genome.timed.variation.words import any_place, any_span, put


def duplicate(site: Site, rng: np.random.Generator) -> tuple[Production, ...] | None:
    """Copy a branch, or modules side by side, to a random place of the successor, inside itself too."""
    old = site.production.successor
    span = any_span(old, rng)
    if span is None:
        return None
    at = any_place(old, rng)
    return (replace(site.production, successor=put(old, (at, at), old[span[0] : span[1]])),)
