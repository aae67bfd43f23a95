"""The events of mutation of productions, one a file: each takes a production and gives what stands in its place.

An event that finds nothing to work on gives ``None``. Whether what it gives may be is decided by who called it.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from genome.timed.variation.events.condition import condition
from genome.timed.variation.events.drop import drop
from genome.timed.variation.events.duplicate import duplicate
from genome.timed.variation.events.graft import graft
from genome.timed.variation.events.insert import insert
from genome.timed.variation.events.remove import remove
from genome.timed.variation.events.rewrite import rewrite
from genome.timed.variation.events.site import Event, Site
from genome.timed.variation.events.split import split

EVENTS: Final[Mapping[str, Event]] = MappingProxyType(
    {
        "rewrite": rewrite,
        "graft": graft,
        "insert": insert,
        "remove": remove,
        "duplicate": duplicate,
        "condition": condition,
        "split": split,
        "drop": drop,
    }
)
"""By the name of their rate."""

__all__ = ["EVENTS", "Event", "Site"]
