"""The strict base of every settings model, and the translation of its complaints into one clear error.

Settings are pydantic models at the edge of the program. They forbid unknown keys, take no truth value for a
number and no number for a text, and refuse NaN and infinity. :func:`validated` turns what pydantic says into
an :class:`~genome.errors.InputError` that names the key and, for a misspelt one, the nearest that exists.
"""

from __future__ import annotations

import difflib
from collections.abc import Callable, Mapping
from typing import Annotated, Any, TypeVar, get_args

from pydantic import BaseModel, BeforeValidator, ConfigDict, ValidationError

from genome.errors import InputError

Path = tuple[str | int, ...]


class Settings(BaseModel):
    """A frozen, strict model: unknown keys, loose types, NaN and infinity are refused."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)


def _as_tuple(value: object) -> object:
    if isinstance(value, tuple):
        return value
    if not isinstance(value, list) or len(value) != 3:
        raise InputError("", "a list of three numbers: [x, y, z]", describe(value))
    return tuple(value)


Vector3 = Annotated[tuple[float, float, float], BeforeValidator(_as_tuple)]
"""Three finite numbers, written as a list: x, y, z."""

M = TypeVar("M", bound=BaseModel)

_PLAIN = {
    "dict_type": "keys and values",
    "mapping_type": "keys and values",
    "model_type": "keys and values",
    "model_attributes_type": "keys and values",
    "list_type": "a list",
    "tuple_type": "a list",
    "string_type": "text",
    "bool_type": "true or false",
    "int_type": "a whole number",
    "float_type": "a number",
    "finite_number": "a finite number",
    "too_short": "at least {min_length} of them",
    "too_long": "at most {max_length} of them",
    "string_too_short": "a text that is not empty",
    "string_too_long": "at most {max_length} characters",
    "string_pattern_mismatch": "a name of letters, digits and . _ -, that begins with a letter or digit",
}
"""What to say instead of pydantic's own words."""


def validated(
    model: type[M], data: object, source: str, prefix: Path = (), line_of: Callable[[Path], int | None] | None = None
) -> M:
    """Build ``model`` from plain data.

    Parameters
    ----------
    model
        The settings model.
    data
        What a YAML or JSON loader returned.
    source
        The file's name, for the message.
    prefix
        The key path at which ``data`` stands in that file.
    line_of
        Gives the line of a key path, where the loader knows it.

    Raises
    ------
    InputError
        For the first thing that is wrong.
    """
    if not isinstance(data, Mapping):
        raise InputError(_where(source, prefix, line_of), "keys and values", describe(data))
    try:
        return model.model_validate(dict(data))
    except ValidationError as error:
        raise _translated(model, *_telling(error, data), source, prefix, line_of) from None


def describe(value: object) -> str:
    """Give a short text of a value for an error message."""
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def near(word: str, known: list[str]) -> str:
    """Suggest the known word nearest to ``word``, or list them all."""
    close = difflib.get_close_matches(word, known, n=1, cutoff=0.6)
    return f"did you mean '{close[0]}'?" if close else f"known: {', '.join(sorted(known))}"


def _where(source: str, path: Path, line_of: Callable[[Path], int | None] | None) -> str:
    line = line_of(path) if line_of else None
    place = f"{source}:{line}" if line else source
    key = ".".join(str(part) for part in path)
    return f"{place}: {key}" if key else place


def _telling(error: ValidationError, data: Mapping[Any, Any]) -> tuple[dict[str, Any], Path]:
    """Choose the complaint that says most, and give it with its key path in the data.

    A misspelt key is also a missing one: the misspelling says more. Where a value may be of several types, pydantic
    complains once for each, under made-up keys: the complaint that got deepest into the data says more.
    """
    errors: list[dict[str, Any]] = [dict(one) for one in error.errors(include_url=False)]
    errors.sort(key=lambda one: one["type"] != "extra_forbidden")
    paths = [_within(data, tuple(one["loc"]), missing=one["type"] == "missing") for one in errors]
    best = 0
    if len(paths[0]) < len(errors[0]["loc"]):
        related = [i for i, path in enumerate(paths) if path[: len(paths[0])] == paths[0]]
        best = max(related, key=lambda i: (len(paths[i]), -i))
    return errors[best], paths[best]


def _within(data: Any, loc: Path, *, missing: bool) -> Path:  # noqa: ANN401 - walks plain data
    """Give the parts of a location that are keys of the data; a missing key is none, and yet counts."""
    found: list[str | int] = []
    for place, part in enumerate(loc):
        if _holds(data, part):
            data = data[part]
        elif not (missing and place == len(loc) - 1):
            continue
        found.append(part)
    return tuple(found)


def _holds(data: object, part: str | int) -> bool:
    if isinstance(data, Mapping):
        return part in data
    return isinstance(data, (list, tuple)) and isinstance(part, int) and part < len(data)


def _translated(
    model: type[BaseModel],
    error: dict[str, Any],
    loc: Path,
    source: str,
    prefix: Path,
    line_of: Callable[[Path], int | None] | None,
) -> InputError:
    where = _where(source, prefix + loc, line_of)
    kind = str(error["type"])
    if kind == "extra_forbidden":
        known = _fields_at(model, loc[:-1])
        return InputError(where, "a known key", describe(str(loc[-1])), near(str(loc[-1]), known) if known else "")
    if kind == "missing":
        return InputError(where, f"a value for '{loc[-1]}'", "nothing", "add the key")
    context = error.get("ctx") or {}
    if isinstance(context.get("error"), InputError):
        inner: InputError = context["error"]
        return InputError(where, inner.expected, inner.got, inner.remedy)
    plain = _PLAIN.get(kind, "{msg}").format(msg=error["msg"], **context)
    message = plain.removeprefix("Value error, ").removeprefix("Input should be ")
    return InputError(where, message, describe(error.get("input")))


def _fields_at(model: type[BaseModel], path: Path) -> list[str]:
    """Give the field names of the model that stands at ``path`` below ``model``; empty where that is no model."""
    current: object = model
    for part in path:
        if isinstance(current, type) and issubclass(current, BaseModel) and part in current.model_fields:
            current = _model_in(current.model_fields[str(part)].annotation)
        elif not (isinstance(current, type) and issubclass(current, BaseModel)):
            return []
    return _names(current)


def _names(current: object) -> list[str]:
    if isinstance(current, type) and issubclass(current, BaseModel):
        return [field.alias or name for name, field in current.model_fields.items()]
    return []


def _model_in(annotation: object) -> object:
    """Find the first model inside an annotation such as ``dict[str, Model] | None``."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    for argument in get_args(annotation):
        found = _model_in(argument)
        if found is not None:
            return found
    return None
