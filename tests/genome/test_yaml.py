"""Strict YAML: what scalars mean, what is refused, and where."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from genome.errors import InputError
from genome.yaml import load_yaml, parse_yaml


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1e-1", 0.1),
        ("1E3", 1000.0),
        ("1.", 1.0),
        (".5", 0.5),
        ("-.5e2", -50.0),
        ("+3", 3),
        ("-0", 0),
        ("0.25", 0.25),
        ("0o17", 15),
        ("0x1F", 31),
        ("no", "no"),
        ("Yes", "Yes"),
        ("on", "on"),
        ("off", "off"),
        ("n", "n"),
        ("1_000", "1_000"),
        ("12:30", "12:30"),
        ("2001-01-01", "2001-01-01"),
        ("0b11", "0b11"),
        ("true", True),
        ("FALSE", False),
        ("null", None),
        ("~", None),
        ("", None),
        ("'12'", "12"),
        ('"true"', "true"),
        ("!!str 12", "12"),
        ("!!int 12", 12),
        (".inf", math.inf),
        ("-.INF", -math.inf),
        ("hello world", "hello world"),
        ("1e", "1e"),
    ],
)
def test_a_scalar_means_what_yaml_1_2_says(text: str, value: object) -> None:
    got = parse_yaml(f"key: {text}\n", "a.yaml").data["key"]
    assert got == value
    assert type(got) is type(value)


def test_not_a_number_is_read_as_such() -> None:
    assert math.isnan(parse_yaml("key: .nan", "a.yaml").data["key"])


def test_the_directive_for_yaml_1_1_changes_no_scalar() -> None:
    assert parse_yaml("%YAML 1.1\n---\nkey: no\nwhen: 1:30\n", "a.yaml").data == {"key": "no", "when": "1:30"}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "a.yaml: expected YAML keys and values, got an empty file"),
        ("# only a comment\n", "a.yaml: expected YAML keys and values, got an empty file"),
        ("---\n", "a.yaml: expected YAML keys and values, got an empty file"),
        ("a: 1\nb: 2\na: 3\n", "a.yaml:3: expected each key once, got 'a' again (line 1); remove one of them"),
        ("a: {b: 1, b: 2}\n", "a.yaml:1: expected each key once, got 'b' again (line 1); remove one of them"),
        ("a: 1\n---\nb: 2\n", "a.yaml:2:1: expected one document, got another '---'; split the file"),
        ("1: a\n", "a.yaml:1: expected a text as key, got 1; write '1' in quotes"),
        ("[1, 2]: a\n", "a.yaml:1: expected a text as key, got a list or mapping"),
        (
            "a: !!python/name:os.system x\n",
            "a.yaml:1:4: expected plain YAML, got the tag !!python/name:os.system; remove the tag",
        ),
        ("a: !foo [1]\n", "a.yaml:1:4: expected plain YAML, got the tag !foo; remove the tag"),
        ("a: !!int x\n", "a.yaml:1:4: expected plain YAML, got the tag !!int; remove the tag"),
        ("a: *b\n", "a.yaml:1:4: expected an anchor '&b' that ends before it is used, got '*b'"),
        ("a: &a [*a]\n", "a.yaml:1:8: expected an anchor '&a' that ends before it is used, got '*a'"),
        (
            "a: 012\n",
            (
                "a.yaml:1:4: expected a number without leading zeros, got 012; "
                "drop the zeros, or put a text in quotes; octal is 0o17"
            ),
        ),
        ("<<: 3\n", "a.yaml:1: expected a mapping (or a list of them) to merge, got another value"),
    ],
)
def test_a_refusal_says_where_and_what(text: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_yaml(text, "a.yaml")
    assert str(caught.value) == message


@pytest.mark.parametrize(
    "text", ["a: [1, 2\n", "a: b: c\n", "\ta: 1\n", "a: 'x\n", "a: \x00\n", "%YAML 3.0\n---\na: 1\n", "a: }\n"]
)
def test_malformed_yaml_is_an_input_error_with_its_file(text: str) -> None:
    with pytest.raises(InputError, match=r"^a\.yaml.*expected well-formed YAML"):
        parse_yaml(text, "a.yaml")


def test_nested_aliases_that_stand_for_billions_are_refused() -> None:
    lines = ["a0: &a0 [x, x, x, x, x, x, x, x, x, x]"]
    for level in range(1, 12):
        uses = ", ".join([f"*a{level - 1}"] * 10)
        lines.append(f"a{level}: &a{level} [{uses}]")
    with pytest.raises(InputError, match="at most 1000000 values"):
        parse_yaml("\n".join(lines), "a.yaml")


@pytest.mark.parametrize(
    "text",
    ["[" * 5000, "- " * 3000 + "x", "\n".join(f"a{i}: &a{i} [{f'*a{i - 1}' if i else 'x'}]" for i in range(2000))],
)
def test_deep_nesting_is_refused_and_does_not_overflow(text: str) -> None:
    with pytest.raises(InputError, match="at most 64 levels"):
        parse_yaml(text, "a.yaml")


def test_an_alias_is_a_copy_and_a_merge_key_gives_defaults() -> None:
    data = parse_yaml("a: &a {x: 1, y: [2]}\nb: *a\nc: {<<: *a, x: 3}\n", "a.yaml").data
    assert data == {"a": {"x": 1, "y": [2]}, "b": {"x": 1, "y": [2]}, "c": {"x": 3, "y": [2]}}
    data["a"]["y"].append(9)
    assert data["b"]["y"] == data["c"]["y"] == [2]


def test_lines_of_paths() -> None:
    document = parse_yaml("# first\na: 1\nb:\n  - x: 1\n    y: 2\n  - {x: 3}\n", "a.yaml")
    assert document.line_of(()) == 2
    assert document.line_of(("a",)) == 2
    assert document.line_of(("b",)) == 3
    assert document.line_of(("b", 0, "y")) == 5
    assert document.line_of(("b", 1)) == 6
    assert document.line_of(("b", 0, "tagged", "y")) == 5
    assert document.line_of(("b", 0, "missing")) == 4


def test_a_missing_file_a_folder_and_latin_1(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="expected a YAML file, got no such file; check the path"):
        load_yaml(tmp_path / "none.yaml")
    with pytest.raises(InputError, match="expected a YAML file, got a folder"):
        load_yaml(tmp_path)
    (tmp_path / "latin.yaml").write_bytes(b"a: 1\nb: \xe9t\xe9\n")
    with pytest.raises(InputError, match=r"latin\.yaml:2: expected UTF-8 text, got the byte 0xe9"):
        load_yaml(tmp_path / "latin.yaml")
    (tmp_path / "bom.yaml").write_bytes(b"\xef\xbb\xbfa: \xc3\xa9t\xc3\xa9\n")
    assert load_yaml(tmp_path / "bom.yaml").data == {"a": "\u00e9t\u00e9"}


_words = st.text(alphabet=st.characters(min_codepoint=32, max_codepoint=126), max_size=20)
_scalars = st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | _words
_values = st.recursive(_scalars, lambda inner: st.lists(inner) | st.dictionaries(_words, inner), max_leaves=12)


@given(st.dictionaries(_words, _values, min_size=1), st.sampled_from([None, 2]))
def test_every_json_text_is_read_as_json(data: dict[str, object], indent: int | None) -> None:
    assert parse_yaml(json.dumps(data, indent=indent), "a.yaml").data == data


@given(st.text(alphabet="ab:-[]{},&*!<'\"\n #|>?%@0.", max_size=60))
def test_any_text_is_read_or_refused_never_a_crash(text: str) -> None:
    where = "a.yaml"
    try:
        where = parse_yaml(text, "a.yaml").source
    except InputError as error:
        where = error.where
    assert where.startswith("a.yaml")
