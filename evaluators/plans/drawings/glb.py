"""Plans as GLB: walls raised with their openings, floors coloured by room, a slab; of cubes the rooms' solids.

GLB has y up by its standard: it is turned here, (x, y, z) to (x, z, -y).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from evaluators.plans.drawings.drawing import Drawing
from evaluators.plans.drawings.marks import TINTS
from evaluators.plans.drawings.solids import Solid, floors, raised_walls, slab
from evaluators.plans.layout import Layout
from growth.polyforms.polyform import Plan
from growth.polyforms.solid import raised

if TYPE_CHECKING:
    import trimesh

WALLS: Final = (238, 235, 228)
SLAB: Final = (150, 148, 142)
STRONG: Final = ("#d67652", "#4a7c96", "#c9a34a", "#75865a", "#8f5f83", "#a9a25c", "#5f9a92", "#b0707c")
"""Colours of rooms of cubes in turn, which have no white walls around them."""


class Part(NamedTuple):
    """A solid in one colour."""

    name: str
    solid: Solid
    colour: tuple[int, int, int]


def plan_parts(drawing: Drawing) -> list[Part]:
    """Give walls, slab, and each room's floor by its name."""
    rooms = [
        Part(room.name, one, _colour(TINTS[number % len(TINTS)], 0.8))
        for number, (room, one) in enumerate(zip(drawing.rooms, floors(drawing), strict=True))
    ]
    return [Part("walls", raised_walls(drawing), WALLS), Part("slab", slab(drawing), SLAB), *rooms]


def cube_parts(layout: Layout) -> list[Part]:
    """Give the solid of each room of cubes, in metres."""
    plan, unit = layout.plan, layout.brief.unit
    parts = []
    for room, name in enumerate(layout.brief.rooms):
        cells = plan.cells[plan.rooms == room]
        own = Plan(plan.tiling, cells, np.zeros(len(cells), dtype=np.int64))
        vertices, triangles = raised(own, 1.0)
        parts.append(Part(name, Solid(vertices * unit, triangles), _colour(STRONG[room % len(STRONG)], 1.0)))
    return parts


def parts_glb(parts: Sequence[Part], extras: Mapping[str, Any]) -> bytes:
    """Write parts, each a node, a mesh and a material of its name; the same parts give the same bytes."""
    import trimesh
    from trimesh.exchange.gltf import export_glb

    scene = trimesh.Scene(metadata=dict(extras))
    for part in parts:
        scene.add_geometry(_mesh(part), node_name=part.name, geom_name=part.name)
    return bytes(export_glb(scene, include_normals=False))


def _mesh(part: Part) -> trimesh.Trimesh:
    import trimesh
    from trimesh.visual import TextureVisuals
    from trimesh.visual.material import PBRMaterial

    finish = {"baseColorFactor": (*part.colour, 255), "metallicFactor": 0.0, "roughnessFactor": 0.9}
    visual = TextureVisuals(material=PBRMaterial(name=part.name, **finish))
    vertices = part.solid.vertices
    turned = np.stack([vertices[:, 0], vertices[:, 2], -vertices[:, 1]], axis=1)
    return trimesh.Trimesh(vertices=turned, faces=part.solid.triangles, process=False, validate=False, visual=visual)


def _colour(tint: str, light: float) -> tuple[int, int, int]:
    red, green, blue = (round(light * int(tint[k : k + 2], 16)) for k in (1, 3, 5))
    return red, green, blue
