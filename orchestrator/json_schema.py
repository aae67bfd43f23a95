"""The experiment file's JSON Schema, the sections of the built kinds included."""

from __future__ import annotations

from typing import Any

from islands.kinds.registry import KINDS, resolve_kind
from orchestrator.experiment import Experiment


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
    return schema
