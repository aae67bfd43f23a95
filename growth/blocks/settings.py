"""How blocks grow, apart from their rules: parts of the ``growth:`` sections of islands that grow them."""

from __future__ import annotations

from typing import Annotated, Final, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from genome.errors import InputError
from genome.settings import Settings, describe
from growth.blocks.lattice import ALL_LATTICES, LATTICES, Lattice

FARTHEST: Final = 500_000
"""Coordinates of cells that people give are of this size at most."""

Cell = tuple[int, int, int]


def as_cell(value: object) -> Cell:
    """Take a list of three whole numbers as a cell.

    Raises
    ------
    InputError
        For anything else, and for a cell that is too far away.
    """
    if not isinstance(value, (list, tuple)) or len(value) != 3 or not all(type(one) is int for one in value):
        raise InputError("", "a cell of three whole numbers: [x, y, z]", describe(value))
    if max(map(abs, value)) > FARTHEST:
        raise InputError("", f"coordinates of {FARTHEST} at most", describe(value))
    x, y, z = value
    return x, y, z


def as_cells(value: object) -> tuple[Cell, ...]:
    """Take a list as cells, none of them twice.

    Raises
    ------
    InputError
        For anything else.
    """
    if not isinstance(value, (list, tuple)) or not value:
        raise InputError("", "a list of cells: [[x, y, z], ...]", describe(value))
    cells = tuple(map(as_cell, value))
    seen = set()
    for cell in cells:
        if cell in seen:
            raise InputError("", "each cell once", f"{list(cell)} twice")
        seen.add(cell)
    return cells


def _as_supports(value: object) -> object:
    return None if value is None else as_cells(value)


class BlockBudget(Settings):
    """What a growth may make.

    Attributes
    ----------
    max_symbols
        The longest word, brackets counted, at any moment; what needs a longer one is invalid.
    max_blocks
        The most blocks that the turtle may place; what has more is invalid.
    max_seconds
        The clock behind the budget, a safety net.
    """

    max_symbols: Annotated[int, Field(ge=1, le=FARTHEST)] = 50_000
    max_blocks: Annotated[int, Field(ge=1, le=FARTHEST)] = 2_000
    max_seconds: Annotated[float, Field(gt=0)] = 30.0


class BlockGrowth(BlockBudget):
    """Settings of the growth of a block body (Senatore 2009, 'the hierarchy of the structure').

    Attributes
    ----------
    lattice
        ``cubic`` or ``isospatial``.
    ground
        ``lowest`` stands a body on its lowest blocks; with ``fixed`` the ground lies beneath the cells of
        ``ground_level``, and a body may miss it.
    ground_level
        The height of the cells that stand on a fixed ground.
    supports
        The cells that a body is held by, in place of a ground: walls, cliffs. No block is placed in them.
    envelope
        Whether the body is wrapped.
    envelope_below
        Blocks of the skeleton that have fewer neighbours than this, the foundation counted, are wrapped.
    """

    lattice: Literal["cubic", "isospatial"] = "cubic"
    ground: Literal["lowest", "fixed"] = "lowest"
    ground_level: Annotated[int, Field(ge=-FARTHEST, le=FARTHEST)] = 0
    supports: Annotated[tuple[Cell, ...] | None, BeforeValidator(_as_supports)] = None
    envelope: bool = False
    envelope_below: Annotated[int, Field(ge=1, le=27)] = 2

    @model_validator(mode="after")
    def _on_lattice(self) -> Self:
        for cell in self.supports or ():
            check_on_lattice(cell, self.cells)
        return self

    @property
    def cells(self) -> Lattice:
        """The lattice that the settings name."""
        return LATTICES[self.lattice]


class CellGrowth(BlockBudget):
    """Settings of the growth of bare cells, which stand on no ground: walls, space, routes.

    Attributes
    ----------
    lattice
        ``cubic``, ``isospatial`` or ``square``, which is the plane z = 0.
    start
        The cell in which growth begins: where several species grow in one space, each has its place.
    """

    lattice: Literal["cubic", "isospatial", "square"] = "cubic"
    start: Annotated[Cell, BeforeValidator(as_cell)] = (0, 0, 0)

    @model_validator(mode="after")
    def _start_on_lattice(self) -> Self:
        check_on_lattice(self.start, self.cells)
        return self

    @property
    def cells(self) -> Lattice:
        """The lattice that the settings name."""
        return ALL_LATTICES[self.lattice]


def check_on_lattice(cell: Cell, lattice: Lattice) -> None:
    """Refuse a cell that a lattice does not have.

    Raises
    ------
    InputError
        When its coordinates must add up to an even number, and do not, or it must lie in the plane, and does not.
    """
    if not lattice.offsets[:, 2].any() and cell[2]:
        raise InputError("", f"cells of the {lattice.name} lattice, which lie in the plane z = 0", f"{list(cell)}")
    if lattice.parity and sum(cell) % 2:
        raise InputError("", f"cells of the {lattice.name} lattice, whose coordinates add up to an even number",
                         f"{list(cell)}")  # fmt: skip
