"""Animations: parts that live on, files that other programs take, and places between two drawings."""

from __future__ import annotations

import json
import shutil
import struct
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation, Slerp

from genome.errors import InputError
from genome.timed import parse_tl
from growth.timed import begin
from growth.timed.animation import animated_glb, contact_sheet, gif, segments, write_drawings
from growth.timed.animation.gltf import Buffer
from growth.timed.animation.places import places_of
from growth.timed.drawing import Drawing, Shape
from growth.timed.turtle import draw

SYSTEMS = Path(__file__).resolve().parents[3] / "experiments" / "systems"
WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}
TYPES = {5126: "<f4", 5125: "<u4", 5123: "<u2"}


def drawn(text: str, times: list[float]) -> list[Drawing]:
    derivation = begin(parse_tl(text, "test"), 0)
    found = []
    for time in times:
        assert not hasattr(derivation, "reason"), derivation
        derivation = derivation.at(time)  # type: ignore[union-attr]
        drawing = draw(derivation.word())  # type: ignore[union-attr,arg-type]
        assert isinstance(drawing, Drawing)
        found.append(drawing)
    return found


def shipped(name: str, times: list[float]) -> list[Drawing]:
    return drawn((SYSTEMS / f"{name}.tl").read_text(encoding="utf-8"), times)


class File:
    """A GLB file, read by hand."""

    def __init__(self, content: bytes) -> None:
        magic, version, length = struct.unpack_from("<III", content)
        assert (magic, version, length) == (0x46546C67, 2, len(content))
        size, kind = struct.unpack_from("<II", content, 12)
        assert (size % 4, kind) == (0, 0x4E4F534A)
        self.json: dict[str, Any] = json.loads(content[20 : 20 + size])
        rest, kind = struct.unpack_from("<II", content, 20 + size)
        assert (rest % 4, kind) == (0, 0x004E4942)
        self.binary = content[28 + size :]
        assert len(self.binary) == rest == self.json["buffers"][0]["byteLength"]

    def values(self, number: int) -> np.ndarray:
        accessor = self.json["accessors"][number]
        view = self.json["bufferViews"][accessor["bufferView"]]
        width = WIDTHS[accessor["type"]]
        found = np.frombuffer(
            self.binary, TYPES[accessor["componentType"]], accessor["count"] * width, view["byteOffset"]
        ).reshape(-1, width)
        assert found.nbytes == view["byteLength"]
        if "min" in accessor:
            assert found.min(axis=0).tolist() == accessor["min"]
            assert found.max(axis=0).tolist() == accessor["max"]
        return found

    def channels(self) -> dict[tuple[int, str], tuple[np.ndarray, np.ndarray, str]]:
        (animation,) = self.json.get("animations", [{"channels": [], "samplers": []}])
        found = {}
        for channel in animation["channels"]:
            sampler = animation["samplers"][channel["sampler"]]
            times = self.values(sampler["input"])[:, 0]
            assert (np.diff(times) > 0).all()
            key = (channel["target"]["node"], channel["target"]["path"])
            assert key not in found
            found[key] = (times, self.values(sampler["output"]), sampler["interpolation"])
        return found

    def at(self, time: float | None) -> list[np.ndarray]:
        """Give the triangles (t, 3, 3) of each mesh that is shown at a time, z up, as a player would.

        Without a time as programs do that play no animation, and know no morph targets.
        """
        channels, found = self.channels(), []

        def value(node: int, path: str, rest: list[float]) -> np.ndarray:
            if time is None or (node, path) not in channels:
                return np.array(rest)
            times, values, way = channels[node, path]
            values = values.reshape(len(times), -1)
            if way == "STEP":
                return values[max(int(np.searchsorted(times, time, side="right")) - 1, 0)]
            inside = float(np.clip(time, times[0], times[-1]))
            if path == "rotation":
                return Slerp(times, Rotation.from_quat(values))(inside).as_quat()
            return np.array([np.interp(inside, times, column) for column in values.T])

        def walk(node: int, above: np.ndarray) -> None:
            told = self.json["nodes"][node]
            local = np.eye(4)
            turn = Rotation.from_quat(value(node, "rotation", told.get("rotation", [0, 0, 0, 1]))).as_matrix()
            local[:3, :3] = turn * value(node, "scale", told.get("scale", [1, 1, 1]))
            local[:3, 3] = value(node, "translation", told.get("translation", [0, 0, 0]))
            whole = above @ local
            if "mesh" in told and abs(np.linalg.det(whole[:3, :3])) > 1e-30:
                (primitive,) = self.json["meshes"][told["mesh"]]["primitives"]
                vertices = self.values(primitive["attributes"]["POSITION"]).astype(float)
                targets = primitive.get("targets", [])
                for weight, target in zip(value(node, "weights", [0.0] * len(targets)), targets, strict=True):
                    vertices = vertices + weight * self.values(target["POSITION"])
                placed = vertices @ whole[:3, :3].T + whole[:3, 3]
                up = np.stack([placed[:, 0], -placed[:, 2], placed[:, 1]], axis=1)
                found.append(up[self.values(primitive["indices"])[:, 0]].reshape(-1, 3, 3))
            for child in told.get("children", []):
                walk(child, whole)

        walk(0, np.eye(4))
        return found


def triangles(drawing: Drawing) -> list[np.ndarray]:
    shapes = [drawing.shapes[which] for which in drawing.which.tolist()]
    parts = [drawing.corners(part)[shape.triangles] for part, shape in enumerate(shapes)]
    flat = [abs(np.linalg.det(frame[:3, :3])) <= 1e-30 for frame in drawing.frames]
    return [part for part, gone in zip(parts, flat, strict=True) if not gone]


def furthest(found: list[np.ndarray], wanted: list[np.ndarray]) -> float:
    """Give how far a corner is from its place: of parts by their triangles, in any order; infinite for other parts."""
    key = lambda part: (len(part), *np.round(part.mean(axis=(0, 1)), 3).tolist())  # noqa: E731
    if [len(part) for part in sorted(found, key=key)] != [len(part) for part in sorted(wanted, key=key)]:
        return float("inf")
    pairs = zip(sorted(found, key=key), sorted(wanted, key=key), strict=True)
    return max((float(np.abs(one - other).max()) for one, other in pairs), default=0.0)


@pytest.mark.parametrize(
    ("name", "times"),
    [
        ("piston", [0.04 + 0.1 * step for step in range(12)]),
        ("gait", [2.0, 2.3, 2.6, 2.9]),
        ("flower", [8.0, 11.5, 13.0, 16.0]),
    ],
)
def test_at_each_time_the_file_holds_what_was_drawn(name: str, times: list[float]) -> None:
    drawings = shipped(name, times)
    file = File(animated_glb(drawings))
    size = float(np.abs(drawings[-1].surface().vertices).max())
    for drawing in drawings:
        shown = file.at(float(np.float32(drawing.time - times[0])))
        assert furthest(shown, triangles(drawing)) <= 4e-6 * size
    assert furthest(file.at(None), triangles(drawings[-1])) <= 4e-6 * size


def test_between_two_times_the_piston_is_where_it_should_be() -> None:
    step = 0.04
    times = [0.04 + step * number for number in range(26)]
    file = File(animated_glb(shipped("piston", times)))
    between = [time + step / 2 for time in times[:-1]]
    for time, drawing in zip(between, shipped("piston", between), strict=True):
        # The wheel's radius is 50: between two times 0.04 apart nothing is further than this from its place.
        assert furthest(file.at(time - times[0]), triangles(drawing)) <= 0.06


def test_what_only_moves_is_one_node_and_what_is_alike_one_mesh() -> None:
    drawings = shipped("piston", [0.04, 0.5, 1.0])
    file = File(animated_glb(drawings))
    assert len(file.json["nodes"]) == 1 + 3
    assert not any("targets" in mesh["primitives"][0] for mesh in file.json["meshes"])
    assert {path for _, path in file.channels()} <= {"translation", "rotation"}
    bush = drawn("axiom F(1)\nF(l) -> F(l) [ +(25.7) F(l) ] F(l) [ -(25.7) F(l) ] F(l)", [3.0])
    assert len(bush[0]) == 125
    alone = File(animated_glb(bush))
    assert (len(alone.json["meshes"]), len(alone.json["nodes"])) == (1, 126)
    assert "animations" not in alone.json


def test_parts_are_hidden_before_their_birth_and_after_their_death() -> None:
    text = "axiom A(1)\nA(l) @ 1.5 -> sphere(l)\nequiv F A"
    drawings = drawn(text, [0.5, 1.0, 2.0, 3.0])
    lives = segments(drawings)
    assert [(life.name, life.first, life.last) for life in lives] == [("cylinder", 0, 1), ("sphere", 2, 3)]
    file = File(animated_glb(drawings))
    assert [len(file.at(time)) for time in (0.0, 0.5, 1.4, 1.5, 2.5)] == [1, 1, 1, 1, 1]
    counts = [len(file.at(time)[0]) for time in (0.0, 1.4, 1.5)]
    assert counts[0] == counts[1] != counts[2]


def test_a_part_that_changes_its_colour_or_its_triangles_is_another_segment() -> None:
    cube = trimesh.creation.box()
    shape = Shape("surface", np.array(cube.vertices), np.array(cube.faces, dtype=np.int32), closed=True)
    less = Shape("surface", shape.vertices, shape.triangles[:-1], closed=False)
    moved = Shape("surface", shape.vertices * [1.0, 1.0, 2.0], shape.triangles, closed=True)

    def one(time: float, at: Shape, red: float) -> Drawing:
        ids = np.array([7])
        return Drawing(
            time, (at,), np.array([0]), np.eye(4)[None], np.array([[red, 0.0, 0.0]]), ids, np.zeros((0, 3)), ids[:0]
        )

    parts = [(shape, 0.1), (moved, 0.1), (moved, 0.1), (moved, 0.2), (less, 0.2)]
    drawings = [one(float(place), *part) for place, part in enumerate(parts)]
    lives = segments(drawings)
    assert [(life.first, life.last, len(life.shapes)) for life in lives] == [(0, 2, 3), (3, 3, 1), (4, 4, 1)]
    file = File(animated_glb(drawings))
    assert [len(mesh["primitives"][0].get("targets", [])) for mesh in file.json["meshes"]] == [1, 0, 0]
    for drawing in drawings:
        assert furthest(file.at(drawing.time), triangles(drawing)) <= 1e-6
    assert np.ptp(np.concatenate(file.at(0.5)).reshape(-1, 3), axis=0) == pytest.approx([1.0, 1.0, 1.5])


@given(st.integers(0, 2**32 - 1), st.integers(1, 6))
def test_places_put_frames_together_again_and_rotations_take_the_shorter_way(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    frames = np.tile(np.eye(4), (count, 1, 1))
    scales = rng.uniform(0.0, 3.0, (count, 3)) * (rng.random((count, 3)) > 0.3)
    frames[:, :3, :3] = Rotation.random(count, random_state=seed % 2**32).as_matrix() * scales[:, None, :]
    frames[:, :3, 3] = rng.normal(size=(count, 3))
    places = places_of(frames)
    again = Rotation.from_quat(places.rotations).as_matrix() * places.scales[:, None, :]
    assert np.abs(again - frames[:, :3, :3]).max() < 1e-12
    assert (places.translations == frames[:, :3, 3]).all()
    assert np.linalg.norm(places.rotations, axis=1) == pytest.approx(1.0)
    assert (np.einsum("ij,ij->i", places.rotations[1:], places.rotations[:-1]) >= 0.0).all()


def test_files_are_the_same_each_time_and_trimesh_reads_them(tmp_path: Path) -> None:
    drawings = shipped("gait", [2.0, 2.5])
    content = animated_glb(drawings, {"title": "gait"})
    assert content == animated_glb(shipped("gait", [2.0, 2.5]), {"title": "gait"})
    (tmp_path / "gait.glb").write_bytes(content)
    scene = trimesh.load_scene(tmp_path / "gait.glb")
    low, high = scene.bounds
    vertices = drawings[-1].surface().vertices
    turned = np.stack([vertices[:, 0], vertices[:, 2], -vertices[:, 1]], axis=1)
    assert np.allclose([low, high], [turned.min(axis=0), turned.max(axis=0)], atol=1e-5)


@pytest.mark.skipif(shutil.which("node") is None, reason="there is no node on this machine")
def test_the_khronos_validator_has_nothing_to_say(tmp_path: Path) -> None:
    paths = []
    for name, times in (("piston", [0.04, 1.0, 2.0]), ("flower", [6.0, 10.0, 14.0]), ("gait", [2.0, 2.4])):
        paths.append(tmp_path / f"{name}.glb")
        paths[-1].write_bytes(animated_glb(shipped(name, times), {"title": name}))
    script = """
        const validator = require("gltf-validator"), fs = require("fs");
        Promise.all(process.argv.slice(1).map(path => validator.validateBytes(new Uint8Array(fs.readFileSync(path)))))
            .then(all => console.log(JSON.stringify(all.map(one => one.issues))));
    """
    told = subprocess.run(["node", "-e", script, *map(str, paths)], capture_output=True, text=True, check=False)
    if "Cannot find module" in told.stderr:
        pytest.skip("gltf-validator is not installed (npm install -g gltf-validator, and NODE_PATH)")
    for issues in json.loads(told.stdout):
        assert (issues["numErrors"], issues["numWarnings"], issues["numInfos"]) == (0, 0, 0), issues


def test_pictures_have_the_shape_of_what_they_show_and_a_gif_goes_round() -> None:
    from io import BytesIO

    from PIL import Image

    small = (64, 48)
    drawings = drawn("axiom F(1)\ng F(l, age) = 1 + age", [0.0, 0.5])
    image = Image.open(BytesIO(gif(drawings, small)))
    assert (image.n_frames, image.info["loop"], image.info["duration"]) == (2, 0, 500)
    # A column is tall: three by four. What is long is two by one at the most. Both have as many pixels.
    assert image.size == (48, 64)
    assert contact_sheet(drawings, "one", small).size == (2 * 48, 34 + 64 + 20)
    assert contact_sheet(drawn("axiom &(90) F(9)", [0.0]), "long", small).size == (79, 34 + 39 + 20)


def test_an_animation_can_begin_with_nothing() -> None:
    from io import BytesIO

    from PIL import Image

    empty = drawn("axiom A\nA @ 1 -> F(1)", [0.0, 2.0])
    assert Image.open(BytesIO(gif(empty, (16, 12)))).n_frames == 2


def test_several_files_are_written_together_or_not_at_all(tmp_path: Path) -> None:
    drawings = drawn("axiom F(1)\ng F(l, age) = 1 + age", [0.0, 1.0])
    assert write_drawings(drawings, tmp_path / "a.stl", "a.tl") == [str(tmp_path / f"a-000{at}.stl") for at in (0, 1)]
    heights = [trimesh.load_mesh(tmp_path / f"a-000{at}.stl").extents[2] for at in (0, 1)]
    assert heights == pytest.approx([1.0, 2.0])
    (tmp_path / "b-0001.stl").mkdir()
    with pytest.raises(InputError, match=r"b-0001\.stl: expected a file that can be written"):
        write_drawings(drawings, tmp_path / "b.stl", "a.tl")
    nothing = drawn("axiom A", [0.0])
    with pytest.raises(InputError, match="expected a form with parts, got none"):
        write_drawings(nothing, tmp_path / "c.glb", "c.tl")
    with pytest.raises(InputError, match="a form with parts at each time, got none at time 0; begin later"):
        write_drawings([*nothing, *drawings], tmp_path / "c.obj", "c.tl")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a-0000.stl", "a-0001.stl", "b-0001.stl"]


def matched(found: list[np.ndarray], wanted: list[np.ndarray], within: float) -> None:
    """Compare sets of parts, each with its own among those that are left."""
    left = list(found)
    for part in wanted:
        near = [at for at, one in enumerate(left) if one.shape == part.shape and np.abs(one - part).max() <= within]
        assert near, "a part is shown nowhere near its place"
        left.pop(near[0])
    assert not left


PIECES = ("F(1)", "f(0.5)", "sphere(0.4)", "disc(0.2, 0.6)", "+(40)", "&(70)", "/(100)", "leaf(1) ~(1)", "!(0.3)",
          "cC(1, 0) ^(30) cC(1, 1)", "[ F(0.5) ]", "{ f(1) +(90) f(1) +(90) f(1) }", "colour(1, 0, 0)",
          "late")  # fmt: skip
GROWN = """surface leaf(u, v) = u, v - 0.3, 0.2*u*u
late @ 0.75 -> sphere(0.7)
g F(l, age) = 1 - age
g cC(l, c, age) = 1 + age
g ~(s, age) = 1 - age
g sphere(r, age) = 1.2 - age
g +(a, age) = age
"""


@settings(max_examples=25)
@given(st.lists(st.sampled_from(PIECES), min_size=1, max_size=8))
def test_whatever_is_drawn_is_in_the_file_at_its_time_grown_through_nothing_too(pieces: list[str]) -> None:
    # What grows goes through nothing at 1, and is turned inside out after it, where it can be.
    drawings = drawn(f"axiom F(1) {' '.join(pieces)}\n{GROWN}", [0.0, 0.5, 1.0, 1.5])
    file = File(animated_glb(drawings))
    for accessor in (*inputs(file), *positions(file)):
        assert {"min", "max"} <= set(file.json["accessors"][accessor])
    for drawing in drawings:
        matched(file.at(drawing.time), triangles(drawing), 1e-5)


def inputs(file: File) -> list[int]:
    return [one["input"] for animation in file.json.get("animations", []) for one in animation["samplers"]]


def positions(file: File) -> list[int]:
    parts = [mesh["primitives"][0] for mesh in file.json["meshes"]]
    told = [part["attributes"] for part in parts] + [target for part in parts for target in part.get("targets", [])]
    return [one["POSITION"] for one in told]


def test_numbers_that_are_kept_once_still_have_the_bounds_that_one_use_of_them_wants() -> None:
    buffer = Buffer()
    weights = buffer.floats(np.array([0.0, 1.0]))
    times = buffer.floats(np.array([0.0, 1.0]), bounded=True)
    assert times == buffer.floats(np.array([0.0, 1.0]), bounded=True)
    assert (buffer.accessors[times]["min"], buffer.accessors[times]["max"]) == ([0.0], [1.0])
    assert "min" not in buffer.accessors[weights]


def test_a_mirrored_surface_passes_through_nothing_and_does_not_turn() -> None:
    text = "surface leaf(u, v) = u, v - 0.3, 0.2*u*u\naxiom f(1) +(20) leaf(1) ~(1)\ng ~(s, age) = 1 - age"
    drawings = drawn(text, [0.0, 0.5, 1.5, 2.0])
    places = places_of(np.concatenate([drawing.frames for drawing in drawings]))
    assert places.scales[:, 0] == pytest.approx([1.0, 0.5, -0.5, -1.0])
    assert np.ptp(places.rotations, axis=0) == pytest.approx(0.0, abs=1e-12)
    (shown,) = File(animated_glb(drawings)).at(0.75)
    assert shown.reshape(-1, 3) == pytest.approx(drawn(text, [0.75])[0].surface().vertices[
        drawings[0].shapes[0].triangles.reshape(-1)], abs=1e-6)  # fmt: skip


def test_what_is_small_moves_as_well() -> None:
    file = File(animated_glb(drawn("axiom !(1e-9) F(1e-8)\ng F(l, age) = 1 + age", [0.0, 1.0])))
    (shown,) = file.at(1.0)
    assert np.ptp(shown[..., 2]) == pytest.approx(2e-8, rel=1e-5)


@pytest.mark.parametrize("section", ["square", "star", "triangle", "lobes"])
@pytest.mark.parametrize("suffix", [".stl", ".ply", ".obj"])
def test_carriers_with_shoulders_are_watertight_when_they_are_read_again(
    tmp_path: Path, section: str, suffix: str
) -> None:
    lobes = "section lobes(a) = 1 + 0.2*cos(5*a)\n"
    for word in (f"!(0.3) cC(1, 0) {section} cC(0, 0) cC(1, 1)", f"!(0.3) cC(1, 0) {section} cC(0, 1)"):
        path = tmp_path / f"shoulder{suffix}"
        write_drawings(drawn(f"{lobes}axiom {word}", [0.0]), path, "shoulder.tl")
        body = trimesh.load_mesh(path)
        assert body.is_watertight, word
        assert body.is_winding_consistent
        assert body.volume > 0.1
