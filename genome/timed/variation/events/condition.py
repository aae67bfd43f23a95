"""Another condition."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from genome.timed.system import Production
from genome.timed.variation.events.site import Site


def condition(site: Site, rng: np.random.Generator) -> tuple[Production, ...] | None:
    """Write the condition anew; a production without one gets one where others of its symbol can take over."""
    if site.production.condition is None and not site.siblings:
        return None
    written = site.writer.condition(site.production, rng)
    return None if written is None else (replace(site.production, condition=written),)
