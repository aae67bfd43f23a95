"""The shares of enclosure and space in each other, and their mean (Coates, Broughton and Jackson 1999)."""

from __future__ import annotations

from evaluators.symbiosis.readings import flood, visibility
from evaluators.symbiosis.symbiosis import Symbiosis
from evaluators.symbiosis.volume import doubled, enclosed


def space_share(symbiosis: Symbiosis) -> float:
    """Give how much of the space is surrounded, in the reading that is set.

    Parameters
    ----------
    symbiosis
        Its settings choose :func:`~evaluators.symbiosis.readings.flood` or
        :func:`~evaluators.symbiosis.readings.visibility`.

    Returns
    -------
    float
        0 to 1; 0 without space.
    """
    return flood(symbiosis) if symbiosis.settings.surrounded == "flood" else visibility(symbiosis)


def enclosure_share(symbiosis: Symbiosis) -> float:
    """Give how much of the volume that the enclosure surrounds is used by the space.

    By the flood, the space's dry cells over all dry cells; by visibility, the weight of the space's cells over that of
    all (:func:`~evaluators.symbiosis.volume.enclosed`). With the profile ``paper`` it is :func:`space_share`, as the
    thesis' words have it.

    Parameters
    ----------
    symbiosis
        Cells of the space are no walls.

    Returns
    -------
    float
        0 to 1; 0 where nothing is surrounded.
    """
    if symbiosis.settings.profile == "paper":
        return space_share(symbiosis)
    around = symbiosis.surroundings
    whole = enclosed(symbiosis)
    if not whole:
        return 0.0
    if symbiosis.settings.surrounded == "flood":
        return float(around.dry[around.space].sum() / whole)
    return float(doubled(around.sights[around.space], around.directions) / around.directions / whole)


def symbiotic(symbiosis: Symbiosis) -> float:
    """Give the mean of the two shares.

    Parameters
    ----------
    symbiosis
        Of both.

    Returns
    -------
    float
        0 to 1.
    """
    return (enclosure_share(symbiosis) + space_share(symbiosis)) / 2.0
