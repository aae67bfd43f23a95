"""How criteria are found by name, and how forms are scored by them."""

import sys

import plugin_criteria
import pytest
from plugged import install
from surfaces import SQUARE, TENT

from evaluators.registry import CRITERIA, resolve, resolve_all
from evaluators.score import score
from genome.errors import InputError
from growth.environment import Environment
from growth.protocol import Failure

HERE = Environment.empty()
LOST = "a criterion that can be imported, got"
MISSING = "which does not import (ModuleNotFoundError: No module named"
INSTALL = "install it, or put its folder on PYTHONPATH"
NOTHING = "module 'plugin_criteria' has no attribute 'nothing'"


@pytest.fixture
def installed(tmp_path, monkeypatch):
    points = {"shade": "plugin_criteria:vertices", "broken": "shade_missing:f", "size": "plugin_criteria:raises"}
    install(tmp_path, monkeypatch, "atoll.evaluators", **points)


class TestResolve:
    def test_the_projects_own(self):
        assert resolve("size") is CRITERIA["size"]

    @pytest.mark.parametrize("path", ["plugin_criteria:vertices", "plugin_criteria:Holder.inner"])
    def test_an_import_path(self, path):
        assert resolve(path) is plugin_criteria.vertices

    def test_an_entry_point(self, installed):
        assert resolve("shade") is plugin_criteria.vertices

    def test_a_plug_in_cannot_take_a_name_of_the_projects(self, installed):
        assert resolve("size") is CRITERIA["size"]

    def test_several_keep_their_order(self):
        assert list(resolve_all(["undulation", "size"])) == ["undulation", "size"]

    @pytest.mark.parametrize(
        ("name", "message"),
        [
            ("sise", "a criterion, got 'sise'; did you mean 'size'?"),
            ("shde", "a criterion, got 'shde'; did you mean 'shade'?"),
            ("a b:c", "a criterion's name or an import path 'package.module:object', got 'a b:c'"),
            (":f", "a criterion's name or an import path 'package.module:object', got ':f'"),
            ("no_such.module:f", f"{LOST} 'no_such.module:f', {MISSING} 'no_such'); {INSTALL}"),
            (
                "plugin_criteria:nothing",
                f"{LOST} 'plugin_criteria:nothing', which does not import (AttributeError: {NOTHING})",
            ),
            ("broken", f"{LOST} 'broken = shade_missing:f', {MISSING} 'shade_missing'); {INSTALL}"),
            ("plugin_criteria:NUMBER", "a criterion that can be called, got 'plugin_criteria:NUMBER', an int"),
        ],
    )
    def test_what_cannot_be_found_is_named(self, installed, name, message):
        with pytest.raises(InputError) as caught:
            resolve(name, "here")
        assert str(caught.value) == f"here: expected {message}"

    def test_a_module_that_fails_when_imported_is_named(self, tmp_path, monkeypatch):
        (tmp_path / "fails_at_import.py").write_text("1 / 0\n")
        monkeypatch.syspath_prepend(tmp_path)
        with pytest.raises(InputError) as caught:
            resolve("fails_at_import:f")
        assert str(caught.value).endswith(
            "'fails_at_import:f', which does not import (ZeroDivisionError: division by zero)"
        )
        assert "fails_at_import" not in sys.modules


class TestScore:
    def test_names_and_criteria_score_alike_in_their_order(self):
        names = ["undulation", "size", "plugin_criteria:vertices"]
        found = score(TENT, HERE, names)
        assert found == score(TENT, HERE, resolve_all(names))
        assert list(found.items()) == [("undulation", 3.0), ("size", 4.0), ("plugin_criteria:vertices", 5.0)]
        assert {type(value) for value in found.values()} == {float}

    def test_all_six_of_a_square(self):
        assert score(SQUARE, HERE, CRITERIA) == {
            "size": 2,
            "smoothness": 0,
            "soft_boundaries": 0,
            "subdivisions": 1,
            "symmetry": 1,
            "undulation": 0,
        }

    @pytest.mark.parametrize(
        ("name", "detail"),
        [
            ("raises", "RuntimeError: no luck"),
            ("leaves", "SystemExit: 3"),
            ("speaks_badly", "ValueError: bad \\udcff text"),
            ("beyond_floats", "OverflowError: int too large to convert to float"),
            ("infinite", "inf is not a finite number"),
            ("undefined", "nan is not a finite number"),
            ("text", "a number was expected, not str"),
            ("truth", "a number was expected, not bool"),
            ("writes", "ValueError: assignment destination is read-only"),
        ],
    )
    def test_what_goes_wrong_is_a_failure_with_the_criterions_name(self, name, detail):
        before = TENT.vertices.copy()
        path = f"plugin_criteria:{name}"
        assert score(TENT, HERE, ["size", path, "symmetry"]) == Failure("evaluation", f"{path}: {detail}")
        assert (TENT.vertices == before).all()
        assert TENT.vertices.flags.writeable

    def test_an_unknown_name_is_bad_input_not_a_failure(self):
        with pytest.raises(InputError, match="did you mean 'size'"):
            score(TENT, HERE, ["sise"])
