"""Growth of block bodies: words of bracketed L-systems, read by a turtle on a lattice (Senatore 2009, chapter 2).

:mod:`~growth.blocks.lattice` says what cells there are and which touch; :mod:`~growth.blocks.body` is the form.
:func:`grow` makes one from a genotype, :func:`stand` from given cells, :func:`read_body` from a file;
:func:`grow_cells` makes bare cells.
"""

from growth.blocks.body import Body
from growth.blocks.engine import derive, grow, grow_cells, stand
from growth.blocks.files import read_body, read_given
from growth.blocks.settings import BlockGrowth, CellGrowth
from growth.blocks.skin import body_surface

__all__ = [
    "BlockGrowth",
    "Body",
    "CellGrowth",
    "body_surface",
    "derive",
    "grow",
    "grow_cells",
    "read_body",
    "read_given",
    "stand",
]
