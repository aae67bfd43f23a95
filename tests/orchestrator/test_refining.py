"""``atoll refine``."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import trimesh
from click.testing import CliRunner

from genome.errors import InputError
from growth.refining import lab
from orchestrator.cli import main

SQUARE = Path(__file__).resolve().parents[2] / "experiments" / "systems" / "square.hemls"

try:
    lab.load()
    USABLE, WHY = True, ""
except InputError as error:  # a bare machine
    USABLE, WHY = False, str(error)


def atoll(*arguments: object):
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


@pytest.fixture
def form(tmp_path: Path) -> Path:
    path = tmp_path / "square.glb"
    assert atoll("grow", SQUARE, "--steps", 2, "--set", "start_length=4", "-o", path).exit_code == 0
    return path


@pytest.mark.skipif(not USABLE, reason=WHY)
@pytest.mark.parametrize("suffix", [".glb", ".obj", ".ply", ".stl"])
def test_a_grown_surface_becomes_a_solid_in_every_format(form: Path, suffix: str) -> None:
    solid = form.with_name(f"solid{suffix}")
    result = atoll("refine", form, "--recipe", "clean, remesh, smooth, solid", "-o", solid, "--json")
    told = json.loads(result.stdout.splitlines()[-1])
    assert told["file"] == str(solid)
    assert told["recipe"] == ["clean", "remesh", "smooth", "solid"]
    assert (told["watertight"], told["open_edges"], told["crossings"]) == (True, 0, 0)
    reopened = trimesh.load(solid, force="mesh")
    assert reopened.is_watertight
    assert reopened.volume == pytest.approx(told["volume"], rel=1e-4)
    # Flat forms lie in the plane of the ground: a GLB is turned when it is read, and turned back when it is written.
    thin = 1 if suffix == ".glb" else 2
    assert reopened.extents.argmin() == thin


@pytest.mark.skipif(not USABLE, reason=WHY)
def test_without_a_name_the_refined_form_stands_beside_the_form(form: Path) -> None:
    assert atoll("refine", form, "--set", "length=0.5", "--recipe", "remesh").exit_code == 0
    assert sorted(path.name for path in form.parent.iterdir()) == ["square-refined.glb", "square.glb"]


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("--recipe", "polish"), "--recipe: expected steps: clean, remesh, smooth, solid, got 'polish'"),
        (("--set", "thickness=-1"), "--set: thickness: expected"),
        (("--set", "thick=1"), "did you mean 'thickness'"),
        (("-o", "form.gltf"), "-o: expected a file that ends in .glb, .obj, .ply, .stl"),
        (("-o", "nowhere/form.stl"), "-o: expected a file in a folder that exists"),
    ],
)
def test_what_is_not_right_is_said_and_nothing_is_written(form: Path, arguments: tuple[str, ...], told: str) -> None:
    result = atoll("refine", form, *arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    assert told in result.stderr
    assert len(result.stderr.strip().splitlines()) == 1
    assert [path.name for path in form.parent.iterdir()] == ["square.glb"]


def test_files_that_are_no_forms_are_refused(tmp_path: Path) -> None:
    text, empty, points = tmp_path / "text.stl", tmp_path / "empty.glb", tmp_path / "points.obj"
    text.write_text("nothing to see")
    empty.write_bytes(b"")
    points.write_text("v 0 0 0\nv 1 0 0\n")
    for path, told in (
        (text, "expected a mesh with faces, got none"),
        (empty, "got an empty file"),
        (points, "a mesh"),
        (tmp_path / "gone.ply", "got no such file; check the path"),
    ):
        result = atoll("refine", path)
        assert (result.exit_code, result.stdout) == (2, ""), result.output
        assert told in result.stderr
        assert len(result.stderr.strip().splitlines()) == 1
