"""Mutation: a chain of events, each of which takes place or not (Senatore 2009, 'mutation')."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from genome.lsystem.initial import random_seed
from genome.lsystem.mutations import EVENTS
from genome.lsystem.settings import LSystemGenome
from genome.lsystem.system import LSystem

TRIES: Final = 16
"""Events that are drawn until one changes something."""

RESEED: Final = "reseed"


def mutate(system: LSystem, rng: np.random.Generator, settings: LSystemGenome) -> LSystem:
    """Mutate an L-system: each event takes place with its rate, on a rule of its own draw; one at least does.

    Parameters
    ----------
    system
        The parent.
    rng
        Where all is drawn from.
    settings
        Rates, bounds, and what new branches are made of.

    Returns
    -------
    LSystem
        Axiom, operands, contexts, chances and iterations are the parent's. An event that leads out of the bounds, or
        to a system that never draws, does not take place. The parent itself, where no event can change it, or all
        rates are 0.
    """
    rates = settings.mutations.model_dump()
    child = system
    for name in (*EVENTS, RESEED):
        if rng.random() < rates[name]:
            child = _after(name, child, rng, settings)
    names = [name for name in (*EVENTS, RESEED) if rates[name] > 0.0]
    weights = np.array([rates[name] for name in names])
    for _ in range(TRIES if names else 0):
        if child != system:
            break
        child = _after(names[int(rng.choice(len(names), p=weights / weights.sum()))], child, rng, settings)
    return child


def _after(name: str, system: LSystem, rng: np.random.Generator, settings: LSystemGenome) -> LSystem:
    """Give a system after one event; as it is where that may not be."""
    if name == RESEED:
        return replace(system, seed=random_seed(rng)) if system.stochastic else system
    if not system.rules:
        return system
    at = int(rng.integers(len(system.rules)))
    old = system.rules[at]
    new = EVENTS[name](old.successor, rng, settings)
    if not settings.fits(new):
        return system
    rules = (*system.rules[:at], replace(old, successor=new), *system.rules[at + 1 :])
    child = replace(system, rules=rules)
    return child if child.draws else system
