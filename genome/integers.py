"""The genotype of grammatical evolution: an immutable list of integers.

Its encoding in logs, checkpoints and migrants is a JSON list, which every language reads.
"""

from __future__ import annotations

import json

import numpy as np

from genome.errors import InputError
from genome.settings import describe

Genes = tuple[int, ...]


def random_genes(rng: np.random.Generator, length: int, ceiling: int) -> Genes:
    """Draw a genome.

    Parameters
    ----------
    rng
        Where the genes are drawn from.
    length
        How many there are.
    ceiling
        Genes are uniform over the integers from 0 up to, and without, this.

    Returns
    -------
    tuple of int
    """
    return tuple(rng.integers(0, ceiling, size=length).tolist())


def encode(genes: Genes) -> str:
    """Write a genome as a JSON list without spaces."""
    return f"[{','.join(map(str, genes))}]"


def decode(text: str, where: str = "genotype") -> Genes:
    """Read a genome from its encoding.

    Parameters
    ----------
    text
        A JSON list of integers of 0 or more, below 2**63.
    where
        The place that an error names.

    Raises
    ------
    InputError
        For anything else.
    """
    try:
        values = json.loads(text)
    except (ValueError, RecursionError):
        values = text
    if not isinstance(values, list):
        raise InputError(where, "a JSON list of integers", describe(values))
    for value in values:
        if type(value) is not int or not 0 <= value < 2**63:
            raise InputError(where, "integers from 0 to 2**63 - 1", describe(value))
    return tuple(values)
