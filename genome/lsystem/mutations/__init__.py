"""The events of mutation, one a file (Senatore 2009, 'mutation'): each takes a successor and gives a changed one.

An event that finds nothing to work on gives the successor back as it is.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Final

import numpy as np

from genome.lsystem.mutations.add import add
from genome.lsystem.mutations.change import change
from genome.lsystem.mutations.delete import delete
from genome.lsystem.mutations.duplicate import duplicate
from genome.lsystem.mutations.invert import invert
from genome.lsystem.settings import LSystemGenome
from genome.lsystem.word import Word

Event = Callable[[Word, np.random.Generator, LSystemGenome], Word]

EVENTS: Final[Mapping[str, Event]] = MappingProxyType(
    {"add": add, "delete": delete, "duplicate": duplicate, "invert": invert, "change": change}
)
"""By the name of their rate, in the order in which a mutation goes through them."""
