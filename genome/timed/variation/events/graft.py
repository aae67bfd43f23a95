"""A part of the successor for another."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from genome.timed.system import Production
from genome.timed.variation.events.site import Site
from genome.timed.variation.words import any_span, put


def graft(site: Site, rng: np.random.Generator) -> tuple[Production, ...] | None:
    """Replace a branch, or modules side by side, by a word that is written anew."""
    old = site.production.successor
    span = any_span(old, rng)
    word = None if span is None else site.writer.successor(site.production, rng)
    return None if span is None or word is None else (replace(site.production, successor=put(old, span, word)),)
