"""The experiment file's JSON Schema, the sections of the built kinds included."""

from __future__ import annotations

from typing import Any

from genome.settings import Settings
from islands.kinds.registry import KINDS, resolve_kind
from orchestrator.briefs import BriefSettings
from orchestrator.channels import OF_KIND
from orchestrator.experiment import Experiment
from orchestrator.topology.registry import TOPOLOGIES, resolve_topology


def experiment_schema() -> dict[str, Any]:
    """Give the schema: the models', and for each kind what its ``genome`` and ``growth`` hold."""
    schema = Experiment.model_json_schema(by_alias=True)
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema"
    schema["title"] = "Atoll experiment"
    # The name is the file's unless it is given.
    schema["required"] = [key for key in schema["required"] if key != "name"]
    definitions = schema["$defs"]
    rules = []
    for name in KINDS:
        kind = resolve_kind(name, "schema")
        sections = {}
        for section, model in (("genome", kind.genome), ("growth", kind.growth)):
            part = model.model_json_schema(ref_template="#/$defs/{model}")
            definitions.update(part.pop("$defs", {}))
            definitions[model.__name__] = part
            sections[section] = {"$ref": f"#/$defs/{model.__name__}"}
        condition = {"properties": {"kind": {"const": name}}, "required": ["kind"]}
        rules.append({"if": condition, "then": {"properties": sections}})
    definitions["IslandSettings"]["allOf"] = rules
    # Islands may take any of their keys from `defaults`.
    definitions["IslandSettings"].pop("required", None)
    _tell_of_channels(definitions)
    _tell_of_briefs(schema)
    return schema


def _tell_of_briefs(schema: dict[str, Any]) -> None:
    """Say what a brief holds, and that an experiment with one needs no islands of its own."""
    part = BriefSettings.model_json_schema(ref_template="#/$defs/{model}")
    schema["$defs"].update(part.pop("$defs", {}))
    schema["$defs"]["BriefSettings"] = part
    schema["properties"]["brief"] = {"$ref": "#/$defs/BriefSettings"}
    schema["required"] = [key for key in schema["required"] if key != "islands"]
    schema["anyOf"] = [{"required": ["islands"]}, {"required": ["brief"]}]


def _tell_of_channels(definitions: dict[str, Any]) -> None:
    """Say what each built topology takes, which keys belong to which kind, and that a channel has one form."""
    channel = definitions["ChannelSettings"]
    by_name = []
    for name in TOPOLOGIES:
        found = resolve_topology(name, "schema")
        part: dict[str, Any] = {"properties": {}, "additionalProperties": False}
        if isinstance(found, type) and issubclass(found, Settings):
            part = found.model_json_schema(ref_template="#/$defs/{model}")
            definitions.update(part.pop("$defs", {}))
        part["properties"] = {"name": {"const": name}, **part["properties"]}
        named = {"type": "object", "properties": {"name": {"const": name}}, "required": ["name"]}
        by_name.append({"if": named, "then": part})
        if part.get("required"):
            by_name.append({"if": {"type": "string"}, "then": {"not": {"const": name}}})
    keyed = {"type": "object", "properties": {"name": {"type": "string"}}, "required": ["name"]}
    either = {"anyOf": [{"type": "string", "examples": list(TOPOLOGIES)}, keyed, {"type": "null"}]}
    channel["properties"]["topology"] = {"title": "Topology", "default": None, **either, "allOf": by_name}
    forms = [{"required": ["topology"]}, {"required": ["from", "to"]}]
    strangers = [
        {"if": {"required": [key]}, "then": {"properties": {"kind": {"const": kind}}, **_unless_usual(kind)}}
        for key, kind in OF_KIND.items()
    ]
    channel["anyOf"] = forms
    channel["allOf"] = [*strangers, {"not": {"required": ["count", "rate"]}}]


def _unless_usual(kind: str) -> dict[str, Any]:
    """Require a kind to be named, but for migrants, which a channel without one carries."""
    return {} if kind == "migrants" else {"required": ["kind"]}
