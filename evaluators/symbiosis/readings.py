"""The two readings of how far a space is surrounded: what a flood leaves dry, and what rays meet."""

from __future__ import annotations

from evaluators.symbiosis.symbiosis import Symbiosis


def flood(symbiosis: Symbiosis) -> float:
    """Give the share of the space's cells to which no path from outside leads over cells that are no walls.

    Parameters
    ----------
    symbiosis
        Its settings say whether a path goes over all neighbours or over common faces alone.

    Returns
    -------
    float
        0 to 1; 0 without space.
    """
    around = symbiosis.surroundings
    return float(around.dry[around.space].mean()) if around.space.size else 0.0


def visibility(symbiosis: Symbiosis) -> float:
    """Give the share of the lattice's directions in which a ray meets a wall, as a mean over the space's cells.

    Parameters
    ----------
    symbiosis
        Rays go from centre to centre of cells, however far; they pass between two walls that share an edge.

    Returns
    -------
    float
        0 to 1; 0 without space.
    """
    around = symbiosis.surroundings
    if not around.space.size:
        return 0.0
    met = int(around.sights[around.space].sum(dtype="int64"))
    return met / (around.directions * around.space.size)
