"""The whole of a checkpoint: the newest that stands is found, and what does not belong to it goes."""

from __future__ import annotations

import json
from dataclasses import replace
from datetime import UTC, datetime
from zlib import crc32

import pytest
from archipelagos import island, spec
from buckets import reaching, serving
from hypothesis import given, settings
from hypothesis import strategies as st

from genome.errors import InputError
from islands.checkpoint import Kept, write_part
from islands.holdings import NOTHING
from islands.log import Event, LogFile, LogWriter, events_table, write
from islands.records import Born, Generation, Records
from islands.state import State
from islands.store import Store, StoreError
from orchestrator.checkpoints import Checkpoint, ForeignError, check, complete, log_of, newest, read
from orchestrator.cutting import cut_log, prune, roll_back

NOON = datetime(2026, 1, 2, 12, 0, 0, tzinfo=UTC)
RUN, SEED = "test", 7


@pytest.fixture(scope="module")
def endpoint():
    with serving() as url, reaching(url):
        yield url


@pytest.fixture
def store(tmp_path) -> Store:
    return Store.open(tmp_path)


@pytest.fixture(params=["disk", "s3"])
def any_store(request, tmp_path) -> Store:
    if request.param == "disk":
        return Store.open(tmp_path)
    request.getfixturevalue("endpoint")
    return Store.open(f"s3://bucket/{tmp_path.name}")


class Driver:
    """Two hosts that log each epoch, and what the driver does at some: writes a checkpoint, or tells of an event."""

    def __init__(self, store: Store, before: Checkpoint | None = None) -> None:
        self.store, self.before = store, before
        self.folder = store.local / "log"
        self.events = 0 if before is None else before.events
        self.logs = [
            LogWriter(self.folder, RUN, [spec(host)], lambda: NOON, begun=before is not None) for host in range(2)
        ]

    def log(self, epoch: int) -> None:
        for host, log in enumerate(self.logs):
            born = Born(0, epoch, epoch, (), (), (), "random", f"word {host} {epoch}", 1.0, (), "", 0.0, 0.0)
            row = Generation(epoch, epoch, 1, None, None, None, None, None, 0, 0.0)
            log.add(host, epoch, Records(born=(born,), generations=(row,)))

    def tell(self, kind: str) -> None:
        event = Event(None, NOON, 0, kind, {})
        write(self.folder, "events", f"run-{self.events:04d}", events_table(RUN, [event]))
        self.events += 1

    def parts(self, epoch: int):
        state = State((), epoch, epoch, 0, None, 0, NOTHING, "key")
        kept = [Kept(island(number), state, (), None) for number in range(2)]
        return tuple(write_part(self.store, epoch, host, [one]) for host, one in enumerate(kept))

    def checkpoint(self, epoch: int, **changes) -> Checkpoint:
        for log in self.logs:
            log.flush(epoch)
        files = log_of(self.before, [log.files for log in self.logs])
        made = Checkpoint(RUN, SEED, epoch, self.parts(epoch), files, self.events, 1, {"told": [1, "x"]})
        made = replace(made, **changes)
        complete(self.store, made)
        return made


def history(store: Store, checkpoints=(1, 3, 5), last: int = 6) -> list[Checkpoint]:
    """A run that was killed at epoch ``last``, its log as far as that flushed."""
    driver = Driver(store)
    driver.tell("start")
    made = []
    for epoch in range(last + 1):
        driver.log(epoch)
        if epoch in checkpoints:
            made.append(driver.checkpoint(epoch))
            driver.tell("later")
    for log in driver.logs:
        log.flush(last)
    return made


def logged(store: Store) -> set[str]:
    log = store.at("log")
    return {f"{table}/{name}" for table in log.folders() for name in log.names(table)}


def files_of(checkpoint: Checkpoint) -> set[str]:
    return {name for name, *_ in checkpoint.log} | {f"events/run-{n:04d}.parquet" for n in range(checkpoint.events)}


def test_the_newest_is_found_with_all_that_it_holds(store) -> None:
    assert newest(store, RUN, SEED) == (None, ())
    made = history(store)
    assert newest(store, RUN, SEED) == (made[-1], ())
    assert store.names("checkpoints") == ["e000001.json", "e000003.json", "e000005.json"]
    assert made[0].log == tuple(
        LogFile(name, len(content), crc32(content))
        for table in ("evaluations", "events", "generations", "individuals", "migrations")
        for name in (f"{table}/e000000-000001-i0000{host}-0000{host}.parquet" for host in range(2))
        for content in (store.read(f"log/{name}"),)
    )
    assert {name for name, *_ in made[1].log} - {name for name, *_ in made[0].log} == {
        f"{table}/e000002-000003-i0000{host}-0000{host}.parquet"
        for table in ("generations", "individuals") for host in range(2)
    }  # fmt: skip


JSON = "checkpoints/e000005.json"
PART = "checkpoints/e000005/host-00001.parquet"
LOG = "log/individuals/e000004-000005-i00001-00001.parquet"


def cut(content: bytes) -> bytes:
    return content[:-1] if content else b""


def gone(content: bytes) -> None:
    return None


def turned(place: int):
    return lambda content: content[:place] + bytes([content[place] ^ 1]) + content[place:][1:]


@pytest.mark.parametrize(
    ("name", "spoil", "said"),
    [
        (JSON, lambda content: content[:-2], f"{JSON}: expected a checkpoint's JSON, got what is none ("),
        (JSON, lambda content: b"", f"{JSON}: expected a checkpoint's JSON, got what is none ("),
        (JSON, lambda content: b"\xff", f"{JSON}: expected a checkpoint's JSON, got what is none ("),
        (JSON, lambda content: b"[]", f"{JSON}: expected keys and values, got []"),
        (JSON, lambda content: content.replace(b'"epoch":5', b'"epoch":4'), f"{JSON}: expected content of the sha256 "),
        (JSON, lambda content: content.replace(b'"told":[1', b'"told":[2'), f"{JSON}: expected content of the sha256 "),
        (JSON, lambda content: content.replace(b'"events":3,', b""), f"{JSON}: events: expected a value for 'events'"),
        (PART, cut, f"{PART}: expected a part of a checkpoint, "),
        (PART, turned(70), f"{PART}: expected the sha256 "),
        (PART, gone, f"{PART}: expected a part of a checkpoint, "),
        (LOG, cut, f"{LOG}: expected a file of "),
        (LOG, gone, f"{LOG}: expected a file of "),
        *((LOG, turned(place), f"{LOG}: expected content of the CRC-32 ") for place in (4, 30, 99, 500, -600, -12)),
        (LOG, turned(1), f"{LOG}: expected a whole Parquet file, got one that lacks its beginning or its end"),
        (LOG, turned(-4), f"{LOG}: expected a whole Parquet file, got one that lacks its beginning or its end"),
        (LOG, turned(-5), f"{LOG}: expected a whole Parquet file, got one that lacks its beginning or its end"),
        ("log/events/run-0002.parquet", gone, "log/events/run-0002.parquet: expected a file of the checkpoint of epo"),
        ("log/events/run-0002.parquet", lambda content: b"PAR1", "log/events/run-0002.parquet: expected a whole Parq"),
    ],
)  # fmt: skip
def test_one_that_is_damaged_falls_back_to_the_one_before_with_the_reason(store, name, spoil, said) -> None:
    made = history(store)
    spoilt = spoil(store.read(name))
    assert spoilt != store.read(name)
    if spoilt is None:
        store.remove(name)
    else:
        store.write(name, spoilt)
    found, reasons = newest(store, RUN, SEED)
    assert found == made[1]
    assert [reason[: len(said)] for reason in reasons] == [said]
    check(store, found)


def test_a_file_under_the_name_of_another_epoch_does_not_stand(store) -> None:
    made = history(store)
    store.write("checkpoints/e000009.json", store.read(JSON))
    found, reasons = newest(store, RUN, SEED)
    expected = "checkpoints/e000009.json: expected the checkpoint of epoch 9, got that of epoch 5"
    assert (found, reasons) == (made[-1], (expected,))


def test_without_any_that_stands_all_reasons_are_told_newest_first(store) -> None:
    history(store)
    store.remove("log/migrations/e000000-000001-i00000-00000.parquet")
    found, reasons = newest(store, RUN, SEED)
    assert found is None
    size = "log/migrations/e000000-000001-i00000-00000.parquet: expected a file of "
    assert [(reason.startswith(size), reason[-20:]) for reason in reasons] == [
        (True, f"t of epoch {epoch}, got none"[-20:]) for epoch in (5, 3, 1)
    ]


@pytest.mark.parametrize(
    ("changes", "run", "said"),
    [
        ({"run": "other"}, RUN, "expected a checkpoint of the run test, seed 7, got one of other, seed 7; it was put "),
        ({"seed": 8}, RUN, "expected a checkpoint of the run test, seed 7, got one of test, seed 8; it was put there"),
    ],
)
def test_one_of_another_run_is_refused_and_nothing_is_thrown_away(store, changes, run, said) -> None:
    Driver(store).checkpoint(1)
    Driver(store).checkpoint(4, **changes)
    with pytest.raises(ForeignError) as caught:
        newest(store, run, SEED)
    assert str(caught.value).startswith(f"checkpoints/e000004.json: {said}")


def test_one_of_another_version_is_refused_whatever_else_it_holds(store) -> None:
    history(store)
    store.write(JSON, json.dumps({"version": "9", "islands": []}).encode())
    with pytest.raises(ForeignError) as caught:
        newest(store, RUN, SEED)
    expected = "expected a checkpoint of version 2, got one of version 9; go on with the Atoll that wrote it"
    assert str(caught.value) == f"{JSON}: {expected}"


def test_a_store_that_gives_no_answer_is_no_damage(store, monkeypatch) -> None:
    history(store)

    def silent(self, name):
        raise StoreError(name, "a file that can be read", "no answer")

    monkeypatch.setattr(type(store), "read", silent)
    for ask in (lambda: newest(store, RUN, SEED), lambda: prune(store, 1)):
        with pytest.raises(StoreError):
            ask()
    assert len(store.names("checkpoints")) == 3


def test_two_of_many_are_kept_and_what_was_never_whole_goes(any_store, tmp_path) -> None:
    disk = Store.open(tmp_path)
    history(disk, checkpoints=range(6))
    driver = Driver(disk)
    disk.remove("checkpoints/e000002.json")
    disk.write("checkpoints/e000004.json", disk.read("checkpoints/e000004.json")[:-9])
    driver.parts(7)
    if any_store.local is None:
        for path in sorted((tmp_path / "checkpoints").rglob("*.*")):
            any_store.write(str(path.relative_to(tmp_path)), path.read_bytes())
    assert prune(any_store, 2) == (0, 1, 2, 4)
    assert any_store.names("checkpoints") == ["e000003.json", "e000005.json"]
    assert any_store.folders("checkpoints") == ["e000003", "e000005", "e000007"]
    assert prune(any_store, 2) == ()
    assert prune(any_store, 1) == (3,)
    assert prune(any_store, 1) == ()
    assert any_store.names("checkpoints") == ["e000005.json"]
    with pytest.raises(ValueError, match="at least one"):
        prune(any_store, 0)


def test_the_only_whole_one_is_never_pruned(store) -> None:
    made = history(store)
    for epoch in (3, 5):
        store.remove(f"checkpoints/e00000{epoch}/host-00000.parquet")
    assert prune(store, 1) == ()
    assert newest(store, RUN, SEED)[0] == made[0]
    store.remove("checkpoints/e000001.json")
    assert prune(store, 1) == ()
    assert store.folders("checkpoints") == ["e000001", "e000003", "e000005"]


def test_pruning_that_is_broken_off_leaves_nothing_that_seems_whole(store, monkeypatch) -> None:
    made = history(store)

    def dies(self, folder=""):
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(type(store), "remove_tree", dies)
        with pytest.raises(KeyboardInterrupt):
            prune(store, 1)
    assert store.names("checkpoints") == ["e000003.json", "e000005.json"]
    assert store.folders("checkpoints") == ["e000001", "e000003", "e000005"]
    assert prune(store, 1) == (1, 3)
    assert newest(store, RUN, SEED) == (made[-1], ())


@pytest.mark.parametrize("place", [None, 0, 1, 2])
def test_the_log_is_cut_to_exactly_what_belongs_to_a_checkpoint(store, place) -> None:
    made = history(store)
    whole = logged(store)
    store.write("log/.tmp/individuals-e000007.parquet", b"half")
    store.write("log/individuals/notes.txt", b"somebody's")
    checkpoint = None if place is None else made[place]
    kept = set() if checkpoint is None else files_of(checkpoint)
    assert kept < whole
    removed = cut_log(store, checkpoint)
    assert (set(removed), list(removed)) == (whole - kept, sorted(removed))
    assert logged(store) == kept | {"individuals/notes.txt"}
    assert not (store.local / "log" / ".tmp").exists()
    if checkpoint is not None:
        check(store, checkpoint)
    assert cut_log(store, checkpoint) == ()
    with pytest.raises(InputError, match=r"log/.*: expected a file"):
        check(store, made[2] if place != 2 else replace(made[2], events=9))


def test_events_of_the_run_may_outlive_the_cut(store) -> None:
    made = history(store)
    cut_log(store, made[0], keep_run_events=True)
    assert logged(store) == files_of(made[0]) | {f"events/run-000{number}.parquet" for number in range(4)}
    cut_log(store, None, keep_run_events=True)
    assert logged(store) == {f"events/run-000{number}.parquet" for number in range(4)}


def test_a_run_that_is_rolled_back_and_goes_on_has_each_row_once(store) -> None:
    import pyarrow.dataset as ds

    made = history(store)
    store.write("checkpoints/.e000007.json.1234.tmp", b"{")
    store.write(".experiment.yaml.5678.tmp", b"na")
    store.write(".lock", b"")
    roll_back(store, made[1])
    assert store.names("checkpoints", hidden=True) == ["e000001.json", "e000003.json"]
    assert store.names(hidden=True) == [".lock"]
    assert newest(store, RUN, SEED) == (made[1], ())
    assert store.folders("checkpoints") == ["e000001", "e000003"]
    again = Driver(store, made[1])
    for epoch in range(4, 9):
        again.log(epoch)
        if epoch == 7:
            then = again.checkpoint(epoch)
    for log in again.logs:
        log.flush()
    assert newest(store, RUN, SEED) == (then, ())
    assert files_of(made[1]) < files_of(then)
    rows = ds.dataset(store.local / "log" / "individuals").to_table().to_pylist()
    assert sorted((row["island"], row["epoch"]) for row in rows) == [
        (f"isle-{host}", epoch) for host in range(2) for epoch in range(9)
    ]
    assert store.names("log/migrations") == [
        "e000000-000001-i00000-00000.parquet",
        "e000000-000001-i00001-00001.parquet",
    ]
    whole = tuple(sorted(logged(store)))
    assert (roll_back(store, None), logged(store)) == (whole, set())
    assert (newest(store, RUN, SEED), store.folders("checkpoints")) == ((None, ()), [])


def test_rolling_back_takes_checkpoints_before_the_log_that_they_list(store, monkeypatch) -> None:
    made = history(store)

    def dies(self, name):
        if not name.endswith(".json"):
            raise KeyboardInterrupt
        real(self, name)

    real = type(store).remove
    with monkeypatch.context() as patched:
        patched.setattr(type(store), "remove", dies)
        with pytest.raises(KeyboardInterrupt):
            roll_back(store, made[0])
    assert newest(store, RUN, SEED) == (made[0], ())
    roll_back(store, made[0])
    assert logged(store) == files_of(made[0])


def test_a_checkpoint_needs_each_island_once(store) -> None:
    driver = Driver(store)
    part, other = driver.parts(1)
    for parts in ((), (part, part), (part, replace(other, islands=(1, 0)))):
        with pytest.raises(ValueError, match="needs each island in one part"):
            complete(store, Checkpoint(RUN, SEED, 1, parts, ()))
    assert store.names("checkpoints") == []
    with pytest.raises(ValueError, match="two log files have the name b"):
        log_of(None, [[LogFile("a", 1, 0)], [LogFile("b", 1, 0), LogFile("b", 2, 0)]])


FACTS = st.dictionaries(
    st.text(), st.recursive(st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False)
                            | st.text(), lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner)), max_size=4
)  # fmt: skip


@settings(max_examples=40, deadline=None)
@given(st.text(min_size=1), st.integers(0, 2**70), st.integers(0, 2**31), FACTS)
def test_whatever_is_written_is_read(tmp_path_factory, run, seed, epoch, facts) -> None:
    store = Store.open(tmp_path_factory.mktemp("run"))
    part = write_part(store, 0, 3, [Kept(island(4), State((), 0, 0, 0), (), None)])
    made = Checkpoint(run, seed, epoch, (part,), (LogFile("events/é.parquet", 5, 2**32 - 1),), 2, 3, facts)
    complete(store, made)
    assert read(store, epoch) == made
