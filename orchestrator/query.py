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
from typing import TYPE_CHECKING, Any, Final

from genome.errors import InputError
from genome.mishaps import one_line
from islands.schemas import TABLES, schema
from islands.store import Anywhere, Store
from islands.stores.troubles import AWS
from islands.stores.troubles import told as unreached

if TYPE_CHECKING:
    import duckdb

READING: Final = ("SELECT", "MULTI")
"""DuckDB's types of the statements that only read; MULTI is that of ``pivot``."""


def connect(log: Anywhere, sql: str = "") -> duckdb.DuckDBPyConnection:
    """Open an in-memory database with one view for each table of the log, and nothing else to be had.

    A view reads the table's whole files, those that are there now, so a running or killed run can be read; a table
    without a file yet is an empty view with its columns. Other files are out of reach, and settings are locked. A log
    that is on no local disk is read through Arrow, as a query needs it: DuckDB itself reaches no store.

    With a query only the tables that it names are opened, so that a damaged one does not stand in the way of others.

    Raises
    ------
    InputError
        When a file of the log cannot be read.
    """
    import duckdb

    store = Store.open(log)
    connection = duckdb.connect()
    try:
        named = [table for table in TABLES if table in sql.lower()]
        for table in named or TABLES:
            names = [name for name in store.names(table) if name.endswith(".parquet")]
            if names and store.local is not None:
                # The files by name, not by a pattern: a folder's name may hold what a pattern takes for its own.
                listed = ", ".join(_quoted(str(store.local / table / name)) for name in names)
                connection.execute(f"create view {table} as select * from read_parquet([{listed}])")  # noqa: S608
            else:
                rows = _far(store, table, names) if names else schema(table).empty_table()
                connection.register(f"arrow_{table}", rows)
                connection.execute(f"create view {table} as select * from arrow_{table}")  # noqa: S608
        if store.local is not None:
            folders = ", ".join(_quoted(str(store.local / table)) for table in TABLES)
            connection.execute(f"set allowed_directories = [{folders}]")
        connection.execute("set enable_external_access = false")
        connection.execute("set lock_configuration = true")
    except (duckdb.Error, UnicodeError) as error:
        connection.close()
        raise InputError(str(store), "a run's log of Parquet files", _told(error)) from None
    return connection


def _far(store: Store, table: str, names: Sequence[str]) -> Any:  # noqa: ANN401 - Arrow has no types
    """Give a table's files in another store as one dataset, of which a query reads what it needs."""
    import pyarrow.dataset as ds

    files, root = store.at(table).arrow()
    return ds.dataset([f"{root}/{name}" for name in names], schema(table), "parquet", filesystem=files)


def _quoted(text: str) -> str:
    text.encode()  # as in _check
    return "'" + text.replace("'", "''") + "'"


@dataclass(frozen=True, slots=True)
class Answer:
    """What a query gave: column names, and rows of Python values."""

    columns: tuple[str, ...]
    rows: list[tuple[Any, ...]]


def ask(log: Anywhere, sql: str) -> Answer:
    """Put a query to a log.

    Raises
    ------
    InputError
        When it is not one query that only reads, or DuckDB does not understand it.
    """
    import duckdb

    with connect(log, sql) as connection:
        try:
            _check(connection, sql)
            result = connection.execute(sql)
            names = unique([str(column[0]) for column in result.description or ()])
            return Answer(names, result.fetchall())
        except (duckdb.Error, UnicodeError) as error:
            raise _not_understood(error, log) from None


def write_parquet(log: Anywhere, sql: str, path: Path) -> None:
    """Write a query's answer to a Parquet file.

    Raises
    ------
    InputError
        As :func:`ask`.
    """
    import duckdb
    import pyarrow.parquet as pq

    with connect(log, sql) as connection:
        try:
            _check(connection, sql)
            table = connection.sql(sql).to_arrow_table()
        except (duckdb.Error, UnicodeError) as error:
            raise _not_understood(error, log) from None
    pq.write_table(table.rename_columns(list(unique(table.column_names))), path, compression="zstd")


def _check(connection: duckdb.DuckDBPyConnection, sql: str) -> None:
    """Refuse all but one statement that only reads."""
    # 'explain analyze' would carry out what it explains, so it is not let in either; 'pivot' counts as several steps.
    sql.encode()  # DuckDB answers a text that is no UTF-8 with a TypeError, this with a UnicodeError
    statements = connection.extract_statements(sql)
    if len(statements) != 1:
        got = f"{len(statements)} statements" if statements else "none"
        raise InputError("SQL", "one query", got, "for example: select * from generations limit 3")
    kind = statements[0].type.name
    if kind not in READING:
        raise InputError("SQL", "a query that only reads", f"a statement of the type {kind}", "start with 'select'")


def unique(names: Sequence[str]) -> tuple[str, ...]:
    """Make column names differ, as DuckDB does in subqueries: the second ``a`` becomes ``a_1``."""
    taken = list(names)
    found: list[str] = []
    for name in names:
        fresh, number = name, 0
        while fresh in found or (number and fresh in taken):
            number += 1
            fresh = f"{name}_{number}"
        found.append(fresh)
    return tuple(found)


def _not_understood(error: Exception, log: Anywhere) -> InputError:
    # DuckDB wraps what Arrow says of a store that does not answer.
    if found := AWS.search(str(error)):
        return unreached(str(Store.open(log)), "a log that can be read", OSError(found.group()))
    return InputError("SQL", "a query that DuckDB can answer", _told(error), f"tables: {', '.join(TABLES)}")


def _told(error: Exception) -> str:
    lines = [" ".join(line.split()) for line in str(error).splitlines() if line.strip()]
    return one_line(" ".join(line for line in lines if not line.startswith(("LINE ", "^"))))


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
