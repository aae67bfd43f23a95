"""The tree: each island exchanges with the one above it and those below; island 0 is the root."""

from __future__ import annotations

from typing import Annotated, final

from pydantic import Field

from genome.settings import Settings
from orchestrator.topology.protocol import Ground, Link, as_links, both_ways


@final
class Tree(Settings):
    """A tree filled level by level, so that any number of islands makes one.

    Attributes
    ----------
    branching
        Islands below each; with 1 it is a line.
    """

    branching: Annotated[int, Field(ge=1, le=1_000_000)] = 2

    def links(self, ground: Ground) -> list[Link]:
        """Give the edges, both ways."""
        return as_links(both_ways(((place - 1) // self.branching, place) for place in range(1, ground.count)))
