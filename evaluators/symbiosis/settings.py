"""How what surrounds and what is surrounded are measured: a part of the ``growth:`` section of such islands."""

from __future__ import annotations

from typing import Literal

from genome.settings import Settings


class SymbiosisSettings(Settings):
    """How partners are measured together.

    Attributes
    ----------
    surrounded
        Its reading. ``flood``: a cell is surrounded when no path from outside leads to it over cells that are not
        enclosure. ``visibility``: as far as rays from it, along the lattice's directions, meet the enclosure. Cells of
        space are passable in both.
    passage
        What a path of the flood goes over: to any neighbour (``neighbours``), or over common faces alone (``faces``).
    profile
        ``paper``: the share of the enclosure is that of the space, as the thesis' words have it. ``default``: it is the
        share of the surrounded volume that the space uses.
    """

    surrounded: Literal["flood", "visibility"] = "visibility"
    passage: Literal["neighbours", "faces"] = "neighbours"
    profile: Literal["default", "paper"] = "default"
