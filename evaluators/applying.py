"""Applies criteria of any sort of form; whatever goes wrong becomes a failure with the criterion's name."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass, replace
from numbers import Real
from typing import Any, TypeVar

import numpy as np

from genome.mishaps import let_pass, told
from growth.protocol import Failure

T = TypeVar("T")


def applied(criteria: Mapping[str, Callable[..., float]], *seen: object) -> dict[str, float] | Failure:
    """Apply criteria to what they see.

    Returns
    -------
    dict of str to float, or Failure
        Finite scores in the order of the criteria; or ``evaluation`` with the first criterion that raised an exception
        or did not give a finite number.

    Raises
    ------
    KeyboardInterrupt
        On Ctrl-C.
    """
    scores: dict[str, float] = {}
    for name, criterion in criteria.items():
        try:
            value: object = criterion(*seen)
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


def read_only(value: T) -> T:
    """Give a frozen dataclass with views of its arrays that cannot be written to."""
    assert is_dataclass(value)
    assert not isinstance(value, type)
    arrays = {field.name: getattr(value, field.name) for field in fields(value)}
    return replace(value, **{name: _locked(one) for name, one in arrays.items() if isinstance(one, np.ndarray)})


def _locked(array: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    view = array.view()
    view.flags.writeable = False
    return view
