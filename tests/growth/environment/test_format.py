"""The environment format: what is read, what is refused and how, and what a digest tells apart."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from genome.errors import InputError
from growth.environment import Environment, EnvironmentSettings, environment_from, load_environment

WHOLE = """
gravity: [0, 0, -0.2]
attractors: [{at: [0, 0, 3], strength: 1.0, exponent: 2}]
repellers: []
boundaries:
  - {shape: sphere, at: [0, 0, -2], radius: 2, solid: inside}
  - {mesh: site.obj, solid: inside, soft: true}
"""


def _box(path: Path, **keys: Any) -> Path:
    import trimesh

    trimesh.creation.box(extents=(2, 2, 2)).export(path, **keys)
    return path


def _refusal(text: str, tmp_path: Path) -> str:
    path = tmp_path / "a.env.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        load_environment(path)
    return str(caught.value).replace(str(tmp_path) + "/", "")


def test_the_file_of_the_interface_page_is_read(tmp_path: Path) -> None:
    _box(tmp_path / "site.obj")
    (tmp_path / "a.env.yaml").write_text(WHOLE, encoding="utf-8")
    env = load_environment(tmp_path / "a.env.yaml")
    np.testing.assert_allclose(env.forces([[0, 0, 0]]), [[0, 0, 1 / 9 - 0.2]])
    np.testing.assert_array_equal(env.inside([[0, 0, -1], [0.5, 0.5, 0.5]]), [True, False])
    assert env.wrong_side([[0, 0, -0.5], [0.5, 0.5, 0.5], [0, 0, 2]]) == 2
    assert env.mesh_files == (("site.obj", tmp_path / "site.obj"),)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("gravty: [0, 0, 1]", "a.env.yaml:1: gravty: expected a known key, got 'gravty'; did you mean 'gravity'?"),
        ("[1, 2]", "a.env.yaml:1: expected keys and values, got [1, 2]"),
        ("gravity: [0, 0, .nan]", "a.env.yaml:1: gravity.2: expected a finite number, got nan"),
        ("gravity: [0, -.inf, 0]", "a.env.yaml:1: gravity.1: expected a finite number, got -inf"),
        ("gravity: [0, 0, no]", "a.env.yaml:1: gravity.2: expected a number, got 'no'"),
        ("gravity: [0, 0]", "a.env.yaml:1: gravity: expected a list of three numbers: [x, y, z], got [0, 0]"),
        (
            "attractors:\n  - at: [0, 0, 1]\n    strenght: 2",
            "a.env.yaml:3: attractors.0.strenght: expected a known key, got 'strenght'; did you mean 'strength'?",
        ),
        ("repellers: [{}]", "a.env.yaml:1: repellers.0.at: expected a value for 'at', got nothing; add the key"),
        (
            "repellers: [{at: [0, 0, 0], strength: -1}]",
            "a.env.yaml:1: repellers.0.strength: expected greater than or equal to 0, got -1",
        ),
        (
            "boundaries:\n  - {shape: sphere, at: [0, 0, 0], radus: 1}",
            "a.env.yaml:2: boundaries.0.radus: expected a known key, got 'radus'; did you mean 'radius'?",
        ),
        (
            "boundaries:\n  - {shape: sphere, at: [0, 0, 0]}",
            "a.env.yaml:2: boundaries.0.radius: expected a value for 'radius', got nothing; add the key",
        ),
        (
            "boundaries:\n  - {shape: sphere, at: [0, 0, 0], radius: 1, sold: inside}",
            "a.env.yaml:2: boundaries.0.sold: expected a known key, got 'sold'; did you mean 'solid'?",
        ),
        (
            "boundaries:\n  - shape: sphere\n    at: [0, 0, 0]\n    radius: 0",
            "a.env.yaml:4: boundaries.0.radius: expected greater than 0, got 0",
        ),
        (
            "boundaries: [{shape: spere, at: [0, 0, 0], radius: 1}]",
            "a.env.yaml:1: boundaries.0.shape: expected a shape, got 'spere'; did you mean 'sphere'?",
        ),
        (
            "boundaries: [{shap: sphere, at: [0, 0, 0]}]",
            "a.env.yaml:1: boundaries.0: expected a 'shape' or a 'mesh', got shap, at; did you mean 'shape'?",
        ),
        (
            "boundaries: [{shape: box, mesh: a.obj}]",
            "a.env.yaml:1: boundaries.0: expected either a 'shape' or a 'mesh', got both; make two boundaries of it",
        ),
        ("boundaries: [sphere]", "a.env.yaml:1: boundaries.0: expected keys and values, got 'sphere'"),
        (
            "boundaries: [{shape: plane, at: [0, 0, 0], normal: [0, 0, 0]}]",
            "a.env.yaml:1: boundaries.0.normal: expected a direction that is not zero, got [0, 0, 0]",
        ),
        (
            "boundaries: [{shape: box, at: [0, 0, 0], size: [1, 0, 1]}]",
            "a.env.yaml:1: boundaries.0.size.1: expected greater than 0, got 0",
        ),
        (
            "boundaries: [{shape: plane, at: [0, 0, 0], solid: in}]",
            "a.env.yaml:1: boundaries.0.solid: expected 'inside' or 'outside', got 'in'",
        ),
        (
            "boundaries: [{shape: plane, at: [0, 0, 0], soft: 1}]",
            "a.env.yaml:1: boundaries.0.soft: expected true or false, got 1",
        ),
        (
            "boundaries: {shape: plane}",
            "a.env.yaml:1: boundaries: expected a list, got {'shape': 'plane'}; write each entry after a '- '",
        ),
    ],
)
def test_a_refusal_says_where_and_what(text: str, message: str, tmp_path: Path) -> None:
    assert _refusal(text, tmp_path) == message


def test_an_open_mesh_is_refused_with_its_open_edges(tmp_path: Path) -> None:
    import trimesh

    box = trimesh.creation.box()
    box.faces = box.faces[:-1]
    box.export(tmp_path / "open.obj")
    assert _refusal("boundaries: [{mesh: open.obj}]", tmp_path) == (
        "a.env.yaml:1: open.obj: expected a closed mesh, got one with 3 open edges; "
        "close it in the program that made it (fill holes, merge vertices, make normals agree)"
    )


def test_a_mesh_whose_faces_disagree_is_refused(tmp_path: Path) -> None:
    import trimesh

    box = trimesh.creation.box()
    faces = box.faces.copy()
    faces[0] = faces[0][::-1]
    trimesh.Trimesh(box.vertices, faces, process=False).export(tmp_path / "bad.ply")
    message = _refusal("boundaries: [{mesh: bad.ply}]", tmp_path)
    assert message.startswith("a.env.yaml:1: bad.ply: expected faces that agree on a front, got 3 edges")


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("none.obj", None, "a mesh file, got no such file"),
        ("empty.obj", "", "a mesh file, got an empty file"),
        ("comment.obj", "# nothing\n", ""),
        ("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", ""),
        ("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\n", "a mesh with a volume, got a flat one"),
        ("folded.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 1 1\n", "a mesh with a volume, got faces without area"),
        ("nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n", "finite coordinates"),
        ("text.stl", "this is no mesh", "a mesh with faces, got an empty one"),
        ("text.glb", "this is no mesh", "a mesh file that trimesh loads"),
        ("form.xyzzy", "x", "a mesh file that trimesh loads, got the suffix '.xyzzy'; known: "),
        ("none", "x", "a mesh file that trimesh loads, got the suffix ''"),
    ],
)
def test_a_mesh_that_is_none_is_refused(name: str, content: str | None, message: str, tmp_path: Path) -> None:
    if content is not None:
        (tmp_path / name).write_text(content, encoding="utf-8")
    refusal = _refusal(f"boundaries: [{{mesh: {name}}}]", tmp_path)
    assert refusal.startswith(f"a.env.yaml:1: {name}: expected {message}")


def test_a_folder_is_no_mesh(tmp_path: Path) -> None:
    (tmp_path / "site.obj").mkdir()
    assert _refusal("boundaries: [{mesh: site.obj}]", tmp_path) == (
        "a.env.yaml:1: site.obj: expected a mesh file, got a folder"
    )


@pytest.mark.parametrize("suffix", ["obj", "stl", "ply", "glb"])
def test_a_mesh_is_the_same_body_in_every_format(suffix: str, tmp_path: Path) -> None:
    import trimesh

    body = trimesh.creation.box(extents=(1, 2, 4)).apply_translation([0.5, 1, 2])
    if suffix == "glb":  # which has y up: (x, y, z) is written as (x, z, -y)
        body.apply_transform([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
    body.export(tmp_path / f"site.{suffix}")
    env = environment_from({"boundaries": [{"mesh": f"site.{suffix}"}]}, "test", tmp_path)
    at = np.array([[0.9, 1.9, 3.9], [0.1, 0.1, 0.1], [0.5, 3.9, 1.9], [0.5, 1, -1.0], [1.1, 1, 1]])
    np.testing.assert_array_equal(env.inside(at), [True, True, False, False, False])


def test_a_mesh_is_scaled_then_turned_then_moved_and_inverted_ones_are_put_right(tmp_path: Path) -> None:
    import trimesh

    body = trimesh.creation.box(extents=(2, 4, 6))
    body.invert()
    body.export(tmp_path / "site.obj")
    placed = {"mesh": "site.obj", "scale": 0.5, "rotation": [0, 0, 90], "at": [10, 0, 0]}
    env = environment_from({"boundaries": [placed]}, "test", tmp_path)
    at = np.array([[10, 0, 0], [10.9, 0, 0], [10, 0.9, 0], [10, 0, 1.4], [11.1, 0, 0]])
    np.testing.assert_array_equal(env.inside(at), [True, True, False, True, False])
    np.testing.assert_allclose(env.move([[20, 0.1, 0.2]], [[10, 0.1, 0.2]]), [[11, 0.1, 0.2]], atol=1e-5)


def test_a_body_beside_another_is_put_right_too_and_a_cavity_stays_one(tmp_path: Path) -> None:
    import trimesh

    room, hole, shed = (trimesh.creation.box(extents=(side, side, side)) for side in (4, 2, 1))
    shed.apply_translation([5, 0, 0])
    for part in (hole, shed):
        part.invert()
    for inverted in (False, True):
        whole = trimesh.util.concatenate([room, hole, shed])
        if inverted:
            whole.invert()
        whole.export(tmp_path / "site.ply")
        env = environment_from({"boundaries": [{"mesh": "site.ply"}]}, "test", tmp_path)
        np.testing.assert_array_equal(env.inside([[1.5, 0, 0], [0.5, 0, 0], [5, 0.2, 0], [3, 0, 0]]), [1, 0, 1, 0])
        np.testing.assert_allclose(env.move([[9, 0.1, 0.2]], [[5, 0.1, 0.2]]), [[5.5, 0.1, 0.2]], atol=1e-4)


def _digest(base: Path = Path(), **keys: Any) -> str:
    return environment_from(keys, "test", base).digest


def test_a_digest_is_of_the_meaning() -> None:
    empty = _digest()
    assert empty == Environment.empty().digest == _digest(gravity=[0, 0, -0.0], attractors=[])
    ball = {"shape": "sphere", "at": [0, 0, 0], "radius": 1}
    same = {"radius": 1.0, "at": [0.0, 0, 0], "soft": False, "solid": "inside", "shape": "sphere"}
    assert _digest(boundaries=[ball]) == _digest(boundaries=[same])
    others = [
        _digest(boundaries=[ball, ball]),
        _digest(boundaries=[{**ball, "soft": True}]),
        _digest(boundaries=[{**ball, "solid": "outside"}]),
        _digest(boundaries=[{**ball, "radius": 1.0000000000000002}]),
        _digest(gravity=[0, 0, -1]),
        _digest(attractors=[{"at": [0, 0, 0]}]),
        _digest(repellers=[{"at": [0, 0, 0]}]),
        _digest(boundaries=[ball]),
        empty,
    ]
    assert len(set(others)) == len(others)


def test_a_mesh_counts_by_its_contents_wherever_it_lies(tmp_path: Path) -> None:
    import trimesh

    (tmp_path / "deep").mkdir()
    _box(tmp_path / "a.ply")
    _box(tmp_path / "deep" / "b.ply")
    trimesh.creation.box(extents=(2, 2, 3)).export(tmp_path / "c.ply")
    one = _digest(tmp_path, boundaries=[{"mesh": "a.ply"}])
    assert one == _digest(tmp_path, boundaries=[{"mesh": "deep/b.ply"}])
    assert one == _digest(tmp_path / "deep", boundaries=[{"mesh": "../a.ply"}])
    assert one != _digest(tmp_path, boundaries=[{"mesh": "c.ply"}])
    assert one != _digest(tmp_path, boundaries=[{"mesh": "a.ply", "scale": 2}])


def test_settings_as_resolved_make_the_same_environment_and_notice_another_mesh(tmp_path: Path) -> None:
    import trimesh

    _box(tmp_path / "site.obj")
    first = environment_from(
        {"attractors": [{"at": [1, 2, 3]}], "boundaries": [{"mesh": "site.obj"}, {"shape": "plane", "at": [0, 0, -3]}]},
        "test",
        tmp_path,
    )
    written = json.loads(json.dumps(first.settings))
    assert written["attractors"] == [{"at": [1.0, 2.0, 3.0], "strength": 1.0, "exponent": 2.0}]
    assert written["boundaries"][0]["mesh"] == "site.obj"
    second = environment_from(written, "experiment.yaml", tmp_path)
    assert second.digest == first.digest
    assert second.settings == first.settings
    trimesh.creation.box(extents=(2, 2, 3)).export(tmp_path / "site.obj")
    with pytest.raises(InputError, match=r"experiment\.yaml: expected the mesh .* as it was .*; restore the file"):
        environment_from(written, "experiment.yaml", tmp_path)


def test_the_models_give_a_json_schema_and_read_boundaries_by_themselves() -> None:
    schema = json.dumps(EnvironmentSettings.model_json_schema())
    for key in ("gravity", "attractors", "radius", "normal", "axis", "mesh", "rotation"):
        assert f'"{key}"' in schema
    read = EnvironmentSettings.model_validate({"boundaries": [{"shape": "plane", "at": [0, 0, 0]}, {"mesh": "a.obj"}]})
    assert [type(item).__name__ for item in read.boundaries] == ["PlaneSettings", "MeshSettings"]
