"""Scores a form by several criteria; whatever goes wrong becomes a failure with the criterion's name."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from numbers import Real
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from evaluators.registry import Criterion, resolve_all
from genome.mishaps import let_pass, told
from growth.protocol import Failure
from growth.surface import Surface

if TYPE_CHECKING:
    from growth.environment import Environment


def score(
    surface: Surface, environment: Environment, criteria: Iterable[str] | Mapping[str, Criterion]
) -> dict[str, float] | Failure:
    """Apply criteria to a form.

    Parameters
    ----------
    surface
        A form. The criteria see it through arrays that cannot be written to.
    environment
        Where it grew.
    criteria
        Their names, or the criteria by name as :func:`evaluators.registry.resolve_all` gives them, which saves looking
        each up for every form.

    Returns
    -------
    dict of str to float, or Failure
        Finite scores in the order of the criteria; or ``evaluation`` with the first criterion that raised an exception
        or did not give a finite number.

    Raises
    ------
    InputError
        For a name that is no criterion.
    KeyboardInterrupt
        On Ctrl-C.
    """
    found = criteria if isinstance(criteria, Mapping) else resolve_all(criteria)
    seen = _read_only(surface)
    scores: dict[str, float] = {}
    for name, criterion in found.items():
        try:
            value: object = criterion(seen, environment)
            if isinstance(value, (bool, np.bool_)) or not isinstance(value, Real):
                return Failure("evaluation", f"{name}: a number was expected, not {type(value).__name__}")
            number = float(value)
        except BaseException as error:  # noqa: BLE001 - a criterion, a plug-in above all, may fail in any way
            let_pass(error)
            return Failure("evaluation", f"{name}: {told(error)}")
        if not math.isfinite(number):
            return Failure("evaluation", f"{name}: {number} is not a finite number")
        scores[name] = number
    return scores


def _read_only(surface: Surface) -> Surface:
    return Surface(
        _locked(surface.vertices),
        _locked(surface.edges),
        _locked(surface.labels),
        surface.label_names,
        _locked(surface.face_starts),
        _locked(surface.face_vertices),
    )


def _locked(array: NDArray[Any]) -> NDArray[Any]:
    view = array.view()
    view.flags.writeable = False
    return view
