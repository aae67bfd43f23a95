"""The log writer: turns records into Parquet, file by file, so that every file in a table's folder is whole.

On a disk, a file is written under ``log/.tmp/`` and moved into its table's folder when complete; in a bucket it is
there when it is whole. Its name comes from the epochs and islands that it covers, so that the same run makes the same
names.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from datetime import datetime
from itertools import chain
from typing import TYPE_CHECKING, Any, Final, NamedTuple, final
from zlib import crc32

from genome.mishaps import plain
from islands.records import Records
from islands.schemas import TABLES, schema, stored
from islands.spec import IslandSpec
from islands.store import Anywhere, Store, StoreError

if TYPE_CHECKING:
    import pyarrow as pa

Calendar = Callable[[], datetime]
"""Gives the time of day in UTC; passed in."""


ALL: Final = 2**63 - 1
"""Later than any epoch."""


class Event(NamedTuple):
    """A row of the events table; ``island`` and ``epoch`` are ``None`` for what concerns the whole run."""

    island: str | None
    time: datetime
    epoch: int | None
    kind: str
    detail: dict[str, Any]


class LogFile(NamedTuple):
    """A file that was written: its name in the ``log`` folder, its size in bytes, and the CRC-32 of its content."""

    name: str
    bytes: int
    crc: int


@final
class LogWriter:
    """Buffers the records of some islands and writes them.

    Parameters
    ----------
    folder
        The run's ``log`` folder, in any store; its tables' folders are made when first written to.
    run
        The run's name.
    islands
        The islands whose records will come; their numbers are in the files' names.
    calendar
        Stamps events.
    begun
        Whether each table has a file already, as in a run that goes on from a checkpoint.
    """

    def __init__(
        self, folder: Anywhere, run: str, islands: Sequence[IslandSpec], calendar: Calendar, *, begun: bool = False
    ) -> None:
        self._folder = Store.open(folder)
        self._run = run
        self._islands = {spec.number: spec for spec in islands}
        self._calendar = calendar
        self._buffer: list[tuple[int, int, Records]] = []
        self._events: list[Event] = []
        self._files: list[LogFile] = []
        self._begun = begun

    @property
    def files(self) -> tuple[LogFile, ...]:
        """What it has written, in order."""
        return tuple(self._files)

    def add(self, island: int, epoch: int, records: Records) -> None:
        """Take the records of one island in one epoch."""
        self._buffer.append((epoch, island, records))
        if records.notes:
            now = self._calendar()
            name = self._islands[island].name
            self._events.extend(Event(name, now, note.epoch, note.kind, note.detail) for note in records.notes)

    def tell(self, island: int, epoch: int, kind: str, detail: dict[str, Any]) -> None:
        """Take an event of one island."""
        self._events.append(Event(self._islands[island].name, self._calendar(), epoch, kind, detail))

    def flush(self, through: int = ALL) -> list[str]:
        """Write what is buffered, one file for each table that has rows; give the files' names in the folder.

        The first time each table gets its file, with rows or without, so that a plain glob finds every table. Each
        epoch's records come in one piece; only events may be told of an epoch that is written already, and then they
        stand in a file of their own.

        Parameters
        ----------
        through
            The last epoch to write; what comes after it stays in the buffer.
        """
        parts = sorted((part for part in self._buffer if part[0] <= through), key=lambda part: part[:2])
        events = [event for event in self._events if (event.epoch or 0) <= through]
        if not parts and not events:
            return []
        epochs = [epoch for epoch, _, _ in parts] or [event.epoch or 0 for event in events]
        span = f"e{min(epochs):06d}-{max(epochs):06d}-i{min(self._islands):05d}-{max(self._islands):05d}"
        if not parts:
            span = self._free(f"{span}-after")
        tables = {name: self._table(name, parts) for name in TABLES if name != "events"}
        tables["events"] = events_table(self._run, events)
        wanted = {name: table for name, table in tables.items() if table.num_rows or not self._begun}
        files = self._written(span, wanted)
        self._buffer = [part for part in self._buffer if part[0] > through]
        self._events = [event for event in self._events if (event.epoch or 0) > through]
        self._files.extend(files)
        self._begun = True
        return [file.name for file in files]

    def _free(self, span: str) -> str:
        """Give the span, or with a number after it where a file of events has it: one that a checkpoint may list."""
        found, number = span, 2
        while self._folder.exists(f"events/{found}.parquet"):
            found, number = f"{span}-{number}", number + 1
        return found

    def _written(self, span: str, tables: Mapping[str, pa.Table]) -> list[LogFile]:
        """Write the files of one span, all or none: what is written later may cover its epochs under another name."""
        files: list[LogFile] = []
        try:
            for name, table in tables.items():
                files.append(write(self._folder, name, span, table))
        except BaseException:
            for file in files:
                with suppress(StoreError):
                    self._folder.remove(file.name)
            raise
        return files

    def warm(self) -> None:
        """Import what writing needs, so that no epoch has to wait for it: some of it comes with the first table."""
        import pyarrow.parquet as pq

        del pq
        for name in TABLES:
            if name != "events":
                self._table(name, ())
        events_table(self._run, ())

    def drop(self) -> None:
        """Forget what is buffered."""
        self._buffer, self._events = [], []

    def _table(self, name: str, parts: Sequence[tuple[int, int, Records]]) -> pa.Table:
        make = {
            "individuals": _individuals,
            "evaluations": _evaluations,
            "generations": _generations,
            "migrations": _migrations,
        }[name]
        attribute = {
            "individuals": "born", "evaluations": "rescored", "generations": "generations", "migrations": "crossings"
        }[name]  # fmt: skip
        rows = list(chain.from_iterable(getattr(records, attribute) for _, _, records in parts))
        specs = [self._islands[island] for _, island, records in parts for _ in getattr(records, attribute)]
        return make(self._run, rows, specs)


def write(folder: Anywhere, table_name: str, stem: str, table: pa.Table) -> LogFile:
    """Write one Parquet file whole or not at all; give what was written."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    dictionary, split = stored(table_name)
    content = pa.BufferOutputStream()
    pq.write_table(
        table,
        content,
        compression="zstd",
        use_dictionary=dictionary,
        use_byte_stream_split=split,
        write_page_checksum=True,
    )
    name = f"{table_name}/{stem}.parquet"
    written = content.getvalue().to_pybytes()
    Store.open(folder).write(name, written, staging=".tmp")
    return LogFile(name, len(written), crc32(written))


def events_table(run: str, events: Sequence[Event]) -> pa.Table:
    """Make the events table of some events."""
    import pyarrow as pa

    return _build(
        "events",
        len(events),
        run=run,
        island=_names([event.island for event in events]),
        time=pa.array([event.time.replace(tzinfo=None) for event in events], pa.timestamp("us")),
        epoch=[event.epoch for event in events],
        kind=_names([event.kind for event in events]),
        detail=[json.dumps(plain(event.detail), sort_keys=True, allow_nan=False) for event in events],
    )


def _individuals(run: str, rows: Sequence[Any], specs: Sequence[IslandSpec]) -> pa.Table:
    (generation, epoch, identity, parents, components, partners, origin, genotype, fitness, scores, error, growth,
     evaluation) = _transposed(rows, 13)  # fmt: skip
    return _build(
        "individuals",
        len(rows),
        run=run,
        island=_names([spec.name for spec in specs]),
        species=_names([spec.species for spec in specs]),
        generation=generation,
        epoch=epoch,
        id=identity,
        parents=_id_lists(parents),
        components=_id_lists(components),
        partners=_id_lists(partners),
        origin=_names(origin),
        genotype=genotype,
        fitness=fitness,
        scores=_score_maps(scores),
        valid=[value is not None for value in fitness],
        error=error,
        growth_ms=growth,
        evaluation_ms=evaluation,
    )


def _evaluations(run: str, rows: Sequence[Any], specs: Sequence[IslandSpec]) -> pa.Table:
    generation, epoch, identity, reason, fitness, scores, partners, error, evaluation = _transposed(rows, 9)
    return _build(
        "evaluations",
        len(rows),
        run=run,
        island=_names([spec.name for spec in specs]),
        generation=generation,
        epoch=epoch,
        id=identity,
        reason=_names(reason),
        fitness=fitness,
        scores=_score_maps(scores),
        partners=_id_lists(partners),
        valid=[value is not None for value in fitness],
        error=error,
        evaluation_ms=evaluation,
    )


def _generations(run: str, rows: Sequence[Any], specs: Sequence[IslandSpec]) -> pa.Table:
    names = ("generation", "epoch", "evaluations", "best", "mean", "std", "worst", "diversity", "invalid", "wall_ms")
    return _build(
        "generations",
        len(rows),
        run=run,
        island=_names([spec.name for spec in specs]),
        species=_names([spec.species for spec in specs]),
        **dict(zip(names, _transposed(rows, len(names)), strict=True)),
    )


def _migrations(run: str, rows: Sequence[Any], specs: Sequence[IslandSpec]) -> pa.Table:
    epoch, channel, kind, source, target, identity, fitness, accepted, reason = _transposed(rows, 9)
    return _build(
        "migrations",
        len(rows),
        run=run,
        island=_names([spec.name for spec in specs]),
        epoch=epoch,
        channel=_names(channel),
        kind=_names(kind),
        source=_names(source),
        target=_names(target),
        id=identity,
        fitness=fitness,
        accepted=accepted,
        reason=reason,
    )


def _transposed(rows: Sequence[Any], width: int) -> Iterable[Sequence[Any]]:
    return zip(*rows, strict=True) if rows else ((),) * width


def _build(table: str, rows: int, run: str, **columns: Any) -> pa.Table:  # noqa: ANN401 - arrays or lists
    import pyarrow as pa

    form = schema(table)
    columns["run"] = _names([run] * rows)
    arrays = []
    for column in form:
        values = columns[column.name]
        arrays.append(values if isinstance(values, pa.Array) else pa.array(values, column.type))
    return pa.Table.from_arrays(arrays, schema=form)


def _names(values: Sequence[str | None]) -> pa.Array:
    import pyarrow as pa

    return pa.array(values, pa.string()).dictionary_encode()


def _offsets(lists: Sequence[Sequence[Any]]) -> pa.Array:
    import numpy as np
    import pyarrow as pa

    offsets = np.zeros(len(lists) + 1, dtype=np.int32)
    np.cumsum([len(values) for values in lists], out=offsets[1:])
    return pa.array(offsets, pa.int32())


def _id_lists(lists: Sequence[Sequence[int]]) -> pa.Array:
    import pyarrow as pa

    values = pa.array(list(chain.from_iterable(lists)), pa.int64())
    return pa.ListArray.from_arrays(_offsets(lists), values)


def _score_maps(lists: Sequence[Sequence[tuple[str, float]]]) -> pa.Array:
    import pyarrow as pa

    pairs = list(chain.from_iterable(lists))
    keys: Final = pa.array([key for key, _ in pairs], pa.string())
    items: Final = pa.array([value for _, value in pairs], pa.float64())
    kind = schema("individuals").field("scores").type
    return pa.MapArray.from_arrays(_offsets(lists), keys, items, type=kind)
