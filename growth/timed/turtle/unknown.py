"""Which symbols of a system the turtle passes over."""

from __future__ import annotations

import numpy as np

from genome.timed import TimedSystem
from genome.timed.commands import TURTLE
from growth.timed.program import compile_system
from growth.timed.tables import BORN, FIRST_RULE, LAST_RULE, NONE


def unknown_symbols(system: TimedSystem) -> tuple[str, ...]:
    """Give the symbols that stay in words and draw nothing: without production, and no turtle command by an equiv.

    Parameters
    ----------
    system
        Checked.

    Returns
    -------
    tuple of str
        In the order in which the system has them, each once. Symbols with productions are left out: most of them are
        there to become others.

    Raises
    ------
    InputError
        As :func:`~growth.timed.program.compile_system`.
    """
    program = compile_system(system)
    tables, figures = program.tables, program.figures
    lasting = tables.symbols[:, FIRST_RULE] == tables.symbols[:, LAST_RULE]
    plain = (figures.section_of == NONE) & (figures.surface_of == NONE)
    born = np.unique(tables.births[:, BORN])
    codes = born[lasting[born] & plain[born]].tolist()
    return tuple(dict.fromkeys(program.names[code] for code in codes if program.commands[code] not in TURTLE))
