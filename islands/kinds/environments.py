"""Environments under an island's settings: made, joined by what channels of surroundings bring, kept with a run."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

from pydantic import BeforeValidator, JsonValue

from genome.errors import InputError
from genome.settings import describe
from growth.environment import Environment, environment_among, environment_from, load_environment
from growth.environment.boundaries.mesh import PlacedSettings
from islands.kinds.meshes import read_mesh_text
from islands.kinds.protocol import Keep
from islands.migration.channel import Migrant
from islands.spec import IslandSpec


def _file_or_keys(value: object) -> object:
    if value is None or isinstance(value, (str, dict)):
        return value
    raise InputError("", "an environment file's name, or an environment's keys", describe(value))


GivenEnvironment = Annotated[str | dict[str, JsonValue] | None, BeforeValidator(_file_or_keys)]
"""A file's name, relative to the experiment, or the environment itself; None for empty space."""


def environment_of(spec: IslandSpec, given: str | Mapping[str, Any] | None, *keys: str) -> Environment:
    """Make the environment that stands under some keys of an island.

    Parameters
    ----------
    spec
        The island.
    given
        What :data:`GivenEnvironment` takes.
    keys
        Where it stands, such as ``growth``, ``environment``.

    Raises
    ------
    InputError
        When it, or a mesh that it names, is not right.
    """
    if given is None:
        return Environment.empty()
    if isinstance(given, str):
        path = Path(spec.base) / given
        if not path.is_file():
            where, got = spec.where(*keys), f"'{given}', which is not there"
            raise InputError(where, "an environment file", got, f"it is looked for in {spec.base}")
        return load_environment(path)
    return environment_from(given, spec.source, Path(spec.base), ("islands", spec.group, *keys))


def environment_around(environment: Environment, forms: tuple[Migrant, ...], placement: PlacedSettings) -> Environment:
    """Give an environment among forms that channels of surroundings brought: closed meshes, placed alike.

    Raises
    ------
    InputError
        For a form that is no closed mesh.
    """
    meshes = [(f"{form.id}", *read_mesh_text(form.text, f"form {form.id}")) for form in forms]
    return environment_among(environment, meshes, placement)


def kept_environment(spec: IslandSpec, given: str | Mapping[str, Any], keep: Keep, *keys: str) -> str | dict[str, Any]:
    """Keep an environment with a run: what stands in the settings in place of it.

    A file without meshes is kept as it is, any other with the meshes' copies in place of them. Parameters as of
    :func:`environment_of`.
    """
    environment = environment_of(spec, given, *keys)
    settings: dict[str, Any] = json.loads(json.dumps(environment.settings))
    copies = {name: keep("environment", path.name, path.read_bytes()) for name, path in environment.mesh_files}
    for boundary in settings["boundaries"]:
        if boundary.get("mesh") is not None:
            boundary["mesh"] = copies[boundary["mesh"]]
    if not isinstance(given, str):
        return settings
    name = Path(given).name
    if not copies:
        return keep("environment", name, (Path(spec.base) / given).read_bytes())
    # Paths in an environment's file are relative to that file, which lies beside its meshes.
    for boundary in settings["boundaries"]:
        if boundary.get("mesh") is not None:
            boundary["mesh"] = Path(boundary["mesh"]).name
    # JSON is YAML, and needs no writer here.
    return keep("environment", name, (json.dumps(settings, indent=1) + "\n").encode())
