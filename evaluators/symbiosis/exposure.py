"""What sun and airborne particles meet of an enclosure, as they do of block bodies."""

from __future__ import annotations

import numpy as np

from evaluators.blocks.particles import caught
from evaluators.blocks.sun import exposure
from evaluators.symbiosis.symbiosis import Symbiosis
from growth.blocks.body import INTERNAL, Body
from growth.blocks.lattice import CUBIC, SQUARE


def sun(symbiosis: Symbiosis) -> float:
    """Give how much of the enclosure the sun reaches, less the ground that it shades.

    Parameters
    ----------
    symbiosis
        The enclosure's cells, carved ones left out; those of a plane as cubes.

    Returns
    -------
    float
        As :func:`evaluators.blocks.sun.sun`; 0 without walls.
    """
    return exposure(_body(symbiosis))


def particles(symbiosis: Symbiosis) -> float:
    """Give the mean cross-section that the enclosure offers to particles from all over the sky.

    Parameters
    ----------
    symbiosis
        As for :func:`sun`.

    Returns
    -------
    float
        As :func:`evaluators.blocks.particles.particles`; 0 without walls.
    """
    return caught(_body(symbiosis))


def _body(symbiosis: Symbiosis) -> Body:
    around = symbiosis.surroundings
    cells = symbiosis.enclosure[around.walls[around.enclosure] != 0]
    lattice = CUBIC if symbiosis.lattice is SQUARE else symbiosis.lattice
    return Body(lattice, cells, np.full(len(cells), INTERNAL, dtype=np.uint8))
