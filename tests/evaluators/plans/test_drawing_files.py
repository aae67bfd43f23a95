"""Files of plans, opened by their own libraries: their figures are the plan's."""

from __future__ import annotations

import io
import math
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import ezdxf
import ifcopenshell
import ifcopenshell.geom
import ifcopenshell.validate
import numpy as np
import pytest
import shapely
import trimesh
from drawn_houses import PLANE, SIZES, house
from ifcopenshell.util.element import get_container, get_psets
from ifcopenshell.util.unit import calculate_unit_scale
from PIL import Image

from evaluators.plans import Brief, Layout, laid_out
from evaluators.plans.drawings import Drawing, drawing
from evaluators.plans.drawings.files import OF_CUBES, WRITERS, write_plan
from evaluators.plans.drawings.marks import TINTS
from evaluators.plans.drawings.pictures import cubes_png
from evaluators.plans.drawings.poche import poche
from evaluators.plans.drawings.sheet import sheet, sheet_png, sheet_svg
from evaluators.plans.drawings.solids import HEIGHT
from genome.errors import InputError
from growth.polyforms import SQUARE, Plan

UNIT = 1.2
CASES = [(tiling, seed) for tiling in PLANE for seed in ((0, 3) if tiling == "square" else (3,))]
HOUSES = pytest.mark.parametrize(("tiling", "seed"), CASES)
SITE = {"outline": [[-30, -30], [40, -30], [40, 40], [-30, 40]], "street": "south", "view": "east"}
SVG = "{http://www.w3.org/2000/svg}"


def written(tiling: str, seed: int, suffix: str) -> tuple[Layout, Drawing, bytes]:
    layout = house(tiling, seed, unit=UNIT, site=SITE)
    return layout, drawing(layout, "A <house> & more"), WRITERS[suffix](layout, "A <house> & more", {"run": "x"})


def validated(content: bytes, *, express_rules: bool = False) -> Any:
    model = ifcopenshell.file.from_string(content.decode())
    logger: Any = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(model, logger, express_rules=express_rules)
    assert logger.statements == []
    return model


def lengths(layout: Layout) -> float:
    return UNIT * float(layout.outer.sum() + layout.shared.sum() / 2)


def areas(layout: Layout) -> list[float]:
    return [size * layout.plan.tiling.area * UNIT**2 for size in SIZES.values()]


@HOUSES
def test_svg_has_rooms_doors_and_words_in_millimetres(tiling: str, seed: int) -> None:
    layout, found, content = written(tiling, seed, "svg")
    root = ET.fromstring(content)
    by_kind: dict[str, list[Any]] = {}
    for element in root.iter():
        by_kind.setdefault(element.get("class", ""), []).append(element)
    assert len(by_kind["door"]) == len(layout.doors) + 1 == len(found.doors)
    assert len(by_kind["window"]) == len(found.windows)
    assert [one.findtext(f"{SVG}title") for one in by_kind["room"]] == list(SIZES)
    note = next(one.text for one in by_kind["note"] if "scale" in (one.text or ""))
    metres = int(note.rpartition("1:")[2]) / 1000
    for element, area in zip(by_kind["room"], areas(layout), strict=True):
        points = [tuple(map(float, one.split(","))) for one in element.get("d")[1:-2].split(" L")]
        assert shapely.Polygon(points).area * metres**2 == pytest.approx(area, abs=0.01)
    assert [one.text for one in by_kind["area"]] == [f"{area:.1f} m²" for area in areas(layout)]
    assert {"Master bedroom", "Living"} <= {one.text for one in by_kind["name"]}
    assert {"STREET", "VIEW"} == {one.text for one in by_kind["side"]}
    assert len(by_kind["figure"]) == len(found.dimensions)
    assert len(by_kind["site"]) == 1
    assert root.findtext(f"{SVG}title") == "A <house> & more"
    assert b"href" not in content
    assert root.get("width") == f"{float(root.get('viewBox', '').split()[2]):.2f}mm"


@HOUSES
def test_dxf_passes_its_audit_and_has_the_plans_figures(tiling: str, seed: int, tmp_path: Path) -> None:
    layout, found, content = written(tiling, seed, "dxf")
    path = tmp_path / "plan.dxf"
    path.write_bytes(content)
    document = ezdxf.readfile(path)  # type: ignore[attr-defined]
    audit = document.audit()
    assert (audit.errors, audit.fixes) == ([], [])
    assert document.header["$INSUNITS"] == 6
    space = document.modelspace()
    assert {one.dxf.layer for one in space} == {"WALLS", "DOORS", "WINDOWS", "ROOMS", "DIMENSIONS", "SITE"}
    rooms = [shapely.Polygon(one.get_points("xy")) for one in space.query("LWPOLYLINE[layer=='ROOMS']")]
    assert [one.area for one in rooms] == pytest.approx(areas(layout))
    texts = [one.dxf.text for one in space.query("TEXT[layer=='ROOMS']")]
    assert texts[1::2] == [f"{area:.1f} m²" for area in areas(layout)]
    assert texts[::2] == [name.replace("_", " ").capitalize() for name in SIZES]
    arcs = space.query("ARC[layer=='DOORS']")
    assert len(arcs) == len(found.doors)
    for arc, door in zip(arcs, found.doors, strict=True):
        leaf = found.leaf(door)
        ends = sorted(math.dist(arc.start_point.vec2, point) for point in (leaf.tip, leaf.jamb))
        assert ends[0] == pytest.approx(0.0, abs=1e-9)
        assert (arc.dxf.end_angle - arc.dxf.start_angle) % 360 == pytest.approx(90)
    assert len(space.query("LWPOLYLINE[layer=='WINDOWS']")) == len(found.windows)
    measured = [one.get_measurement() for one in space.query("DIMENSION")]
    assert measured == pytest.approx([one.length for one in found.dimensions])


@HOUSES
def test_ifc_is_valid_and_has_the_plans_figures(tiling: str, seed: int) -> None:
    layout, found, content = written(tiling, seed, "ifc")
    model = validated(content)
    assert model.schema == "IFC4"
    assert calculate_unit_scale(model) == 1.0
    spaces = model.by_type("IfcSpace")
    figures = [get_psets(one)["Qto_SpaceBaseQuantities"] for one in spaces]
    assert [one.Name for one in spaces] == list(SIZES)
    assert [one["GrossFloorArea"] for one in figures] == pytest.approx(areas(layout))
    walls = model.by_type("IfcWall")
    assert sum(get_psets(one)["Qto_WallBaseQuantities"]["Length"] for one in walls) == pytest.approx(lengths(layout))
    assert {get_psets(one)["Pset_WallCommon"]["IsExternal"] for one in walls} == {True, False}
    assert len(model.by_type("IfcDoor")) == len(layout.doors) + 1
    assert len(model.by_type("IfcWindow")) == len(found.windows)
    assert len(model.by_type("IfcOpeningElement")) == len(found.openings)
    for name in ("IfcSite", "IfcBuilding", "IfcBuildingStorey", "IfcSlab"):
        assert len(model.by_type(name)) == 1
    storey = model.by_type("IfcBuildingStorey")[0]
    assert {get_container(one) for one in (*walls, *model.by_type("IfcDoor"), *model.by_type("IfcSlab"))} == {storey}


@pytest.mark.filterwarnings("ignore:unclosed file:ResourceWarning")  # its rules, which ifcopenshell leaves open
def test_ifc_obeys_the_rules_of_its_schema() -> None:
    rooms = np.array([[0, 0, 0], [0, 1, 0], [1, 0, 0]])
    brief = {
        "rooms": {"a": {"cells": 2}, "b": {"cells": 1}},
        "adjacencies": [["a", "b"]],
        "entrance": "a",
        "site": SITE,
    }
    layout = laid_out(Plan(SQUARE, rooms, np.array([0, 0, 1])), Brief.model_validate(brief))
    content = WRITERS["ifc"](layout, "two rooms", {})
    assert len(validated(content, express_rules=True).by_type("IfcDoor")) == 2


def test_ifc_bodies_lie_where_the_drawing_has_them() -> None:
    _, found, content = written("square", 0, "ifc")
    model = ifcopenshell.file.from_string(content.decode())
    settings: Any = ifcopenshell.geom.settings()
    settings.set("use-world-coords", True)  # noqa: FBT003 - ifcopenshell's
    openings = sorted(found.openings, key=lambda one: (one.wall, one.start))
    made = sorted([*model.by_type("IfcDoor"), *model.by_type("IfcWindow")], key=lambda one: one.id())
    for entity, one in zip(made, openings, strict=True):
        wall = found.walls[one.wall]
        points = _points(settings, entity)
        middle = wall.at(one.start + one.width / 2)
        assert np.hypot(*(points.mean(axis=0)[:2] - middle)) < wall.thickness
        assert entity.is_a("IfcDoor") == (one.kind == "door")
        assert entity.OverallWidth == pytest.approx(one.width)
    for entity, wall in zip(model.by_type("IfcWall"), found.walls, strict=True):
        points = _points(settings, entity)
        assert points.min(axis=0) == pytest.approx([*np.min(wall.body, axis=0), 0.0], abs=1e-6)
        assert points.max(axis=0) == pytest.approx([*np.max(wall.body, axis=0), HEIGHT], abs=1e-6)


def _points(settings: Any, entity: Any) -> np.ndarray:
    shape: Any = ifcopenshell.geom.create_shape(settings, entity)
    return np.array(shape.geometry.verts).reshape(-1, 3)


@HOUSES
def test_glb_has_closed_walls_with_openings_and_floors_by_room(tiling: str, seed: int) -> None:
    _, found, content = written(tiling, seed, "glb")
    scene: Any = trimesh.load(io.BytesIO(content), file_type="glb")
    assert list(scene.geometry) == ["walls", "slab", *SIZES]
    for mesh in scene.geometry.values():
        assert mesh.is_watertight
        assert mesh.is_winding_consistent
    walls = sum(shapely.Polygon(wall.body).area for wall in found.walls) * HEIGHT
    holes = sum(one.width * found.walls[one.wall].thickness * (2.1 if one.kind == "door" else 1.2)
                for one in found.openings)  # fmt: skip
    assert scene.geometry["walls"].volume == pytest.approx(walls - holes, rel=1e-4)
    low, high = scene.geometry["walls"].bounds
    xs, ys = zip(*found.hull, strict=True)
    assert low == pytest.approx([min(xs), 0.0, -max(ys)], abs=1e-4)  # y up, north away
    assert high == pytest.approx([max(xs), HEIGHT, -min(ys)], abs=1e-4)
    for room in found.rooms:
        assert scene.geometry[room.name].volume == pytest.approx(shapely.Polygon(room.floor).area * 0.02, rel=1e-3)
    assert scene.metadata["run"] == "x"


def test_png_shows_rooms_in_their_tints_and_walls_in_ink() -> None:
    layout = house("square", 0)
    found, content = drawing(layout, "house"), WRITERS["png"](layout, "house", {})
    picture = Image.open(io.BytesIO(content))
    assert picture.mode == "RGB"
    colours = picture.getcolors(2**24)
    assert colours is not None
    counts = {colour: count for count, colour in colours}
    dots = 8.0**2 * 10.0**2  # of a square metre at 1:100
    for room, tint in zip(found.rooms, TINTS, strict=False):
        colour = tuple(int(tint[k : k + 2], 16) for k in (1, 3, 5))
        floor = shapely.Polygon(room.floor).area
        assert 0.7 * floor < counts[colour] / dots < 1.05 * floor  # words and swings take some, thresholds give some
    walls = sum(shapely.Polygon(ring).area * (1 if shapely.LinearRing(ring).is_ccw else -1)
                for ring in poche(found, ("door", "window")))  # fmt: skip
    assert 0.75 * walls < counts[0x1D, 0x1D, 0x1F] / dots < 1.4 * walls  # words are in ink too


@pytest.mark.parametrize("suffix", WRITERS)
def test_the_same_plan_gives_the_same_bytes(suffix: str) -> None:
    first, second = (written("hexagon", 1, suffix)[2] for _ in range(2))
    assert first == second


def test_cubes_are_written_as_solids_and_pictures(tmp_path: Path) -> None:
    layout = house("cube", 0, unit=2.0)
    scene: Any = trimesh.load(io.BytesIO(WRITERS["glb"](layout, "cubes", {})), file_type="glb")
    assert {name: round(mesh.volume, 3) for name, mesh in scene.geometry.items()} == {
        name: 8.0 * size for name, size in SIZES.items()
    }
    assert Image.open(io.BytesIO(cubes_png(layout, (80, 60)))).size == (80, 60)
    for suffix in WRITERS:
        if suffix not in OF_CUBES:
            with pytest.raises(InputError, match="a plan on one floor"):
                write_plan(layout, tmp_path / f"x.{suffix}", "cubes")
    with pytest.raises(InputError, match=r"a plan's suffix \(\.svg, \.dxf, \.ifc, \.glb, \.png\), got '\.doc'"):
        write_plan(layout, tmp_path / "x.doc", "cubes")
    assert not list(tmp_path.iterdir())


def test_a_sheet_shows_each_plan_at_one_scale_with_short_names() -> None:
    plans = [drawing(house("square", seed), f"plan {seed}") for seed in range(5)]
    root = ET.fromstring(sheet_svg(plans, "Five"))
    captions = [one.text for one in root.iter() if one.get("class") == "caption"]
    assert captions == [f"plan {seed}" for seed in range(5)]
    names = [one.text for one in root.iter() if one.get("class") == "name"]
    assert names == ["L", "K", "E", "H", "MB", "B"] * 5
    paper = sheet(plans, "Five")
    rooms = [mark for mark in paper.marks if mark.kind == "room"]
    sizes = [shapely.Polygon(mark.rings[0]).area for mark in rooms]  # type: ignore[union-attr]
    per_cell = [size / cells for size, cells in zip(sizes, list(SIZES.values()) * 5, strict=True)]
    assert per_cell == pytest.approx([per_cell[0]] * 30)
    boxes = [shapely.MultiPolygon([shapely.Polygon(mark.rings[0]) for mark in rooms[6 * k : 6 * k + 6]])  # type: ignore[union-attr]
             for k in range(5)]  # fmt: skip
    assert not any(shapely.box(*a.bounds).intersects(shapely.box(*b.bounds)) for k, a in enumerate(boxes)
                   for b in boxes[:k])  # fmt: skip
    assert Image.open(io.BytesIO(sheet_png(plans, "Five"))).width == round(paper.width * 8)
    with pytest.raises(InputError, match="1 to 48 plans"):
        sheet([], "none")
