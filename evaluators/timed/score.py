"""Scores a form that unfolds by several criteria; whatever goes wrong becomes a failure with the criterion's name."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from evaluators.applying import applied, read_only
from evaluators.timed.registry import TimedCriterion, resolve_all
from evaluators.timed.unfolding import Unfolding
from growth.protocol import Failure
from growth.timed.drawing import Drawing, Shape


def score(unfolding: Unfolding, criteria: Iterable[str] | Mapping[str, TimedCriterion]) -> dict[str, float] | Failure:
    """Apply criteria to a form that unfolds.

    Parameters
    ----------
    unfolding
        The criteria see it through arrays that cannot be written to.
    criteria
        Their names, or the criteria by name as :func:`evaluators.timed.registry.resolve_all` gives them.

    Returns
    -------
    dict of str to float, or Failure
        As of :func:`evaluators.applying.applied`.

    Raises
    ------
    InputError
        For a name that is no criterion.
    """
    found = resolve_all(criteria)
    sealed = read_only(replace(unfolding, drawings=tuple(_sealed(drawing) for drawing in unfolding.drawings)))
    return applied(found, sealed)


def _sealed(drawing: Drawing) -> Drawing:
    return read_only(replace(drawing, shapes=tuple(_locked(shape) for shape in drawing.shapes)))


def _locked(shape: Shape) -> Shape:
    vertices, triangles = shape.vertices.view(), shape.triangles.view()
    vertices.flags.writeable = triangles.flags.writeable = False
    return shape._replace(vertices=vertices, triangles=triangles)
