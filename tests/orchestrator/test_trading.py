"""A run with every kind of channel: all that was sent is accepted or rejected, and all replay as they were scored."""

from __future__ import annotations

import inspect
import itertools
import json
import re
import sys
from collections import Counter
from pathlib import Path

import pytest
from click.testing import CliRunner
from hosts import run_on_threads
from traders import judging, trading

from experiments import run, write
from genome.errors import InputError
from islands.individual import home_of
from orchestrator.cli import main
from orchestrator.folder import open_run
from orchestrator.query import as_rows, ask
from orchestrator.regrow import Nursery, by_id, same
from orchestrator.standing import standing

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    outcome = run(tmp_path_factory.mktemp("trading"), trading())
    assert outcome.status == "finished"
    return open_run(str(outcome.folder))


def documented_query() -> str:
    text = (ROOT / "docs" / "formats" / "experiment.md").read_text(encoding="utf-8")
    (sql,) = re.findall(r"```sql\n(select channel,.*?)```", text, re.DOTALL)
    return sql


def test_the_documented_query_shows_that_what_was_sent_was_accepted_or_rejected(folder) -> None:
    rows = as_rows(ask(folder.log, documented_query()))
    for row in rows:
        assert row["sent"] == row["accepted"] + row["rejected"]
        assert (row["rejected"] == 0) == (row["reasons"] in (None, []))
    # Edges, times what travels on each at a time, times the sendings that can arrive in five epochs.
    sent = {row["channel"]: row["sent"] for row in rows}
    assert sent == {
        "migrants-0": 2 * 2 * 4,  # not at the end of epoch 0
        "partners-1": 4 * 2 * 5,
        "partners-2": 2 * 1 * 3,  # at the ends of epochs 0, 2 and 4
        "components-3": 2 * 3 * 5,
        "surroundings-4": 1 * 1 * 5,
        "migrants-5": 1 * 3 * 4,
        "surroundings-6": 1 * 2 * 3,
    }


def test_counts_hold_per_edge_and_epoch_too(folder) -> None:
    rows = ask(folder.log, "select channel, source, target, epoch from migrations").rows
    each = {"migrants-0": 2, "partners-1": 2, "partners-2": 1, "components-3": 3, "surroundings-4": 1, "migrants-5": 3}
    for (channel, *_), count in Counter(rows).items():
        assert count == each.get(channel, 2)


def test_the_standing_counts_migrants_alone(folder) -> None:
    told = {row["island"]: row["migrants"] for row in standing(folder)["islands"]}
    sql = "select target, count(*) from migrations where channel like 'migrants-%' and accepted group by 1"
    assert {island: count for island, count in told.items() if count} == dict(ask(folder.log, sql).rows)


def everyone(folder) -> list[int]:
    return [identity for (identity,) in ask(folder.log, "select id from individuals order by id").rows]


def replayed(folder) -> list[bool]:
    nursery = Nursery(folder)
    return [same(logged, nursery.score(logged)) for logged in by_id(folder, everyone(folder))]


def test_every_individual_replays_among_the_forms_and_with_the_partners_that_it_had(folder) -> None:
    assert all(replayed(folder))
    # And that says something: alone, most of these would score otherwise.
    nursery = Nursery(folder)
    sql = "select id from individuals where epoch = 5 and valid and island in ('host-0', 'skin', 'pelt') order by id"
    late = by_id(folder, [identity for (identity,) in ask(folder.log, sql).rows])
    alone = [nursery.biology(one.island).evaluate(nursery.biology(one.island).decode(one.genotype)) for one in late]
    assert sum(not same(one, found) for one, found in zip(late, alone, strict=True)) > len(late) / 2


@pytest.mark.parametrize(
    "pairing",
    [
        {"pairing": "random", "pairings": 2, "score": "best"},
        {"pairing": "archive", "pairings": 4, "archive": 5, "score": "worst"},
        {"pairing": "best", "select": "random", "weight": 0.4},
    ],
)
def test_every_pairing_replays(tmp_path, pairing) -> None:
    data = trading(epochs=4)
    data["channels"][1] = {"kind": "partners", "from": "guest", "to": "host", "count": 2, **pairing}
    data["channels"].append({"kind": "partners", "topology": "random", "among": "host", "name": "own"})
    data["islands"]["guest"]["growth"] = {"fail_ending": "1"}
    found = open_run(str(run(tmp_path, data).folder))
    assert all(replayed(found))
    partners = [row for (row,) in ask(found.log, "select partners from individuals where island = 'host-1'").rows]
    assert {len(row) for row in partners} <= {0, 2, 4, 6, 8}
    assert any(partners)
    for row in partners:
        assert all(home_of(one) in (2, 3) for one in row[::2])
        assert all(home_of(one) in (0, 1) for one in row[1::2])


SHOWN = [
    {"pairing": "random", "pairings": 3, "count": 3, "every": 2},
    {"pairing": "best", "weight": 0.5},
    {"pairing": "several", "pairings": 3, "count": 2, "score": "best"},
    {"pairing": "archive", "pairings": 4, "archive": 6, "weight": 0.4, "select": "random", "count": 2},
]


@pytest.mark.parametrize("pairing", SHOWN)
def test_partners_replay_as_they_were_shown_then(tmp_path, pairing) -> None:
    found = open_run(str(run(tmp_path, judging(pairing)).folder))
    assert all(replayed(found))
    # One id is shown from several islands and among several forms.
    sql = "select count(distinct source), count(distinct epoch) from migrations where kind = 'partners' group by id"
    rows = ask(found.log, sql).rows
    assert any(sources > 1 for sources, _ in rows)
    assert any(epochs > 1 for _, epochs in rows)


@pytest.mark.parametrize("pairing", SHOWN)
def test_partners_replay_where_packets_came_late_and_several_at_once(tmp_path, pairing) -> None:
    # No checkpoint, since hosts wait there for all that is on its way.
    data = judging(pairing, epochs=25, checkpoint={"every": 99})
    for seed in range(9):
        (tmp_path / str(seed)).mkdir()
        log, _ = run_on_threads(tmp_path / str(seed), write(tmp_path, data), 4, "schedule=async", storm=seed)
        found = open_run(str(log.parent))
        assert all(replayed(found))
        sql = "select detail from events where kind = 'arrivals'"
        came = [json.loads(detail)["packets"] for (detail,) in ask(log, sql).rows]
        ways = [Counter((channel, source) for channel, source, _, size in packets if size) for packets in came]
        if any(count > 1 for way in ways for (channel, _), count in way.items() if channel != 1):
            return
    pytest.fail("no two packets of one edge came at once")


def test_a_log_of_async_without_its_arrivals_is_told(tmp_path) -> None:
    data = judging(SHOWN[1])
    log, _ = run_on_threads(tmp_path, write(tmp_path, data), 2, "schedule=async", storm=1)
    sql = "select id from individuals where len(partners) > 0 order by id desc limit 1"
    ((identity,),) = ask(log, sql).rows
    for path in (log / "events").iterdir():
        path.unlink()
    folder = open_run(str(log.parent))
    with pytest.raises(InputError, match="--id: expected a log with the arrivals of a run of schedule async, got none"):
        Nursery(folder).score(by_id(folder, [identity])[0])


def test_a_chain_of_surroundings_as_long_as_the_run_replays(tmp_path) -> None:
    channels = [{"kind": "surroundings", "from": one, "to": two} for one, two in (("skin", "pelt"), ("pelt", "skin"))]
    islands = {name: {"kind": "traders:SkinKind", "population": 2} for name in ("skin", "pelt")}
    data = trading(epochs=300, epoch=1, islands=islands, channels=channels)
    found = open_run(str(run(tmp_path, data).folder))
    ((last,),) = ask(found.log, "select max(id) from individuals").rows
    (logged,) = by_id(found, [last])
    assert logged.epoch == 300
    limit = sys.getrecursionlimit()
    sys.setrecursionlimit(len(inspect.stack()) + 200)
    try:
        assert same(logged, Nursery(found).score(logged))
    finally:
        sys.setrecursionlimit(limit)


def test_packets_of_different_sizes_replay(tmp_path) -> None:
    data = trading()
    data["islands"]["skin"]["growth"] = {"fail_ending": "0"}  # forms of invalid members are not sent
    data["islands"]["skin"]["algorithm"] = {"elite": 0, "tournament": 1, "mutation": 1.0}
    data["channels"][6] |= {"count": 8, "every": 1}
    found = open_run(str(run(tmp_path, data).folder))
    sql = "select count(*) from migrations where channel = 'surroundings-6' group by epoch order by epoch"
    sizes = [size for (size,) in ask(found.log, sql).rows]
    assert any(later < size for size, later in itertools.pairwise(sizes))
    assert all(replayed(found))


def test_partners_that_a_killed_run_s_log_lacks_are_told(folder, tmp_path) -> None:
    import shutil

    shutil.copytree(folder.path, tmp_path / "killed")
    for path in (tmp_path / "killed" / "log" / "migrations").iterdir():
        path.unlink()
    killed = open_run(str(tmp_path / "killed"))
    sql = "select id from individuals where len(partners) > 1 order by id limit 1"
    logged = by_id(killed, [ask(killed.log, sql).rows[0][0]])[0]
    with pytest.raises(InputError, match="--id: expected an individual whose partners and surroundings are in the log"):
        Nursery(killed).score(logged)


def test_the_command_replays_one_with_partners(folder) -> None:
    sql = "select id from individuals where len(partners) > 1 order by id desc limit 1"
    ((identity,),) = ask(folder.log, sql).rows
    result = CliRunner().invoke(main, ["replay", str(folder.path), "--id", str(identity), "--json"])
    assert json.loads(result.stdout.splitlines()[-1])["same"] is True


def test_adapted_migrants_are_individuals_of_their_own(folder) -> None:
    sql = "select id, island, parents, genotype from individuals where origin = 'adaptation'"
    rows = ask(folder.log, sql).rows
    assert rows
    crossed = {row for (row,) in ask(folder.log, "select id from migrations where channel = 'migrants-5'").rows}
    for identity, island, parents, genotype in rows:
        assert (island, home_of(identity)) == ("short", 8)
        assert set(parents) <= crossed
        assert len(json.loads(genotype)) == 12
