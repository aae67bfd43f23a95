"""What a run keeps of what it was given: the experiment as resolved, and a copy of every file that it names."""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from genome.yaml import parse_yaml
from islands.kinds.protocol import Keep
from islands.kinds.registry import resolve_kind
from orchestrator.channels import ChannelSettings
from orchestrator.loading import Loaded
from orchestrator.plan import make_plan
from orchestrator.topology.registry import kept

EXPERIMENT: Final = "experiment.yaml"


def with_files_kept(loaded: Loaded, draft: Path) -> dict[str, Any]:
    """Copy what the islands name into the folder; give the experiment's data with the copies in their place."""
    taken: dict[str, bytes] = {}

    def keep(folder: str, name: str, content: bytes) -> str:
        stem, _, suffix = name.partition(".")
        place, number = f"{folder}/{name}", 2
        while taken.get(place, content) != content:
            place, number = f"{folder}/{stem}-{number}.{suffix}", number + 1
        if place not in taken:
            taken[place] = content
            (draft / folder).mkdir(parents=True, exist_ok=True)
            (draft / place).write_bytes(content)
        return place

    islands = dict(loaded.experiment.islands)
    for spec in {spec.group: spec for spec in make_plan(loaded).islands}.values():
        kind = resolve_kind(spec.kind, spec.where("kind"))
        genome, growth = kind.keep_files(spec, keep)
        changes = {"genome": dict(genome), "growth": dict(growth)}
        islands[spec.group] = islands[spec.group].model_copy(update=changes)
    channels = [
        _with_graph_kept(channel, loaded.base, keep, f"{loaded.source}: channels.{number}.topology")
        for number, channel in enumerate(loaded.experiment.channels)
    ]
    experiment = loaded.experiment.model_copy(update={"islands": islands, "channels": channels})
    return replace(loaded, experiment=experiment).data()


def _with_graph_kept(channel: ChannelSettings, base: Path, keep: Keep, where: str) -> ChannelSettings:
    """Keep the file that a channel's topology reads."""
    if not channel.parameters:
        return channel
    parameters = kept(channel.topology_name, channel.parameters, base, keep, where)
    return channel.model_copy(update={"topology": {"name": channel.topology_name, **parameters}})


def as_yaml(data: Mapping[str, Any]) -> str:
    """Write plain data as YAML, and make sure that it reads back."""
    from ruamel.yaml import YAML

    writer = YAML(typ="safe", pure=True)
    writer.default_flow_style = False
    writer.sort_base_mapping_type_on_output = False  # type: ignore[assignment]
    writer.width = 10_000
    stream = io.StringIO()
    writer.dump(dict(data), stream)
    text = stream.getvalue()
    if parse_yaml(text, EXPERIMENT).data != data:
        raise AssertionError(f"the resolved experiment does not read back as it was written:\n{text}")
    return text
