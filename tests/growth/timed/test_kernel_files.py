"""Files whose kernels call those of other files say what these were: Numba keeps compiled kernels by their own file."""

from __future__ import annotations

import ast
import hashlib
from pathlib import Path

import pytest

FOLDER = Path(__file__).resolve().parents[3] / "growth" / "timed"
FILES = ("_births", "_expressions", "_rewriting", "_words")


def called(path: Path) -> set[str]:
    """Give the kernel files that a file imports from."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    modules = [node.module or "" for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    return {module.rsplit(".", 1)[-1] for module in modules if module.rsplit(".", 1)[-1].startswith("_")} - {
        "__future__"
    }


@pytest.mark.parametrize("name", FILES)
def test_a_file_of_kernels_knows_those_that_it_calls(name: str) -> None:
    """Where this fails after a change, write the told text into STANDS_ON: that makes Numba compile the file anew."""
    path = FOLDER / f"{name}.py"
    source = path.read_text(encoding="utf-8")
    stated = [ast.literal_eval(node.value) for node in ast.parse(source).body
              if isinstance(node, ast.AnnAssign) and node.value is not None
              and isinstance(node.target, ast.Name) and node.target.id == "STANDS_ON"]  # fmt: skip
    expected = {
        other: hashlib.sha256((FOLDER / f"{other}.py").read_bytes()).hexdigest()[:12] for other in sorted(called(path))
    }
    assert (stated[0] if stated else {}) == expected
