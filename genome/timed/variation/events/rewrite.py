"""Another successor."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from genome.timed.system import Production
from genome.timed.variation.events.site import Site


def rewrite(site: Site, rng: np.random.Generator) -> tuple[Production, ...] | None:
    """Write the whole successor anew."""
    word = site.writer.successor(site.production, rng)
    return None if word is None else (replace(site.production, successor=word),)
