"""A module more."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from genome.timed.system import Production
from genome.timed.variation.events.site import Site
from genome.timed.variation.words import any_place, put


def insert(site: Site, rng: np.random.Generator) -> tuple[Production, ...] | None:
    """Put a module that is written anew at a random place of the successor."""
    old = site.production.successor
    at = any_place(old, rng)
    word = site.writer.module(site.production, rng)
    return None if word is None else (replace(site.production, successor=put(old, (at, at), word)),)
