"""Making an environment from a file or from plain data."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from genome.settings import Path as KeyPath
from genome.yaml import load_yaml
from growth.environment.boundaries.mesh import MeshSettings, PlacedSettings, contents_of, mesh, placed_mesh
from growth.environment.boundaries.protocol import Boundary, Floats, Triangles
from growth.environment.boundaries.registry import SHAPES
from growth.environment.environment import Environment
from growth.environment.settings import EnvironmentSettings, LineOf, environment_settings


def load_environment(path: Path) -> Environment:
    """Read an environment file.

    Raises
    ------
    InputError
        When the file, or a mesh that it names, is not right.
    """
    document = load_yaml(path)
    return environment_from(document.data, document.source, path.parent, line_of=document.line_of)


def environment_from(
    data: object, source: str, base: Path, prefix: KeyPath = (), line_of: LineOf | None = None
) -> Environment:
    """Make an environment from plain data.

    Parameters
    ----------
    data
        What a YAML or JSON loader returned, or :attr:`Environment.settings` of an earlier one.
    source
        The file's name, for messages.
    base
        The folder that mesh paths are relative to.
    prefix
        The key path at which ``data`` stands in its file.
    line_of
        Gives the line of a key path, where the loader knows it.

    Raises
    ------
    InputError
        When the data, or a mesh that it names, is not right.
    """
    settings = environment_settings(data, source, prefix, line_of)
    dumped: dict[str, Any] = settings.model_dump(mode="json")
    meaning: dict[str, Any] = json.loads(json.dumps(dumped))
    hard: list[Boundary] = []
    soft: list[Boundary] = []
    files: list[tuple[str, Path]] = []
    for index, item in enumerate(settings.boundaries):
        boundary: Boundary
        if isinstance(item, MeshSettings):
            line = line_of((*prefix, "boundaries", index, "mesh")) if line_of else None
            boundary, contents = mesh(item, f"{source}:{line}" if line else source, base)
            dumped["boundaries"][index]["contents"] = contents
            meaning["boundaries"][index] |= {"mesh": None, "contents": contents}
            files.append((item.mesh, (base / item.mesh).resolve()))
        else:
            boundary = SHAPES[item.shape][1](item)
        (soft if item.soft else hard).append(boundary)
    gravity = np.array(settings.gravity, dtype=np.float64)
    return Environment(dumped, _digest(meaning), tuple(files), gravity, _sources(settings), tuple(hard), tuple(soft))


def environment_among(
    environment: Environment, meshes: Iterable[tuple[str, Floats, Triangles]], placement: PlacedSettings
) -> Environment:
    """Give an environment with further boundaries.

    Parameters
    ----------
    environment
        As it was.
    meshes
        A name, vertices (v, 3) float64 and triangles (t, 3) int32 of each: closed bodies, fronts outward.
    placement
        How each of them stands there.

    Returns
    -------
    Environment
        Its ``settings`` list the meshes by name and contents; there is no file to read them from again.
    """
    settings: dict[str, Any] = json.loads(json.dumps(dict(environment.settings)))
    placed: dict[str, Any] = json.loads(json.dumps(placement.model_dump(mode="json")))
    hard: list[Boundary] = [one for one in environment.boundaries if not one.soft]
    soft: list[Boundary] = [one for one in environment.boundaries if one.soft]
    meaning: list[Any] = [environment.digest]
    for name, vertices, triangles in meshes:
        boundary, contents = placed_mesh(vertices, triangles, placement), contents_of(vertices, triangles)
        (soft if placement.soft else hard).append(boundary)
        settings["boundaries"].append({**placed, "mesh": name, "contents": contents})
        meaning.append({**placed, "contents": contents})
    digest = _digest({"among": meaning})
    return replace(environment, settings=settings, digest=digest, _hard=tuple(hard), _soft=tuple(soft))


def _sources(settings: EnvironmentSettings) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    """Give the attractors, then the repellers with their strengths negative, as rows of five."""
    rows = [(*item.at, item.strength, item.exponent) for item in settings.attractors]
    rows += [(*item.at, -item.strength, item.exponent) for item in settings.repellers]
    return np.array(rows, dtype=np.float64).reshape(-1, 5)


def _digest(meaning: Mapping[str, Any]) -> str:
    text = json.dumps(_plus_zero(meaning), sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.blake2b(text.encode(), digest_size=16).hexdigest()


def _plus_zero(value: Any) -> Any:  # noqa: ANN401 - plain data
    """Write minus zero as zero: they mean the same."""
    if isinstance(value, Mapping):
        return {key: _plus_zero(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_plus_zero(item) for item in value]
    return value + 0.0 if isinstance(value, float) else value
