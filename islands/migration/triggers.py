"""Conditions on a deme under which a channel carries, besides its interval."""

from __future__ import annotations

from islands.migration.channel import Trigger


def pulled(trigger: Trigger | None, stagnant: int, diversity: float | None) -> bool:
    """Tell whether a channel's condition holds at an epoch's end.

    Parameters
    ----------
    trigger
        The condition; it always holds without one.
    stagnant
        Generations since the deme's best fitness last rose above all before.
    diversity
        The deme's; ``None`` for fewer than two members, which are never too much alike.
    """
    if trigger is None:
        return True
    if trigger.stagnation is not None and stagnant < trigger.stagnation:
        return False
    return trigger.diversity is None or (diversity is not None and diversity < trigger.diversity)
