"""The format of an environment file, as strict models (docs/formats/environment.md)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Annotated, Any

from pydantic import BeforeValidator, Discriminator, Field, Tag

from genome.errors import InputError
from genome.settings import Path as KeyPath
from genome.settings import Settings, Vector3, describe, near, validated
from growth.environment.boundaries.box import BoxSettings
from growth.environment.boundaries.cylinder import CylinderSettings
from growth.environment.boundaries.mesh import MeshSettings
from growth.environment.boundaries.plane import PlaneSettings
from growth.environment.boundaries.protocol import BoundarySettings
from growth.environment.boundaries.registry import SHAPES
from growth.environment.boundaries.sphere import SphereSettings

LineOf = Callable[[KeyPath], int | None]


def _as_tuple(value: object) -> object:
    if not isinstance(value, (list, tuple)):
        raise InputError("", "a list", describe(value), "write each entry after a '- '")
    return tuple(value)


class SourceSettings(Settings):
    """An attractor or a repeller: strength / distance^exponent (Hemberg 2006, section 4.7)."""

    at: Vector3
    strength: Annotated[float, Field(ge=0)] = 1.0
    exponent: Annotated[float, Field(ge=0, le=16)] = 2.0


def _kind(value: object) -> str | None:
    if isinstance(value, Mapping):
        return "mesh" if "mesh" in value else str(value.get("shape"))
    return "mesh" if isinstance(value, MeshSettings) else str(getattr(value, "shape", None))


AnyBoundary = Annotated[
    Annotated[SphereSettings, Tag("sphere")]
    | Annotated[BoxSettings, Tag("box")]
    | Annotated[PlaneSettings, Tag("plane")]
    | Annotated[CylinderSettings, Tag("cylinder")]
    | Annotated[MeshSettings, Tag("mesh")],
    Discriminator(_kind),
]


class EnvironmentSettings(Settings):
    """An environment: forces and boundaries. An empty file's worth of defaults is empty space."""

    gravity: Vector3 = (0.0, 0.0, 0.0)
    attractors: Annotated[tuple[SourceSettings, ...], BeforeValidator(_as_tuple)] = ()
    repellers: Annotated[tuple[SourceSettings, ...], BeforeValidator(_as_tuple)] = ()
    boundaries: Annotated[tuple[AnyBoundary, ...], BeforeValidator(_as_tuple)] = ()


def environment_settings(
    data: object, source: str, prefix: KeyPath = (), line_of: LineOf | None = None
) -> EnvironmentSettings:
    """Check plain data against the format.

    Each boundary is checked as its own shape, so that a misspelt key is told the near one of that shape.

    Raises
    ------
    InputError
        For the first thing that is wrong.
    """
    boundaries = data.get("boundaries") if isinstance(data, Mapping) else None
    if not isinstance(data, Mapping) or not isinstance(boundaries, (list, tuple)):
        return validated(EnvironmentSettings, data, source, prefix, line_of)
    forces = {key: value for key, value in data.items() if key != "boundaries"}
    settings = validated(EnvironmentSettings, forces, source, prefix, line_of)
    checked = [
        _boundary(item, source, (*prefix, "boundaries", index), line_of) for index, item in enumerate(boundaries)
    ]
    return settings.model_copy(update={"boundaries": tuple(checked)})


def _boundary(item: Any, source: str, path: KeyPath, line_of: LineOf | None) -> BoundarySettings:  # noqa: ANN401
    if not isinstance(item, Mapping):
        return validated(BoundarySettings, item, source, path, line_of)
    where = _where(source, path, line_of)
    if "mesh" in item and "shape" in item:
        raise InputError(where, "either a 'shape' or a 'mesh'", "both", "make two boundaries of it")
    if "mesh" in item:
        return _of_kind(MeshSettings, item, source, path, line_of)
    if "shape" not in item:
        remedy = next((hint for key in item if (hint := near(str(key), ["mesh", "shape"])).startswith("did")), "")
        raise InputError(where, "a 'shape' or a 'mesh'", ", ".join(map(str, item)) or "nothing", remedy)
    shape = item["shape"]
    if not isinstance(shape, str) or shape not in SHAPES:
        raise InputError(f"{where}.shape", "a shape", describe(shape), near(str(shape), list(SHAPES)))
    return _of_kind(SHAPES[shape][0], item, source, path, line_of)


def _of_kind(
    model: type[BoundarySettings], item: Mapping[str, Any], source: str, path: KeyPath, line_of: LineOf | None
) -> BoundarySettings:
    """Check a boundary, its misspelt keys before the required ones that are missing for it."""
    known = list(model.model_fields)
    unknown = next((key for key in item if key not in known), None)
    if unknown is not None:
        where = _where(source, (*path, unknown), line_of)
        raise InputError(where, "a known key", f"'{unknown}'", near(unknown, known))
    return validated(model, item, source, path, line_of)


def _where(source: str, path: KeyPath, line_of: LineOf | None) -> str:
    line = line_of(path) if line_of else None
    place = f"{source}:{line}" if line else source
    return f"{place}: {'.'.join(str(part) for part in path)}"
