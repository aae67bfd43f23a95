"""Mishaps of plug-ins told in a line, and what is no mishap let through."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from genome.mishaps import MOST_CHARACTERS, let_pass, one_line, plain, told


@given(st.text(st.characters()) | st.text(st.characters(categories=["Cs", "Cc", "Zs"])), st.integers(5, 60))
def test_any_text_becomes_one_printable_line_of_utf_8(text, most) -> None:
    line = one_line(text, most)
    assert len(line.encode()) >= len(line) <= most
    assert line.isprintable()
    assert line == " ".join(line.split())


def test_plain_texts_stay_as_they_are_and_the_rest_can_be_read() -> None:
    assert one_line("Größe 3.5, ok") == "Größe 3.5, ok"
    assert one_line("bad \udcff\n\ttext\x1b[31m\0") == "bad \\udcff text\\x1b[31m\\x00"
    assert one_line("x" * 1000) == "x" * (MOST_CHARACTERS - 1) + "…"
    assert one_line(" " * 10**5 + "far") == "…"


def test_exceptions_are_told_by_type_and_text_even_when_their_text_is_broken() -> None:
    class BrokenError(Exception):
        def __str__(self) -> str:
            raise RuntimeError

    assert told(ValueError("no\n luck")) == "ValueError: no luck"
    assert told(SystemExit()) == "SystemExit"
    assert told(BrokenError()) == "BrokenError"


def test_details_become_plain_json() -> None:
    detail = {"id": 3, "share": np.float32(0.5), "count": np.int64(2), "labels": (1, [None, True])}
    assert plain(detail) == {"id": 3, "share": 0.5, "count": 2, "labels": [1, [None, True]]}
    odd = {"a\n\udcff": float("nan"), 2: "x\udcff", "object": {1}}
    assert plain(odd) == {"a \\udcff": "nan", "2": "x\\udcff", "object": "{1}"}
    json.dumps(plain(odd), allow_nan=False).encode()


def test_ctrl_c_passes_also_inside_another_and_a_plug_in_s_exit_does_not() -> None:
    with pytest.raises(KeyboardInterrupt):
        let_pass(KeyboardInterrupt())
    wrapped = SystemError("a result with an exception set")
    wrapped.__cause__ = KeyboardInterrupt()
    with pytest.raises(KeyboardInterrupt):
        let_pass(wrapped)
    circle = ValueError()
    circle.__cause__, circle.__context__ = circle, circle
    for error in (SystemExit(2), GeneratorExit(), ValueError(), circle):
        let_pass(error)
    ended = SystemExit(1)
    ended.ray_terminate_msg = "The process receives a SIGTERM."  # type: ignore[attr-defined]
    with pytest.raises(SystemExit):
        let_pass(ended)
