"""A production less."""

from __future__ import annotations

import numpy as np

from genome.timed.system import Production
from genome.timed.variation.events.site import Site


def drop(site: Site, rng: np.random.Generator) -> tuple[Production, ...] | None:
    """Take the production away; a symbol keeps its last one."""
    del rng
    return () if site.siblings else None
