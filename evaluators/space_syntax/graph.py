"""Undirected graphs of spaces, as their neighbours in rows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from genome.errors import InputError

Ints = NDArray[np.int64]


@final
@dataclass(frozen=True, slots=True, eq=False)
class Graph:
    """Spaces 0 to n - 1 and what each is connected with; made by :func:`of_edges` or :func:`of_matrix`.

    Attributes
    ----------
    starts
        (n + 1,) int64: the neighbours of space i are ``neighbours[starts[i]:starts[i + 1]]``.
    neighbours
        (2 m,) int64, ascending for each space; each connection stands here once for either of its ends.
    """

    starts: Ints
    neighbours: Ints

    @property
    def count(self) -> int:
        """The number of spaces."""
        return self.starts.size - 1


def of_edges(edges: ArrayLike, count: int, where: str = "graph") -> Graph:
    """Make a graph from its connections.

    Parameters
    ----------
    edges
        (m, 2) of integers from 0 to ``count`` - 1, in any order and direction. One given several times counts once, one
        from a space to itself not at all.
    count
        The number of spaces, 0 or more.
    where
        The place that an error names.

    Raises
    ------
    InputError
        For edges of another shape or sort, or to spaces that there are not.
    """
    if count < 0:
        raise InputError(where, "0 spaces or more", str(count))
    pairs = np.asarray(edges)
    if not pairs.size:
        pairs = np.empty((0, 2), dtype=np.int64)
    if pairs.ndim != 2 or pairs.shape[1] != 2 or not np.issubdtype(pairs.dtype, np.integer):
        raise InputError(where, "edges as (m, 2) integers", f"{pairs.dtype} of shape {pairs.shape}")
    if len(pairs) and not 0 <= int(pairs.min()) <= int(pairs.max()) < count:
        got = f"one between {pairs[((pairs < 0) | (pairs >= count)).any(axis=1)][0].tolist()}"
        raise InputError(where, f"edges between spaces 0 to {count - 1}", got, "number the spaces from 0")
    ends = pairs[pairs[:, 0] != pairs[:, 1]].astype(np.int64)
    keys = np.unique(np.concatenate([ends[:, 0] * count + ends[:, 1], ends[:, 1] * count + ends[:, 0]]))
    first, second = np.divmod(keys, max(count, 1))
    starts = np.concatenate([[0], np.cumsum(np.bincount(first, minlength=count))]).astype(np.int64)
    return Graph(starts, second)


def of_matrix(matrix: Any, where: str = "graph") -> Graph:  # noqa: ANN401 - SciPy's arrays have no types
    """Make a graph from a sparse matrix: two spaces are connected where either of their entries is not 0.

    Raises
    ------
    InputError
        For a matrix that is not square.
    """
    from scipy.sparse import coo_array

    entries = coo_array(matrix)
    if len(set(entries.shape)) != 1:
        raise InputError(where, "a square matrix of connections", f"one of shape {entries.shape}")
    entries.eliminate_zeros()
    return of_edges(np.stack(entries.coords, axis=1), entries.shape[0], where)


def components(graph: Graph) -> tuple[Ints, Ints]:
    """Find the connected parts.

    Returns
    -------
    component : (n,) int64
        The part that each space is in, numbered in the order of their first spaces.
    sizes : (c,) int64
        The number of spaces in each.
    """
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import connected_components

    if not graph.count:
        return np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64)
    ones = np.ones(graph.neighbours.size)
    joined = csr_array((ones, graph.neighbours, graph.starts), shape=(graph.count, graph.count))
    _, found = connected_components(joined, directed=False)
    _, first, labels = np.unique(found, return_index=True, return_inverse=True)
    rank = np.argsort(np.argsort(first))
    component = np.asarray(rank[labels], dtype=np.int64)
    return component, np.bincount(component)
