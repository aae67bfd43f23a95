"""Applies criteria of any sort of form; whatever goes wrong becomes a failure with the criterion's name."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from functools import lru_cache
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
            value: Any = criterion(*seen)
            # Most give a float, and to ask an abstract class costs as much as a small criterion.
            if type(value) is not float and (isinstance(value, (bool, np.bool_)) or not isinstance(value, Real)):
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
    """Give a frozen dataclass with views of its arrays that cannot be written to, those in its tuples too."""
    kind: Any = type(value)
    made: T = kind(**{name: _sealed(getattr(value, name)) for name in _names(kind)})
    return made


def _sealed(value: Any) -> Any:  # noqa: ANN401 - a field, whatever it is
    if isinstance(value, np.ndarray):
        return _locked(value)
    if not isinstance(value, tuple):
        return value
    items: list[Any] = [
        read_only(one) if is_dataclass(one) and not isinstance(one, type) else _sealed(one) for one in value
    ]
    made: Any = type(value)
    return made(*items) if hasattr(value, "_fields") else made(items)


@lru_cache(maxsize=64)
def _names(kind: Any) -> tuple[str, ...]:  # noqa: ANN401 - a class, which mypy holds for unhashable
    assert is_dataclass(kind)
    return tuple(field.name for field in fields(kind) if field.init)


def _locked(array: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    view = array.view()
    view.flags.writeable = False
    return view
