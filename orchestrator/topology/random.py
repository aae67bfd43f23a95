"""Edges drawn anew for each epoch: every island sends to some others, each as likely."""

from __future__ import annotations

from typing import Annotated, final

from pydantic import Field

from genome.errors import InputError
from genome.settings import Settings
from orchestrator.topology.protocol import Ground


@final
class Random(Settings):
    """The one topology without fixed edges: islands and hosts ask :class:`islands.migration.routes.Redrawn` for them.

    Attributes
    ----------
    degree
        Islands that each one sends to in an epoch.
    """

    degree: Annotated[int, Field(ge=1, le=1_000_000)] = 1

    def check(self, ground: Ground) -> None:
        """Refuse a degree that there are not islands enough for; a single island sends to none."""
        if 1 < ground.count <= self.degree:
            raise InputError("degree", f"at most {ground.count - 1} for {ground.count} islands", str(self.degree))
