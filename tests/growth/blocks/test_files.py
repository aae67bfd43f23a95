"""Bodies given cell by cell, and settings of growth."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from genome.errors import InputError
from genome.lsystem import LSystemGenome, decode, encode, format_blocks, parse_blocks
from genome.settings import validated
from growth.blocks import BlockGrowth, read_body

PAGE = Path(__file__).resolve().parents[3] / "docs" / "formats" / "blocks.md"


def written(tmp_path: Path, data: object) -> Path:
    path = tmp_path / "x.body.json"
    path.write_text(data if isinstance(data, str) else json.dumps(data), encoding="utf-8")
    return path


def test_a_body_is_read_in_order_with_its_supports(tmp_path: Path) -> None:
    cells = [[0, 0, 3], [0, 0, 1], [2, 0, 2]]
    body = read_body(written(tmp_path, {"cells": cells, "supports": [[0, 1, 1], [0, 0, 0]], "lattice": "cubic"}))
    assert body.internal.tolist() == cells
    assert body.boundary.tolist() == [[0, 0, 0], [0, 1, 1]]
    assert body.lattice.name == "cubic"
    assert body.envelope.tolist() == []


def test_without_supports_a_body_stands_on_its_ground(tmp_path: Path) -> None:
    path = written(tmp_path, {"cells": [[0, 0, 2], [0, 1, 1]], "lattice": "isospatial"})
    assert read_body(path).boundary.tolist() == [[-1, 1, 0], [0, 0, 0], [0, 2, 0], [1, 1, 0]]
    fixed = BlockGrowth(ground="fixed", ground_level=9, supports=((5, 5, 5),), envelope=True, envelope_below=27)
    body = read_body(path, fixed)
    assert body.boundary.tolist() == []
    assert body.envelope.tolist() == []  # all that is free lies under the ground


@pytest.mark.parametrize(
    ("data", "said"),
    [
        ("{", ":1:2: expected JSON, got an error in it: Expecting property name enclosed in double quotes"),
        ("[]", ": expected a JSON object with the key 'cells', got []"),
        ({}, ": expected a list of cells under 'cells', got none; add the key"),
        ({"cels": []}, ": cels: expected a known key, got 'cels'; did you mean 'cells'?"),
        ({"cells": []}, ": cells: expected a list of cells: [[x, y, z], ...], got []"),
        ({"cells": [[0, 0]]}, ": cells: expected a cell of three whole numbers: [x, y, z], got [0, 0]"),
        ({"cells": [[0, 0, 0.5]]}, ": cells: expected a cell of three whole numbers: [x, y, z], got [0, 0, 0.5]"),
        ({"cells": [[0, 0, True]]}, ": cells: expected a cell of three whole numbers: [x, y, z], got [0, 0, True]"),
        ({"cells": [[0, 0, 500001]]}, ": cells: expected coordinates of 500000 at most, got [0, 0, 500001]"),
        ({"cells": [[0, 0, 1], [0, 0, 1]]}, ": cells: expected each cell once, got [0, 0, 1] twice"),
        (
            {"cells": [[0, 0, 1]], "supports": [[0, 0, 1]]},
            ": cells: expected cells that are no supports, got [0, 0, 1]",
        ),
        ({"cells": [[0, 0, 1]], "supports": 3}, ": supports: expected a list of cells: [[x, y, z], ...], got 3"),
        ({"cells": [[0, 0, 1]], "lattice": "hex"}, ": lattice: expected one of cubic, isospatial, got 'hex'"),
        (
            {"cells": [[0, 0, 1]], "lattice": "isospatial"},
            ": cells: expected cells of the isospatial lattice, whose coordinates add up to an even number, got",
        ),
    ],
)
def test_what_is_no_body_is_told(tmp_path: Path, data: object, said: str) -> None:
    path = written(tmp_path, data)
    with pytest.raises(InputError) as caught:
        read_body(path)
    assert str(caught.value).removeprefix(str(path)).startswith(said)


def test_a_file_that_is_not_there_or_no_text_is_told(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"expected a body's file, got no such file"):
        read_body(tmp_path / "none.body.json")
    path = tmp_path / "x.body.json"
    path.write_bytes(b"\xff\xfe")
    with pytest.raises(InputError, match="expected a body as JSON in UTF-8, got something else"):
        read_body(path)


@pytest.mark.parametrize(
    ("data", "said"),
    [
        ({"lattice": "hex"}, "x: lattice: expected 'cubic' or 'isospatial', got 'hex'"),
        ({"supports": []}, "x: supports: expected a list of cells: [[x, y, z], ...], got []"),
        ({"supports": [[1, 2]]}, "x: supports: expected a cell of three whole numbers: [x, y, z], got [1, 2]"),
        (
            {"supports": [[1, 0, 0]], "lattice": "isospatial"},
            "x: expected cells of the isospatial lattice, whose coordinates add up to an even number, got [1, 0, 0]",
        ),
        ({"max_blocks": 0}, "x: max_blocks: expected greater than or equal to 1, got 0"),
        ({"envelope_below": 28}, "x: envelope_below: expected less than or equal to 27, got 28"),
    ],
)
def test_settings_that_make_no_sense_are_told(data: dict[str, object], said: str) -> None:
    with pytest.raises(InputError) as caught:
        validated(BlockGrowth, data, "x")
    assert str(caught.value) == said


def test_settings_take_what_they_write() -> None:
    settings = validated(BlockGrowth, {"supports": [[1, 2, 3]], "ground": "fixed"}, "x")
    assert validated(BlockGrowth, settings.model_dump(mode="json"), "x") == settings


def test_the_page_of_the_format_says_what_is_so(tmp_path: Path) -> None:
    text = PAGE.read_text(encoding="utf-8")
    blocks = [block.partition("\n")[::2] for block in text.split("```")[1::2]]
    (example,) = (code for kind, code in blocks if not kind)
    tree = (PAGE.parents[2] / "experiments" / "systems" / "tree.blocks").read_text(encoding="utf-8")
    assert example == tree
    assert parse_blocks(format_blocks(parse_blocks(tree))) == parse_blocks(tree)
    genotype, body = (code.strip() for kind, code in blocks if kind == "json")
    assert encode(decode(genotype)) == genotype
    assert len(read_body(written(tmp_path, body)).cells) == 4
    for model in (BlockGrowth(), LSystemGenome()):
        rows = {
            name.strip("` "): row
            for row in text.split("\n")
            if row.startswith("| `")
            for name in row[2:].split("|")[0].split(",")
        }
        for name in type(model).model_fields:
            assert name in rows, name
            value = getattr(model, name)
            shown = str(list(value)) if isinstance(value, tuple) else str(value)
            shown = shown.lower() if isinstance(value, bool) else shown.removesuffix(".0")
            if name not in ("mutations", "supports", "axiom", "max_symbols", "max_depth"):
                assert rows[name].split(" | ")[1].strip("`") == shown, name


def test_a_key_that_is_given_twice_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "x.body.json"
    path.write_text('{"cells": [[0, 0, 0]], "cells": [[0, 0, 1]]}', encoding="utf-8")
    with pytest.raises(InputError, match="expected each key once, got 'cells' twice"):
        read_body(path)
