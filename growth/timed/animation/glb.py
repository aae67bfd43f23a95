"""Drawings as an animated GLB file.

A part that only moves is a node with translation, rotation and scale; equal shapes are one mesh. Vertices that move
within a part are morph targets, one for each drawing that differs. What is born or dies in between is shown and hidden
by the scale of a node above it, at once. Between two drawings all is interpolated. Programs that play no animation show
the last drawing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final, final

import numpy as np

from growth.timed.animation.gltf import VERTICES, Buffer, container
from growth.timed.animation.meshes import Parted, normals_of, parted
from growth.timed.animation.places import Places, places_of
from growth.timed.animation.segments import Segment, segments
from growth.timed.drawing import Drawing, Shape
from growth.timed.tables import Floats

UPRIGHT: Final = [-(0.5**0.5), 0.0, 0.0, 0.5**0.5]
"""Turns z up to the y up of glTF, (x, y, z) to (x, z, -y)."""

STILL: Final = 1e-7
"""What changes less, of the largest of it (of a whole, for rotations), does not move."""


def animated_glb(drawings: Sequence[Drawing], extras: Mapping[str, Any] | None = None) -> bytes:
    """Write drawings as a GLB file; the same drawings give the same bytes.

    Parameters
    ----------
    drawings
        Of ascending times, the times in seconds from the first one on. A single one gives a form that stands still.
    extras
        What the form is, kept with the scene.

    Returns
    -------
    The file's content, y up.
    """
    return _Scene([drawing.time - drawings[0].time for drawing in drawings]).file(segments(drawings), extras or {})


@final
class _Scene:
    """Nodes, meshes, materials and channels as they are gathered."""

    def __init__(self, times: Sequence[float]) -> None:
        self._times: Final = np.array(times)
        self._buffer: Final = Buffer()
        self._nodes: Final[list[dict[str, Any]]] = [{"name": "form", "rotation": UPRIGHT, "children": []}]
        self._meshes: Final[list[dict[str, Any]]] = []
        self._materials: Final[list[dict[str, Any]]] = []
        self._known: Final[dict[tuple[Any, ...], int]] = {}
        self._channels: Final[list[dict[str, Any]]] = []
        self._samplers: Final[list[dict[str, Any]]] = []

    def file(self, parts: Sequence[Segment], extras: Mapping[str, Any]) -> bytes:
        """Add all parts, and give the file."""
        for segment in parts:
            self._add(segment)
        scene: dict[str, Any] = {"nodes": [0]}
        content: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": "Atoll"},
            "scene": 0,
            "scenes": [scene | ({"extras": dict(extras)} if extras else {})],
            "nodes": self._nodes,
            "meshes": self._meshes,
            "materials": self._materials,
            "accessors": self._buffer.accessors,
            "bufferViews": self._buffer.views,
        }
        if self._channels:
            content["animations"] = [{"name": "growth", "channels": self._channels, "samplers": self._samplers}]
        binary = self._buffer.data
        content["buffers"] = [{"byteLength": len(binary)}]
        return container(content, binary)

    def _add(self, segment: Segment) -> None:
        number = len(self._nodes)
        name = f"{segment.name}-{number}"
        node: dict[str, Any] = {"name": name, "mesh": self._mesh(segment)}
        self._nodes.append(node)
        self._move(number, node, segment, places_of(segment.frames))
        if len(segment.shapes) > 1:
            self._morph(number, segment)
        top = number
        if segment.first > 0 or segment.last < len(self._times) - 1:
            top = len(self._nodes)
            there = [float(segment.last == len(self._times) - 1)] * 3
            self._nodes.append({"name": f"{name}-life", "children": [number], "scale": there})
            self._gate(top, segment)
        self._nodes[0]["children"].append(top)

    # -- what moves ----------------------------------------------------------------------------------------------

    def _move(self, number: int, node: dict[str, Any], segment: Segment, places: Places) -> None:
        """Give a node its place, and channels for what of it changes."""
        for path, values in zip(("translation", "rotation", "scale"), places, strict=True):
            least = STILL * (1.0 if path == "rotation" else float(np.abs(values).max(initial=0.0)))
            node[path] = [float(value) for value in values[-1].astype(np.float32)]
            if float(np.abs(values - values[0]).max(initial=0.0)) > least:
                self._channel(number, path, self._span(segment), values, "LINEAR")

    def _morph(self, number: int, segment: Segment) -> None:
        """Let the drawing's own target count alone at each time."""
        places = _distinct(segment.shapes)
        weights = np.zeros((len(places), max(places)))
        for row, place in enumerate(places):
            if place:
                weights[row, place - 1] = 1.0
        self._channel(number, "weights", self._span(segment), weights.reshape(-1), "LINEAR")

    def _gate(self, number: int, segment: Segment) -> None:
        """Show what is below a node from the first drawing that has it to the first that has it not."""
        marks = [(0.0, 0.0)] if segment.first > 0 else []
        marks.append((float(self._times[segment.first]), 1.0))
        if segment.last < len(self._times) - 1:
            marks.append((float(self._times[segment.last + 1]), 0.0))
        times, shown = np.array(marks).T
        self._channel(number, "scale", times, np.repeat(shown[:, None], 3, axis=1), "STEP")

    def _span(self, segment: Segment) -> Floats:
        return np.asarray(self._times[segment.first : segment.last + 1])

    def _channel(self, node: int, path: str, times: Floats, values: Floats, interpolation: str) -> None:
        sampler = {
            "input": self._buffer.floats(times, bounded=True),
            "output": self._buffer.floats(values),
            "interpolation": interpolation,
        }
        self._samplers.append(sampler)
        self._channels.append({"sampler": len(self._samplers) - 1, "target": {"node": node, "path": path}})

    # -- what it looks like --------------------------------------------------------------------------------------

    def _mesh(self, segment: Segment) -> int:
        """Give the number of a segment's mesh; what stands still shares it with its likes."""
        base = segment.shapes[-1]
        material = self._material(segment.colour, closed=base.closed)
        key = (base.vertices.tobytes(), base.triangles.tobytes(), material)
        if len(segment.shapes) == 1 and key in self._known:
            return self._known[key]
        shape = parted(base)
        primitive: dict[str, Any] = {
            "attributes": self._attributes(base.vertices, shape),
            "indices": self._buffer.indices(shape.triangles),
            "material": material,
        }
        mesh: dict[str, Any] = {"name": base.name, "primitives": [primitive]}
        if len(segment.shapes) > 1:
            primitive["targets"] = self._targets(segment.shapes, shape)
            mesh["weights"] = [0.0] * len(primitive["targets"])
        self._meshes.append(mesh)
        if len(segment.shapes) == 1:
            self._known[key] = len(self._meshes) - 1
        return len(self._meshes) - 1

    def _attributes(self, vertices: Floats, shape: Parted) -> dict[str, int]:
        return {
            "POSITION": self._buffer.floats(vertices[shape.sources], VERTICES, bounded=True),
            "NORMAL": self._buffer.floats(normals_of(vertices, shape), VERTICES),
        }

    def _targets(self, shapes: Sequence[Shape], shape: Parted) -> list[dict[str, int]]:
        """Give how vertices and normals differ from the last shape's, in each shape that differs."""
        base, straight = shapes[-1].vertices, normals_of(shapes[-1].vertices, shape)
        found: list[dict[str, int]] = []
        for at, place in zip(shapes, _distinct(shapes), strict=True):
            if place > len(found):
                moved = (at.vertices - base)[shape.sources]
                turned = normals_of(at.vertices, shape) - straight
                found.append({
                    "POSITION": self._buffer.floats(moved, VERTICES, bounded=True),
                    "NORMAL": self._buffer.floats(turned, VERTICES),
                })  # fmt: skip
        return found

    def _material(self, colour: Floats, *, closed: bool) -> int:
        key = (colour.tobytes(), closed)
        if key not in self._known:
            light = np.where(colour <= 0.04045, colour / 12.92, ((colour + 0.055) / 1.055) ** 2.4)
            metallic = {
                "baseColorFactor": [*np.clip(light, 0.0, 1.0).tolist(), 1.0],
                "metallicFactor": 0.0,
                "roughnessFactor": 0.85,
            }
            material: dict[str, Any] = {"name": _hexadecimal(colour), "pbrMetallicRoughness": metallic}
            self._materials.append(material if closed else {**material, "doubleSided": True})
            self._known[key] = len(self._materials) - 1
        return self._known[key]


def _distinct(shapes: Sequence[Shape]) -> list[int]:
    """Give each shape a number by its vertices, in the order in which they come; those like the last have 0."""
    known = {shapes[-1].vertices.tobytes(): 0}
    return [known.setdefault(shape.vertices.tobytes(), len(known)) for shape in shapes]


def _hexadecimal(colour: Floats) -> str:
    return "#" + "".join(f"{round(255.0 * float(part)):02x}" for part in np.clip(colour, 0.0, 1.0))
