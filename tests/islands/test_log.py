"""The log writer: frozen schemas, whole files, and every reader sees the same."""

from __future__ import annotations

import errno
import json
import os
from datetime import UTC, datetime
from zlib import crc32

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from archipelagos import island, ring, spec

from islands.individual import Evaluation
from islands.log import LogWriter
from islands.migration.channel import Channel
from islands.schemas import TABLES, VERSION, columns, schema
from islands.store import StoreError

NOON = datetime(2026, 1, 2, 12, 0, 0, tzinfo=UTC)


@pytest.fixture
def written(tmp_path):
    isles = [
        island(n, ring(2, Channel(0, "ring", count=2)), growth={"fail_ending": "11", "invert": n == 1}) for n in (0, 1)
    ]
    log = LogWriter(tmp_path, "test", [isle.spec for isle in isles], lambda: NOON)
    steps = [isle.begin() for isle in isles]
    for epoch in range(4):
        for isle, step in zip(isles, steps, strict=True):
            log.add(isle.spec.number, epoch, step.records)
        sent = [packet for step in steps for packet in step.departures]
        steps = [
            isle.advance(s.state, 2, [p for p in sent if p.target == isle.spec.number])
            for isle, s in zip(isles, steps, strict=True)
        ]
        if epoch == 2:
            log.flush()
    log.flush()
    return tmp_path


def test_columns_are_the_contract_s() -> None:
    assert columns("individuals") == (
        "run", "island", "species", "generation", "epoch", "id", "parents", "components", "partners", "origin",
        "genotype",
        "fitness", "scores", "valid", "error", "growth_ms", "evaluation_ms",
    )  # fmt: skip
    assert columns("evaluations") == (
        "run", "island", "generation", "epoch", "id", "reason", "fitness", "scores", "partners", "valid", "error",
        "evaluation_ms",
    )  # fmt: skip
    assert columns("generations") == (
        "run", "island", "species", "generation", "epoch", "evaluations", "best", "mean", "std", "worst", "diversity",
        "invalid", "wall_ms",
    )  # fmt: skip
    assert columns("migrations") == (
        "run", "island", "epoch", "channel", "kind", "source", "target", "id", "fitness", "accepted", "reason",
    )  # fmt: skip
    assert columns("events") == ("run", "island", "time", "epoch", "kind", "detail")


def test_files_are_named_by_epochs_and_islands_and_none_is_left_in_staging(written) -> None:
    for table in TABLES:
        names = sorted(path.name for path in (written / table).iterdir())
        expected = ["e000000-000002-i00000-00001.parquet", "e000003-000003-i00000-00001.parquet"]
        assert names == expected or (table in ("events", "evaluations") and names == expected[:1])
    assert not list((written / ".tmp").iterdir())


def test_files_hold_the_frozen_schema_zstd_dictionaries_and_split_floats(written) -> None:
    for table in TABLES:
        for path in (written / table).iterdir():
            file = pq.ParquetFile(path)
            assert file.schema_arrow.equals(schema(table), check_metadata=False)
            assert file.schema_arrow.metadata[b"atoll.schema"] == VERSION.encode()
            for group in range(file.metadata.num_row_groups):
                row_group = file.metadata.row_group(group)
                for index in range(row_group.num_columns):
                    column = row_group.column(index)
                    assert column.compression == "ZSTD"
                    if column.physical_type == "DOUBLE":
                        assert "BYTE_STREAM_SPLIT" in column.encodings
                    if column.path_in_schema in ("run", "island"):
                        assert "RLE_DICTIONARY" in column.encodings


def test_a_row_holds_what_the_record_held(written) -> None:
    rows = pq.ParquetFile(written / "individuals" / "e000000-000002-i00000-00001.parquet").read().to_pylist()
    isle = island(0, growth={"fail_ending": "11"})
    for row, record in zip(rows, isle.begin().records.born, strict=False):
        assert (row["run"], row["island"], row["species"]) == ("test", "isle-0", "bits")
        assert (row["id"], row["genotype"], row["fitness"]) == (record.id, record.genotype, record.fitness)
        assert tuple(row["scores"]) == record.scores
        assert row["valid"] == (record.fitness is not None) == (row["error"] == "")
    assert sum(not row["valid"] for row in rows) > 3
    again = pq.read_table(written / "evaluations" / "e000000-000002-i00000-00001.parquet").to_pylist()
    assert {row["reason"] for row in again} == {"migrant"}
    event = pq.read_table(written / "events" / "e000000-000002-i00000-00001.parquet").to_pylist()[0]
    assert event["kind"] == "repair"
    assert json.loads(event["detail"]).keys() == {"id", "labels"}
    assert event["time"] == NOON.replace(tzinfo=None)


def test_all_readers_agree_with_a_plain_glob(written) -> None:
    import duckdb
    import pandas as pd
    import polars as pl
    import pyarrow.dataset

    for table in TABLES:
        glob = str(written / table / "*.parquet")
        files = sorted((written / table).glob("*.parquet"))
        number = "epoch"
        (by_duckdb,) = duckdb.sql(f"select count(*), sum({number}) from read_parquet('{glob}')").fetchall()
        lazy = pl.read_parquet(glob)
        frame = pd.concat([pd.read_parquet(file) for file in files])
        whole = pyarrow.dataset.dataset(written / table).to_table()
        sums = {
            (lazy.height, lazy[number].sum()),
            (len(frame), frame[number].sum()),
            (whole.num_rows, pa.compute.sum(whole[number]).as_py()),
            by_duckdb,
        }
        assert len(sums) == 1
        assert frame["island"].isin(["isle-0", "isle-1"]).all()
        assert set(lazy["run"]) == {"test"}


def test_nothing_buffered_writes_nothing(tmp_path) -> None:
    assert LogWriter(tmp_path, "test", [spec()], lambda: NOON).flush() == []
    assert not list(tmp_path.iterdir())


def test_an_error_and_a_detail_that_are_no_utf_8_lose_nothing_of_the_log(tmp_path, monkeypatch) -> None:
    isle = island(0)
    given = Evaluation(None, error="rules: \udcff", notes=(("odd", {"why": "a\n\udcff", "how much": float("inf")}),))
    monkeypatch.setattr(isle.biology, "evaluate", lambda genotype: given)
    log = LogWriter(tmp_path, "test", [isle.spec], lambda: NOON)
    log.add(0, 0, isle.begin().records)
    log.tell(0, 0, "form", {"detail": "b\udcff"})
    assert len(log.flush()) == len(TABLES)
    assert set(pq.read_table(tmp_path / "individuals")["error"].to_pylist()) == {"rules: \\udcff"}
    details = [json.loads(text) for text in pq.read_table(tmp_path / "events")["detail"].to_pylist()]
    assert details[0] == {"id": 0, "why": "a \\udcff", "how much": "inf"}
    assert details[-1] == {"detail": "b\\udcff"}


def test_a_span_is_written_with_all_its_tables_or_not_at_all(tmp_path, monkeypatch) -> None:
    isle = island(0)
    log = LogWriter(tmp_path, "test", [isle.spec], lambda: NOON)
    log.add(0, 0, isle.begin().records)
    real, written = os.fsync, []

    def filling(number: int) -> None:
        written.append(number)
        if len(written) == 3:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        real(number)

    monkeypatch.setattr(os, "fsync", filling)
    with pytest.raises(StoreError, match="got no space left on device; make room on the disk"):
        log.flush()
    assert [path for path in tmp_path.rglob("*") if path.is_file()] == []
    # What could not be written is still there to be written.
    assert len(log.flush()) == len(TABLES)
    assert pq.read_table(tmp_path / "individuals").num_rows == isle.spec.population


def stepped(log: LogWriter, epochs, isle=None) -> None:
    """Log some epochs of an island that shows no events."""
    isle = isle or island(0)
    step = isle.begin()
    for epoch in range(max(epochs) + 1):
        if epoch in epochs:
            log.add(0, epoch, step.records)
        step = isle.advance(step.state, 1, [])


def test_it_tells_what_it_wrote_however_the_flushes_are_cut(tmp_path) -> None:
    log = LogWriter(tmp_path, "test", [spec()], lambda: NOON)
    assert log.files == ()
    stepped(log, range(9))
    for through in (1, 1, 4, 6):
        log.flush(through)
    epochs = ("000000-000001", "000002-000004", "000005-000006")
    names = [f"{table}/e{epochs[0]}-i00000-00000.parquet" for table in TABLES]
    names += [
        f"{table}/e{span}-i00000-00000.parquet" for span in epochs[1:] for table in ("individuals", "generations")
    ]
    assert [name for name, *_ in log.files] == names
    assert all((tmp_path / name).stat().st_size == size for name, size, _ in log.files)
    assert all(crc32((tmp_path / name).read_bytes()) == crc for name, _, crc in log.files)
    assert sorted(names) == sorted(str(path.relative_to(tmp_path)) for path in tmp_path.glob("*/*.parquet"))


def test_one_that_goes_on_writes_no_tables_without_rows(tmp_path) -> None:
    log = LogWriter(tmp_path, "test", [spec()], lambda: NOON, begun=True)
    stepped(log, [3])
    log.flush()
    assert [name.partition("/")[0] for name, *_ in log.files] == ["individuals", "generations"]


def test_events_told_after_their_epoch_never_take_the_place_of_others(tmp_path) -> None:
    names = []
    for begun in (False, True):
        log = LogWriter(tmp_path, "test", [spec()], lambda: NOON, begun=begun)
        if not begun:
            stepped(log, [2])
            log.flush()
        for kind in ("one", "two"):
            log.tell(0, 2, kind, {})
            log.flush()
        names += [name for name, *_ in log.files if "after" in name]
    ends = ("", "-2", "-3", "-4")
    assert names == [f"events/e000002-000002-i00000-00000-after{end}.parquet" for end in ends]
    kinds = [pq.read_table(tmp_path / name).column("kind").to_pylist() for name in names]
    assert kinds == [["one"], ["two"]] * 2
