"""A part of the successor less."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from genome.timed.system import Production
from genome.timed.variation.events.site import Site
from genome.timed.variation.words import any_span, put


def remove(site: Site, rng: np.random.Generator) -> tuple[Production, ...] | None:
    """Take away a branch, or modules side by side; a successor may come out empty."""
    old = site.production.successor
    span = any_span(old, rng)
    return None if span is None else (replace(site.production, successor=put(old, span, ())),)
