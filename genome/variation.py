"""Variation of genomes: DEAP's operators on copies, inside the fence.

Genes behind the last one that a mapping read are silent. ``within`` tells the operators how many were read, so that a
cut, and the change that a mutation promises, fall where they can matter.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
from deap import tools

from genome.fence import fenced
from genome.integers import Genes

Crossover = Literal["one_point", "two_point"]


def crossover(
    a: Genes, b: Genes, rng: np.random.Generator, kind: Crossover = "one_point", within: int | None = None
) -> tuple[Genes, Genes]:
    """Cross two genomes.

    Parameters
    ----------
    a, b
        The parents; they may differ in length.
    rng
        Where the cuts are drawn from.
    kind
        ``one_point`` exchanges all behind one cut, ``two_point`` what lies between two.
    within
        The cuts lie inside the first ``within`` genes; 2 at least is taken. Without, anywhere in the shorter parent.

    Returns
    -------
    tuple of two genomes
        One-point children have the other parent's length, two-point children their own. Parents of fewer than two
        genes have no place to cut and come back as they are.
    """
    shared = min(len(a), len(b))
    if shared < 2:
        return a, b
    end = shared if within is None else min(max(within, 2), shared)
    head_a, head_b = list(a[:end]), list(b[:end])
    with fenced(rng):
        if kind == "one_point":
            tools.cxOnePoint(head_a, head_b)
            return (*head_a, *b[end:]), (*head_b, *a[end:])
        tools.cxTwoPoint(head_a, head_b)
    return (*head_a, *a[end:]), (*head_b, *b[end:])


def mutate(genes: Genes, rng: np.random.Generator, rate: float, ceiling: int, within: int | None = None) -> Genes:
    """Mutate a genome: each gene is drawn anew with a small chance, and at least one changes.

    Parameters
    ----------
    genes
        The parent.
    rng
        Where all is drawn from.
    rate
        The chance of each gene.
    ceiling
        Genes are uniform over the integers from 0 up to, and without, this.
    within
        The change that is promised falls among the first ``within`` genes; without, anywhere.

    Returns
    -------
    tuple of int
        Where no gene of those came out different, one of them, each as likely, is drawn uniformly from the values that
        it does not have. An empty genome, and one under a ceiling of 1, comes back as it is.
    """
    if not genes or ceiling < 2:
        return genes
    child = list(genes)
    with fenced(rng):
        tools.mutUniformInt(child, low=0, up=ceiling - 1, indpb=rate)
    end = len(genes) if within is None else min(max(within, 1), len(genes))
    if tuple(child[:end]) == genes[:end]:
        at = int(rng.integers(0, end))
        value = int(rng.integers(0, ceiling - 1))
        child[at] = value + 1 if value >= genes[at] else value
    return tuple(child)
