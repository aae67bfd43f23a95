"""An IFC4 model that is being written: units, contexts, placements, shapes, quantities, and identities from hashes."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from typing import Any, Final

from evaluators.plans.drawings.drawing import Point

Entity = Any
"""An entity of ifcopenshell."""

MOMENT: Final = "1970-01-01T00:00:00"
"""Stands in the header: the same plan gives the same file."""
HASHED: Final = 32
"""Hexadecimal digits that make an identity."""


class Model:
    """A model with a project.

    Parameters
    ----------
    title
        Of the project; identities are hashes of it and of keys.
    """

    def __init__(self, title: str) -> None:
        import ifcopenshell

        self._file = ifcopenshell.file(schema="IFC4")
        self._title: Final = title
        names = (("LENGTHUNIT", "METRE"), ("AREAUNIT", "SQUARE_METRE"), ("VOLUMEUNIT", "CUBIC_METRE"),
                 ("PLANEANGLEUNIT", "RADIAN"))  # fmt: skip
        units = self._file.createIfcUnitAssignment([self._file.createIfcSIUnit(None, t, None, n) for t, n in names])
        axes = self._axes((0.0, 0.0, 0.0), None)
        north = self._file.createIfcDirection((0.0, 1.0))
        model = self._file.createIfcGeometricRepresentationContext(None, "Model", 3, 1e-5, axes, north)
        views = {"Body": "MODEL_VIEW", "Axis": "GRAPH_VIEW", "FootPrint": "PLAN_VIEW"}
        self._contexts: Final = {
            name: self._file.createIfcGeometricRepresentationSubContext(
                name, "Model", None, None, None, None, model, None, view, None
            )
            for name, view in views.items()
        }
        self.project: Final = self.root(
            "IfcProject", "project", Name=title, RepresentationContexts=[model], UnitsInContext=units
        )

    def root(self, kind: str, key: str, **values: Any) -> Entity:  # noqa: ANN401 - whatever an entity has
        """Make an entity with an identity of its own: keys of one kind differ."""
        import ifcopenshell.guid

        digest = hashlib.sha256(f"{self._title}\n{kind}\n{key}".encode()).hexdigest()[:HASHED]
        return self._file.create_entity(kind, GlobalId=ifcopenshell.guid.compress(digest), **values)

    def placement(self, within: Entity | None, at: tuple[float, float, float], ahead: Point | None = None) -> Entity:
        """Place a frame in another: its origin, and where its x goes."""
        return self._file.createIfcLocalPlacement(within, self._axes(at, ahead))

    def shape(self, items: Sequence[tuple[str, str, Entity]]) -> Entity:
        """Make a product's shape of items: by context, type of representation, geometry."""
        rows = [
            self._file.createIfcShapeRepresentation(self._contexts[context], context, kind, [item])
            for context, kind, item in items
        ]
        return self._file.createIfcProductDefinitionShape(None, None, rows)

    def polyline(self, points: Sequence[Point]) -> Entity:
        """Make a line of points in the plane."""
        return self._file.createIfcPolyline([self._file.createIfcCartesianPoint(_plain(point)) for point in points])

    def extruded(self, ring: Sequence[Point], height: float) -> Entity:
        """Raise a polygon."""
        corners = [self._file.createIfcCartesianPoint(_plain(point)) for point in ring]
        curve = self._file.createIfcPolyline([*corners, corners[0]])
        profile = self._file.createIfcArbitraryClosedProfileDef("AREA", None, curve)
        up = self._file.createIfcDirection((0.0, 0.0, 1.0))
        return self._file.createIfcExtrudedAreaSolid(profile, self._axes((0.0, 0.0, 0.0), None), up, height)

    def layers(self, name: str, thickness: float) -> Entity:
        """Make walls' material of one layer, which lies evenly about their axis."""
        material = self._file.createIfcMaterial(name)
        layer = self._file.createIfcMaterialLayer(material, thickness)
        layers = self._file.createIfcMaterialLayerSet([layer], name)
        return self._file.createIfcMaterialLayerSetUsage(layers, "AXIS2", "POSITIVE", -thickness / 2)

    def quantities(self, entity: Entity, name: str, figures: Mapping[str, float]) -> None:
        """Say how much an entity has: areas, volumes and lengths, by the ends of their names."""
        rows = []
        for key, figure in figures.items():
            kind = next((kind for kind in ("Area", "Volume") if key.endswith(kind)), "Length")
            rows.append(self._file.create_entity(f"IfcQuantity{kind}", Name=key, **{f"{kind}Value": figure}))
        made = self.root("IfcElementQuantity", f"{name} of {entity.GlobalId}", Name=name, Quantities=rows)
        self._defined(entity, made)

    def properties(self, entity: Entity, name: str, values: Mapping[str, bool]) -> None:
        """Say what an entity is."""
        rows = [
            self._file.createIfcPropertySingleValue(key, None, self._file.create_entity("IfcBoolean", value), None)
            for key, value in values.items()
        ]
        self._defined(
            entity, self.root("IfcPropertySet", f"{name} of {entity.GlobalId}", Name=name, HasProperties=rows)
        )

    def written(self) -> bytes:
        """Give the file."""
        header = self._file.header
        header.file_description.description = ("ViewDefinition [ReferenceView_V1.2]",)
        name = header.file_name
        name.name, name.time_stamp, name.author, name.organization = self._title, MOMENT, ("",), ("",)
        name.preprocessor_version, name.originating_system, name.authorization = "ifcopenshell", "atoll", ""
        text: str = self._file.to_string()  # type: ignore[no-untyped-call]
        return text.encode()

    def _defined(self, entity: Entity, by: Entity) -> None:
        self.root("IfcRelDefinesByProperties", f"defines {by.GlobalId}", RelatedObjects=[entity],
                  RelatingPropertyDefinition=by)  # fmt: skip

    def _axes(self, at: tuple[float, float, float], ahead: Point | None) -> Entity:
        point = self._file.createIfcCartesianPoint(_plain(at))
        if ahead is None:
            return self._file.createIfcAxis2Placement3D(point, None, None)
        up, on = ((0.0, 0.0, 1.0), (*_plain(ahead), 0.0))
        return self._file.createIfcAxis2Placement3D(
            point, self._file.createIfcDirection(up), self._file.createIfcDirection(on)
        )


def _plain(point: Sequence[float]) -> tuple[float, ...]:
    """Give coordinates to a nanometre, without a negative zero."""
    return tuple(round(float(one), 9) + 0.0 for one in point)
