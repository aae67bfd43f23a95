"""The log's tables: frozen Arrow schemas, with their version in the metadata.

The columns and their order are the contract of ``docs/log-schema.md``. A change of any of them is a new ``VERSION``.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    import pyarrow as pa

VERSION: Final = "1"

TABLES: Final = ("individuals", "evaluations", "generations", "migrations", "events")

_COLUMNS: Final = {
    "individuals": "run:name island:name species:name generation:int epoch:int id:int parents:ids components:ids "
    "partners:ids origin:name genotype:text fitness:float scores:scores valid:bool error:text growth_ms:float "
    "evaluation_ms:float",
    "evaluations": "run:name island:name generation:int epoch:int id:int reason:name fitness:float scores:scores "
    "partners:ids valid:bool error:text evaluation_ms:float",
    "generations": "run:name island:name species:name generation:int epoch:int evaluations:int best:float mean:float "
    "std:float worst:float diversity:float invalid:int wall_ms:float",
    "migrations": "run:name island:name epoch:int channel:name kind:name source:name target:name id:int fitness:float "
    "accepted:bool reason:text",
    "events": "run:name island:name time:time epoch:int kind:name detail:text",
}

CLOCKED: Final = ("growth_ms", "evaluation_ms", "wall_ms", "time")
"""Columns that a clock fills: outside the promise of determinism, and outside the digest."""


@cache
def schema(table: str) -> pa.Schema:
    """Give the Arrow schema of one table."""
    import pyarrow as pa

    types = {
        "name": pa.dictionary(pa.int32(), pa.string()),
        "text": pa.string(),
        "int": pa.int64(),
        "float": pa.float64(),
        "bool": pa.bool_(),
        "ids": pa.list_(pa.int64()),
        "scores": pa.map_(pa.string(), pa.float64(), keys_sorted=True),
        "time": pa.timestamp("us"),
    }
    pairs = [column.split(":") for column in _COLUMNS[table].split()]
    fields = [pa.field(name, types[kind]) for name, kind in pairs]
    return pa.schema(fields, metadata={"atoll.table": table, "atoll.schema": VERSION})


def columns(table: str) -> tuple[str, ...]:
    """Give the names of a table's columns, in order."""
    return tuple(column.split(":")[0] for column in _COLUMNS[table].split())


def stored(table: str) -> tuple[list[str], list[str]]:
    """Give the Parquet leaf columns that are dictionary-encoded, and those that are byte-stream-split.

    Floats are byte-stream-split, which Parquet allows only where no dictionary is used; the rest of the columns keep
    Parquet's dictionaries, except texts that hardly ever repeat.
    """
    dictionary, split = [], []
    for column in _COLUMNS[table].split():
        name, kind = column.split(":")
        if kind == "float":
            split.append(name)
        elif kind == "scores":
            dictionary.append(f"{name}.key_value.key")
            split.append(f"{name}.key_value.value")
        elif kind == "ids":
            dictionary.append(f"{name}.list.element")
        elif name not in ("genotype", "detail", "id"):
            dictionary.append(name)
    return dictionary, split
