"""A drawing as IFC4 by ifcopenshell: site, building and storey, spaces, walls with doors and windows, a slab; metres.

Quantities are measured to the axes of walls, as the drawing's are: a space's area and a wall's length are the plan's.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from evaluators.plans.drawings.draw import plain
from evaluators.plans.drawings.drawing import (
    DOOR_HEAD,
    HEIGHT,
    SLAB,
    WINDOW_HEAD,
    WINDOW_SILL,
    Drawing,
    DrawnRoom,
    Opening,
    Point,
    Ring,
    Wall,
    ring_area,
)
from evaluators.plans.drawings.ifc_model import Entity, Model

LEAF: Final = 0.05
"""The thickness of a door's leaf, and of a window, in metres."""


def plan_ifc(drawing: Drawing) -> bytes:
    """Write a plan; the same drawing gives the same bytes: identities are hashes, the time is fixed."""
    model = Model(drawing.title)
    storey = _places(model, drawing)
    spaces = [_space(model, storey, number, room) for number, room in enumerate(drawing.rooms)]
    model.root("IfcRelAggregates", "spaces", RelatingObject=storey, RelatedObjects=spaces)
    elements = [_slab(model, storey, drawing)]
    alike: dict[bool, list[Entity]] = {}
    for number, wall in enumerate(drawing.walls):
        made = _wall(model, storey, drawing, number)
        elements.append(made)
        alike.setdefault(wall.outer, []).append(made)
        for place, opening in enumerate(drawing.of_wall(number)):
            elements.append(_opening(model, made, wall, opening, f"{number}.{place}"))
    for outer, own in alike.items():
        thickness = next(wall.thickness for wall in drawing.walls if wall.outer == outer)
        usage = model.layers("Outer wall" if outer else "Inner wall", thickness)
        model.root("IfcRelAssociatesMaterial", f"material {outer}", RelatedObjects=own, RelatingMaterial=usage)
    model.root("IfcRelContainedInSpatialStructure", "contents", RelatingStructure=storey, RelatedElements=elements)
    return model.written()


def _places(model: Model, drawing: Drawing) -> Entity:
    """Make site, building and storey, each in the one before, and give the storey."""
    origin = model.placement(None, (0.0, 0.0, 0.0))
    outline = drawing.ground.outline
    shape = None
    if outline is not None:
        shape = model.shape([("FootPrint", "Curve2D", model.polyline((*outline, outline[0])))])
    site = model.root("IfcSite", "site", Name="Site", ObjectPlacement=origin, Representation=shape,
                      CompositionType="ELEMENT")  # fmt: skip
    at = model.placement(origin, (0.0, 0.0, 0.0))
    building = model.root("IfcBuilding", "building", Name=drawing.title, ObjectPlacement=at, CompositionType="ELEMENT")
    at = model.placement(building.ObjectPlacement, (0.0, 0.0, 0.0))
    storey = model.root("IfcBuildingStorey", "storey", Name="Ground floor", ObjectPlacement=at,
                        CompositionType="ELEMENT", Elevation=0.0)  # fmt: skip
    for upper, lower in ((model.project, site), (site, building), (building, storey)):
        model.root("IfcRelAggregates", f"within {upper.is_a()}", RelatingObject=upper, RelatedObjects=[lower])
    return storey


def _space(model: Model, storey: Entity, number: int, room: DrawnRoom) -> Entity:
    space = model.root(
        "IfcSpace", f"space {number}", Name=room.name, LongName=plain(room.name), CompositionType="ELEMENT",
        PredefinedType="INTERNAL", ObjectPlacement=model.placement(storey.ObjectPlacement, (0.0, 0.0, 0.0)),
        Representation=model.shape([("Body", "SweptSolid", model.extruded(room.outline, HEIGHT))]),
    )  # fmt: skip
    figures = {"Height": HEIGHT, "GrossPerimeter": _perimeter(room.outline), "GrossFloorArea": room.area,
               "GrossVolume": room.area * HEIGHT}  # fmt: skip
    model.quantities(space, "Qto_SpaceBaseQuantities", figures)
    return space


def _slab(model: Model, storey: Entity, drawing: Drawing) -> Entity:
    made = model.root(
        "IfcSlab", "slab", Name="Floor slab", PredefinedType="FLOOR",
        ObjectPlacement=model.placement(storey.ObjectPlacement, (0.0, 0.0, -SLAB)),
        Representation=model.shape([("Body", "SweptSolid", model.extruded(drawing.hull, SLAB))]),
    )  # fmt: skip
    model.quantities(made, "Qto_SlabBaseQuantities", {"Width": SLAB, "GrossArea": ring_area(drawing.hull)})
    return made


def _wall(model: Model, storey: Entity, drawing: Drawing, number: int) -> Entity:
    """Make a wall in a frame of its own: x along the axis, from its first end."""
    wall = drawing.walls[number]
    names = [drawing.rooms[room].name for room in wall.rooms if room >= 0]
    axis = model.polyline(((0.0, 0.0), (wall.length, 0.0)))
    shape = model.shape([
        ("Axis", "Curve2D", axis),
        ("Body", "SweptSolid", model.extruded([_local(wall, point) for point in wall.body], HEIGHT)),
    ])  # fmt: skip
    at = model.placement(storey.ObjectPlacement, (*wall.first, 0.0), wall.along)
    made = model.root("IfcWall", f"wall {number}", Name=" | ".join(names if len(names) > 1 else [*names, "outside"]),
                      PredefinedType="STANDARD", ObjectPlacement=at, Representation=shape)  # fmt: skip
    area = ring_area(wall.body)
    figures = {"Length": wall.length, "Width": wall.thickness, "Height": HEIGHT, "GrossFootprintArea": area,
               "GrossVolume": area * HEIGHT}  # fmt: skip
    model.quantities(made, "Qto_WallBaseQuantities", figures)
    model.properties(made, "Pset_WallCommon", {"IsExternal": wall.outer})
    return made


def _local(wall: Wall, point: Point) -> Point:
    (dx, dy), x, y = wall.along, point[0] - wall.first[0], point[1] - wall.first[1]
    return x * dx + y * dy, y * dx - x * dy


def _opening(model: Model, host: Entity, wall: Wall, one: Opening, key: str) -> Entity:
    """Cut an opening into a wall, and fill it with a door or a window.

    A door's frame has y towards where it opens, as its operation types want it.
    """
    low, high = (0.0, DOOR_HEAD) if one.kind == "door" else (WINDOW_SILL, WINDOW_HEAD)
    deep = wall.thickness + 0.1
    hole = _box(0.0, one.width, -deep / 2, deep / 2)
    void = model.root(
        "IfcOpeningElement", f"opening {key}", Name="Opening", PredefinedType="OPENING",
        ObjectPlacement=model.placement(host.ObjectPlacement, (one.start, 0.0, low)),
        Representation=model.shape([("Body", "SweptSolid", model.extruded(hole, high - low))]),
    )  # fmt: skip
    model.root("IfcRelVoidsElement", f"void {key}", RelatingBuildingElement=host, RelatedOpeningElement=void)
    left = one.into == wall.rooms[0]
    start, ahead = ((0.0, 0.0, 0.0), (1.0, 0.0)) if left else ((one.width, 0.0, 0.0), (-1.0, 0.0))
    at = model.placement(void.ObjectPlacement, start, ahead)
    face = wall.thickness / 2 if one.kind == "door" else LEAF / 2
    body = model.extruded(_box(0.0, one.width, face - LEAF, face), high - low)
    shape = model.shape([("Body", "SweptSolid", body)])
    figures = {"OverallWidth": one.width, "OverallHeight": high - low}
    if one.kind == "door":
        swing = "LEFT" if one.hinge_last != left else "RIGHT"
        name = "Front door" if one.front else "Door"
        made = model.root("IfcDoor", f"door {key}", Name=name, ObjectPlacement=at, Representation=shape,
                          PredefinedType="DOOR", OperationType=f"SINGLE_SWING_{swing}", **figures)  # fmt: skip
    else:
        made = model.root("IfcWindow", f"window {key}", Name="Window", ObjectPlacement=at, Representation=shape,
                          PredefinedType="WINDOW", PartitioningType="SINGLE_PANEL", **figures)  # fmt: skip
    model.root("IfcRelFillsElement", f"fill {key}", RelatingOpeningElement=void, RelatedBuildingElement=made)
    return made


def _box(left: float, right: float, low: float, high: float) -> Ring:
    return (left, low), (right, low), (right, high), (left, high)


def _perimeter(ring: Sequence[Point]) -> float:
    pairs = zip(ring, (*ring[1:], ring[0]), strict=True)
    return float(sum(((bx - ax) ** 2 + (by - ay) ** 2) ** 0.5 for (ax, ay), (bx, by) in pairs))
