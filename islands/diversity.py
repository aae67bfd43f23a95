"""How different the members of a deme are."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def hamming_diversity(genomes: Sequence[Sequence[int]]) -> float | None:
    """Give the mean normalised Hamming distance over all pairs of genomes.

    Genomes are padded at their ends to the length of the longest; the distance of two is the share of positions at
    which they differ, where a gene differs from the padding and padding equals padding. So the value lies between
    0 (all alike) and 1 (no two share a gene at any position).

    Parameters
    ----------
    genomes
        Integers, one sequence a genome.

    Returns
    -------
    The mean; ``None`` for fewer than two genomes, 0 when all are empty.
    """
    count = len(genomes)
    if count < 2:
        return None
    length = max(len(genome) for genome in genomes)
    if length == 0:
        return 0.0
    if all(len(genome) == length for genome in genomes):
        table = np.array(genomes, dtype=np.int64)
    else:
        floor = min(min(genome, default=0) for genome in genomes) - 1
        table = np.full((count, length), floor, dtype=np.int64)
        for row, genome in zip(table, genomes, strict=True):
            row[: len(genome)] = genome
    # Equal pairs are counted column by column, from the runs of equal values in the sorted column.
    ordered = np.sort(table, axis=0).T
    starts = np.ones(ordered.shape, dtype=bool)
    starts[:, 1:] = ordered[:, 1:] != ordered[:, :-1]
    runs = np.diff(np.append(np.flatnonzero(starts.ravel()), ordered.size))
    equal = int((runs * (runs - 1) // 2).sum())
    pairs = count * (count - 1) // 2
    return (pairs * length - equal) / (pairs * length)
