"""The environment that a form grows in."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from growth.environment import _kernels as kernels
from growth.environment.boundaries.protocol import Boundary
from growth.environment.release import inside_any, released

Floats = NDArray[np.float64]


@final
@dataclass(frozen=True, slots=True, eq=False)
class Environment:
    """Forces and boundaries; immutable, and plain enough to be sent to another process.

    Attributes
    ----------
    settings
        The definition as resolved, every default written out, JSON-able; a mesh keeps its path as given and gets the
        hash of its contents. :func:`~growth.environment.load.environment_from` takes it back.
    digest
        A hash of what the environment means: settings, and meshes by their contents wherever they lie.
    mesh_files
        The mesh paths as given, and where they were found.
    """

    settings: Mapping[str, Any]
    digest: str
    mesh_files: tuple[tuple[str, Path], ...]
    _gravity: Floats
    _sources: Floats
    _hard: tuple[Boundary, ...]
    _soft: tuple[Boundary, ...]

    @staticmethod
    def empty() -> Environment:
        """Give empty space: no force, no boundary."""
        from growth.environment.load import environment_from

        return environment_from({}, "empty environment", Path())

    @property
    def has_hard(self) -> bool:
        """Whether there is any boundary that growth may not pass."""
        return bool(self._hard)

    @property
    def boundaries(self) -> Sequence[Boundary]:
        """All boundaries, the hard ones first."""
        return (*self._hard, *self._soft)

    def forces(self, points: ArrayLike) -> Floats:
        """Give the sum of forces on each point.

        Parameters
        ----------
        points
            (n, 3).

        Returns
        -------
        (n, 3) float64: gravity, plus strength / distance^exponent towards each attractor and away from each
        repeller (Hemberg 2006, section 4.7). The distance counts as at least ``LEAST_DISTANCE``; a source exactly at a
        point adds nothing.
        """
        return kernels.forces(_rows(points), self._gravity, self._sources)

    def move(self, start: ArrayLike, end: ArrayLike) -> Floats:
        """Move points until they meet a hard boundary.

        Parameters
        ----------
        start, end
            (n, 3), where each point is and where it would go.

        Returns
        -------
        (n, 3) float64: the end exactly, where nothing is met on the way; else a place on the way a skin before the
        first hard boundary, or the start where it is nearer than that. None is within a hard boundary as long as its
        start was not.
        """
        here, there = _rows(start), _rows(end)
        if not self._hard:
            return there.copy()
        fractions = np.full(len(here), np.inf)
        for boundary in self._hard:
            kernels.backed_off(here, there, boundary.first_hit(here, there), boundary.skin, fractions)
        out = kernels.cut_short(here, there, fractions)
        within = np.flatnonzero(inside_any(self._hard, out))
        if len(within):
            out[within] = self._rescued(here[within], out[within])
        return out

    def _rescued(self, start: Floats, points: Floats) -> Floats:
        """Release the points that a rounding error, or a start within a solid, left in one; else leave them behind."""
        free = released(self._hard, points)
        if free is not None:
            return free
        out = points.copy()
        for index in range(len(points)):
            one = released(self._hard, points[index : index + 1])
            out[index] = start[index] if one is None else one[0]
        return out

    def release(self, points: ArrayLike) -> Floats | None:
        """Move the points that are within hard boundaries to the nearest free place.

        Parameters
        ----------
        points
            (n, 3).

        Returns
        -------
        (n, 3) float64, free points unchanged; None where there is no free place for one.
        """
        places = _rows(points)
        return released(self._hard, places) if self._hard else places.copy()

    def inside(self, points: ArrayLike) -> NDArray[np.bool_]:
        """Say of each point (n, 3) whether it is within a hard boundary's solid side; on its surface it is not."""
        return inside_any(self._hard, _rows(points))

    def wrong_side(self, points: ArrayLike) -> int:
        """Count the points (n, 3) within the solid sides of the soft boundaries, summed over these boundaries."""
        places = _rows(points)
        return sum(int(boundary.inside(places).sum()) for boundary in self._soft)


def _rows(points: ArrayLike) -> Floats:
    return np.ascontiguousarray(points, dtype=np.float64).reshape(-1, 3)
