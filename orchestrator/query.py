"""SQL over a run's log: DuckDB views named as the tables."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import date, datetime
from decimal import Decimal
from pathlib import Path
from typing import TYPE_CHECKING, Any

from genome.errors import InputError
from islands.schemas import TABLES, schema

if TYPE_CHECKING:
    import duckdb


def connect(log: Path) -> duckdb.DuckDBPyConnection:
    """Open an in-memory database with one view for each table of the log.

    A view is a glob over the table's whole files, so a running or killed run can be read; a table without a file yet
    is an empty view with its columns.
    """
    import duckdb

    connection = duckdb.connect()
    for table in TABLES:
        if any((log / table).glob("*.parquet")):
            glob = str(log / table / "*.parquet").replace("'", "''")
            connection.execute(f"create view {table} as select * from read_parquet('{glob}')")  # noqa: S608
        else:
            connection.register(f"no_{table}", schema(table).empty_table())
            connection.execute(f"create view {table} as select * from no_{table}")  # noqa: S608
    return connection


@dataclass(frozen=True, slots=True)
class Answer:
    """What a query gave: column names, and rows of Python values."""

    columns: tuple[str, ...]
    rows: list[tuple[Any, ...]]


def ask(log: Path, sql: str) -> Answer:
    """Put a query to a log.

    Raises
    ------
    InputError
        When DuckDB does not understand it.
    """
    import duckdb

    with connect(log) as connection:
        try:
            result = connection.execute(sql)
            names = tuple(str(column[0]) for column in result.description or ())
            return Answer(names, result.fetchall() if names else [])
        except duckdb.Error as error:
            raise _not_understood(error) from None


def write_parquet(log: Path, sql: str, path: Path) -> None:
    """Write a query's answer to a Parquet file.

    Raises
    ------
    InputError
        When DuckDB does not understand the query.
    """
    import duckdb
    import pyarrow.parquet as pq

    with connect(log) as connection:
        try:
            relation = connection.sql(sql)
            table = None if relation is None else relation.to_arrow_table()
        except duckdb.Error as error:
            raise _not_understood(error) from None
    if table is None:
        raise InputError("SQL", "a query with an answer", "a statement without one", "start with 'select'")
    pq.write_table(table, path, compression="zstd")


def _not_understood(error: Exception) -> InputError:
    lines = [" ".join(line.split()) for line in str(error).splitlines() if line.strip()]
    told = " ".join(line for line in lines if not line.startswith(("LINE ", "^")))
    return InputError("SQL", "a query that DuckDB can answer", told, f"tables: {', '.join(TABLES)}")


def as_rows(answer: Answer) -> list[dict[str, Any]]:
    """Give the rows as JSON objects."""
    return [dict(zip(answer.columns, map(_plain, row), strict=True)) for row in answer.rows]


def as_csv(answer: Answer) -> str:
    """Give the rows as CSV with a heading; lists and maps are written as JSON, null as nothing."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(answer.columns)
    for row in answer.rows:
        writer.writerow("" if value is None else _text(value) for value in row)
    return stream.getvalue()


def as_table(answer: Answer) -> str:
    """Give the rows as text in columns, numbers to the right."""
    if not answer.columns:
        return ""
    cells = [["" if value is None else _text(value) for value in row] for row in answer.rows]
    widths = [max(map(len, column)) for column in zip(answer.columns, *cells, strict=True)]
    numeric = [_is_numeric(answer.rows, place) for place in range(len(widths))]

    def line(row: Sequence[str]) -> str:
        pairs = zip(row, widths, numeric, strict=True)
        return "  ".join(text.rjust(width) if right else text.ljust(width) for text, width, right in pairs).rstrip()

    return "\n".join([line(answer.columns), "  ".join("-" * width for width in widths), *map(line, cells)])


def _is_numeric(rows: Sequence[tuple[Any, ...]], place: int) -> bool:
    values = [row[place] for row in rows if row[place] is not None]
    return bool(values) and all(isinstance(value, (int, float, Decimal)) for value in values)


def _text(value: object) -> str:
    plain = _plain(value)
    if isinstance(plain, (dict, list)):
        return json.dumps(plain, allow_nan=False)
    return str(plain)


def _plain(value: object) -> Any:  # noqa: ANN401 - plain JSON values
    """Give a JSON value; what JSON lacks (infinity, NaN) becomes null."""
    if isinstance(value, bool) or value is None or isinstance(value, (int, str)):
        return value
    if isinstance(value, Decimal):
        return float(value)
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, (datetime, date)):
        return value.isoformat()
    if isinstance(value, dict):
        return {str(_plain(key)): _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    return str(value)
