"""How many cells each species has here."""

from __future__ import annotations

from evaluators.symbiosis.symbiosis import Symbiosis


def enclosure_cells(symbiosis: Symbiosis) -> float:
    """Count the enclosure's cells.

    Parameters
    ----------
    symbiosis
        Those that the space carves count.

    Returns
    -------
    float
        A whole number.
    """
    return float(len(symbiosis.enclosure))


def space_cells(symbiosis: Symbiosis) -> float:
    """Count the space's cells.

    Parameters
    ----------
    symbiosis
        Inside or not.

    Returns
    -------
    float
        A whole number.
    """
    return float(len(symbiosis.space))


def route_cells(symbiosis: Symbiosis) -> float:
    """Count the route's cells.

    Parameters
    ----------
    symbiosis
        All count, those off the main part too.

    Returns
    -------
    float
        A whole number; 0 where no route is among the partners.
    """
    return float(len(symbiosis.route))
