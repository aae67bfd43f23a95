"""Strict settings, and the one error that says what is wrong with them."""

from __future__ import annotations

from typing import Annotated

import pytest
from pydantic import Field, JsonValue

from genome.errors import InputError
from genome.settings import Settings, Vector3, validated


class Part(Settings):
    weight: float = 1.0
    place: Vector3 = (0.0, 0.0, 0.0)
    environment: str | dict[str, JsonValue] | None = None


class Whole(Settings):
    size: int
    parts: Annotated[dict[str, Part], Field(min_length=1)]


GOOD = {"size": 3, "parts": {"a": {"weight": 2, "place": [1, 2, 3]}}}


def refusal(data: object) -> str:
    with pytest.raises(InputError) as caught:
        validated(Whole, data, "f.yaml", line_of=lambda path: 10 * len(path))
    return str(caught.value)


def test_good_data_passes_with_whole_numbers_for_floats() -> None:
    whole = validated(Whole, GOOD, "f.yaml")
    assert whole.parts["a"] == Part(weight=2.0, place=(1.0, 2.0, 3.0))


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (7, "f.yaml: expected keys and values, got 7"),
        ({"size": 3, "parts": {}}, "f.yaml:10: parts: expected at least 1 of them, got {}"),
        ({"size": 3, "parts": [1]}, "f.yaml:10: parts: expected keys and values, got [1]"),
        ({"parts": {"a": {}}}, "f.yaml:10: size: expected a value for 'size', got nothing; add the key"),
        ({"siez": 3, "parts": {"a": {}}}, "f.yaml:10: siez: expected a known key, got 'siez'; did you mean 'size'?"),
        ({**GOOD, "parts": {"a": {"weigth": 1}}}, "f.yaml:30: parts.a.weigth: expected a known key, got 'weigth'; did"),
        ({**GOOD, "size": True}, "f.yaml:10: size: expected a whole number, got True"),
        ({**GOOD, "size": "3"}, "f.yaml:10: size: expected a whole number, got '3'"),
        (
            {**GOOD, "parts": {"a": {"weight": float("nan")}}},
            "f.yaml:30: parts.a.weight: expected a finite number, got",
        ),
        ({**GOOD, "parts": {"a": {"place": [1, 2]}}}, "f.yaml:30: parts.a.place: expected a list of three numbers: [x"),
        (
            {**GOOD, "parts": {"a": {"place": 1}}},
            "f.yaml:30: parts.a.place: expected a list of three numbers: [x, y, z]",
        ),
        ({**GOOD, "parts": {"a": {"place": [1, 2, "x"]}}}, "f.yaml:40: parts.a.place.2: expected a number, got 'x'"),
        (
            {**GOOD, "parts": {"a": {"environment": {"gravity": [0, 0, float("nan")]}}}},
            "f.yaml:50: parts.a.environment.gravity.2: expected a finite number, got nan",
        ),
    ],
)
def test_what_is_wrong_is_said_with_its_key_and_line(data: object, message: str) -> None:
    assert refusal(data).startswith(message)
