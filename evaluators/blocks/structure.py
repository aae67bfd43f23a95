"""What criteria of block bodies see: a body and what its joints carry."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from evaluators.blocks.load import Load
from growth.blocks.body import Body


@final
@dataclass(frozen=True, slots=True, eq=False)
class Structure:
    """A body under load.

    Attributes
    ----------
    body
        The body.
    load
        Its load; the places in it are those of the body's cells.
    """

    body: Body
    load: Load
