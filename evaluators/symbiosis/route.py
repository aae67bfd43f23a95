"""Routes: whether one can walk from part to part of the space, and out."""

from __future__ import annotations

import numpy as np

from evaluators.symbiosis.symbiosis import Symbiosis


def route_joins(symbiosis: Symbiosis) -> float:
    """Give the share of the space whose connected parts the network's main part touches.

    Parameters
    ----------
    symbiosis
        The network is the route species, or the space itself without one (:mod:`~evaluators.symbiosis.network`).

    Returns
    -------
    float
        0 to 1: the cells of the parts that it touches, over all cells of the space; 0 without space.
    """
    main = symbiosis.surroundings.network
    if main is None or not len(symbiosis.space):
        return 0.0
    labels, _ = symbiosis.surroundings.parts
    return float(np.isin(labels, labels[main.touched]).mean())


def route_reaches(symbiosis: Symbiosis) -> float:
    """Give whether the network's main part reaches the outside.

    Parameters
    ----------
    symbiosis
        Outside is what the flood reaches, in either reading; doors are open to those who walk.

    Returns
    -------
    float
        1 where it holds, or touches by a walkable step, a cell outside; 0 otherwise, and without network.
    """
    main = symbiosis.surroundings.network
    return float(main is not None and main.reaches)


def route(symbiosis: Symbiosis) -> float:
    """Give the mean of :func:`route_joins` and :func:`route_reaches`.

    Parameters
    ----------
    symbiosis
        Of both.

    Returns
    -------
    float
        0 to 1.
    """
    return (route_joins(symbiosis) + route_reaches(symbiosis)) / 2.0


def doors(symbiosis: Symbiosis) -> float:
    """Count the cells of the network's main part that lie in walls.

    Parameters
    ----------
    symbiosis
        Doors are closed to flood and rays. Without a route species there are none: space carves walls.

    Returns
    -------
    float
        A whole number.
    """
    main = symbiosis.surroundings.network
    return float(main.doors) if main is not None else 0.0
