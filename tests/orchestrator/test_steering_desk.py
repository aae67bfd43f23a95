"""How a command gets to a run, into its history, and to its islands; and the command line's side of it."""

from __future__ import annotations

import json
import threading
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner
from steered import Steered

from experiments import bits, write
from genome.errors import InputError
from islands.biologies import Biologies
from islands.individual import make_id
from islands.interventions.intervention import Intervention
from islands.store import Store, StoreError
from orchestrator.cli import main
from orchestrator.loading import load_experiment
from orchestrator.steering.command import Command, Request
from orchestrator.steering.desk import Desk
from orchestrator.steering.journal import FILE, Journal, interventions_at, read_commands, structural
from orchestrator.steering.mailbox import Answer, await_answer, letters, post, reply
from orchestrator.steering.past import Past

WEIGHT = Request("weight", {"values": {"ones": 2.0}})
ENDED = Answer(accepted=False, epoch=None, reason="the run has finished")
TIME = "2026-01-01T00:00:00+00:00"


class Clock:
    """Time that passes while somebody sleeps, and what happens meanwhile."""

    def __init__(self, *happenings: Any) -> None:
        self.now, self.happenings = 0.0, list(happenings)

    def __call__(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        assert seconds > 0
        self.now += seconds
        if self.happenings:
            self.happenings.pop(0)()


@pytest.fixture
def store(tmp_path: Path) -> Store:
    return Store.open(tmp_path / "run")


@pytest.fixture
def loaded(tmp_path: Path) -> Any:
    return load_experiment(write(tmp_path, bits()))


# -- the journal -------------------------------------------------------------------------------------------------------


def test_commands_are_lines_in_order_and_read_back(store) -> None:
    journal = Journal(store)
    journal.append(TIME, "weight", WEIGHT.arguments, 4, "me", token="abc")
    journal.append(TIME, "connect", {"channel": {"from": "ä"}}, None, "me", "no such island")
    journal.append(TIME, "lock", {"id": 3, "islands": ["a"]}, 4, "me")
    lines = store.read(FILE).decode().splitlines()
    assert [set(json.loads(line)) for line in lines] == [
        {"n", "time", "verb", "arguments", "epoch", "by", "outcome", "token"}
    ] * 3
    assert read_commands(store) == journal.commands == Journal(store).commands
    assert [one.is_accepted for one in journal.commands] == [True, False, True]
    assert interventions_at(journal.commands, 4) == (
        Intervention("weight", WEIGHT.arguments, (), 0),
        Intervention("lock", {"id": 3}, ("a",), 2),
    )
    assert interventions_at(journal.commands, 5) == ()
    assert structural(journal.commands) == ()
    assert journal.by_token("abc") == journal.commands[0]
    assert (journal.earliest(2), journal.earliest(9)) == (4, 9)


@pytest.mark.parametrize("torn", ['{"n": 1, "ti', '{"n": 1}', "\udcff"])
def test_a_last_line_without_its_end_is_passed_over_and_goes(store, torn) -> None:
    first = Journal(store).append(TIME, "pause", {}, 1, "me")
    store.write(FILE, store.read(FILE) + torn.encode(errors="surrogateescape"))
    journal = Journal(store)
    assert journal.commands == (first,)
    second = journal.append(TIME, "resume", {}, 1, "me")
    assert read_commands(store) == (first, second)


@pytest.mark.parametrize("line", ["nothing", "{}", '{"n": 0}', "[]"])
def test_a_line_that_is_no_command_is_told_with_its_number(store, line) -> None:
    Journal(store).append(TIME, "pause", {}, 1, "me")
    store.write(FILE, store.read(FILE) + f"{line}\n".encode())
    with pytest.raises(InputError) as caught:
        read_commands(store)
    assert str(caught.value).startswith(f"{store.at(FILE)}:2: expected ")


def test_a_command_that_is_out_of_place_is_told(store) -> None:
    one = Command(1, TIME, "pause", {}, 1, "me")
    store.write(FILE, f"{json.dumps(one.to_json())}\n".encode())
    with pytest.raises(InputError, match="expected the command of number 0, got that of number 1"):
        read_commands(store)


# -- letters -----------------------------------------------------------------------------------------------------------


def test_a_letter_is_answered_and_nothing_is_left_of_it(store) -> None:
    token = post(store, WEIGHT, TIME, "me")
    (letter,) = letters(store)
    assert (letter.token, letter.request, letter.time, letter.by) == (token, WEIGHT, TIME, "me")
    clock = Clock(lambda: None, lambda: reply(store, token, Answer(accepted=True, epoch=3)))
    assert await_answer(store, token, 30, clock, clock.sleep) == Answer(accepted=True, epoch=3)
    assert clock.now < 1
    assert (store.names("inbox"), store.names("outbox")) == ([], [])


def test_a_letter_that_nobody_answers_is_withdrawn(store) -> None:
    token = post(store, WEIGHT, TIME, "me")
    clock = Clock()
    assert await_answer(store, token, 5, clock, clock.sleep) is None
    assert clock.now == 5
    assert letters(store) == []
    token = post(store, WEIGHT, TIME, "me")
    clock = Clock()
    assert await_answer(store, token, 5, clock, clock.sleep, lambda: clock.now < 1) is None
    assert 1 <= clock.now < 3


def test_an_answer_that_comes_with_the_last_look_counts(store) -> None:
    token = post(store, WEIGHT, TIME, "me")

    class Late:
        def remove(self, name: str) -> None:
            if name.startswith("inbox"):
                reply(store, token, Answer(accepted=False, epoch=None, reason="late"))
            store.remove(name)

        def __getattr__(self, name: str) -> Any:
            return getattr(store, name)

    clock = Clock()
    assert await_answer(Late(), token, 0, clock, clock.sleep) == Answer(accepted=False, epoch=None, reason="late")


def test_letters_are_in_the_order_of_their_times_and_what_is_none_is_answered(store) -> None:
    late, early = (post(store, WEIGHT, time, "me") for time in ("2026-02", "2026-01"))
    store.write("inbox/bad.json", b"{")
    store.write("inbox/worse.json", b'{"verb": "dance", "arguments": {}, "by": "", "time": ""}')
    assert [one.token for one in letters(store)] == [early, late]
    assert store.names("outbox") == ["bad.json", "worse.json"]
    assert len(store.names("inbox")) == 2


# -- the desk ----------------------------------------------------------------------------------------------------------


def test_the_desk_decides_remembers_and_answers(store, loaded) -> None:
    desk = Desk(store, loaded)
    tokens = [
        post(store, Request(verb, arguments), f"2026-{place:02}", "me")
        for place, (verb, arguments) in enumerate(
            [
                ("weight", {"values": {"ones": 2.0}}),
                ("weight", {"values": {"onse": 2.0}}),
                ("add-island", {"name": "west", "like": "north", "set": ["population=5"]}),
                ("connect", {"channel": {"from": "west", "to": "south"}}),
                ("lock", {"is": "no id"}),
                ("pause", {}),
            ]
        )
    ]

    def objection(request: Request, epoch: int) -> str:
        return f"not at epoch {epoch}" if request.verb == "pause" else ""

    taken = desk.look(3, objection)
    assert [(one.number, one.verb, one.epoch) for one in taken] == [
        (0, "weight", 3),
        (2, "add-island", 3),
        (3, "connect", 3),
    ]
    assert [one.outcome for one in desk.commands][5] == "not at epoch 3"
    answers = [await_answer(store, token, 0, lambda: 0.0, lambda _: None) for token in tokens]
    assert [(one.accepted, one.epoch) for one in answers if one] == [
        (True, 3), (False, None), (True, 3), (True, 3), (False, None), (False, None)
    ]  # fmt: skip
    assert answers[1] is not None
    assert "did you mean 'ones'?" in answers[1].reason
    assert desk.interventions(3) == (Intervention("weight", {"values": {"ones": 2.0}}, (), 0),)
    assert [spec.name for spec in desk.plan().islands if spec.since == 3] == ["west"]
    assert Desk(store, loaded).plan() == desk.plan()
    assert desk.look(3) == []


def test_a_letter_that_was_taken_before_a_crash_counts_once(store, loaded) -> None:
    token = post(store, WEIGHT, TIME, "me")
    letter = store.read(f"inbox/{token}.json")
    assert len(Desk(store, loaded).look(3)) == 1
    store.write(f"inbox/{token}.json", letter)
    desk = Desk(store, loaded)
    assert desk.look(5) == []
    assert len(desk.commands) == 1
    assert await_answer(store, token, 0, lambda: 0.0, lambda _: None) == Answer(accepted=True, epoch=3)


def test_what_was_decided_is_given_back_though_the_store_fails_after_it(store, loaded, monkeypatch) -> None:
    desk = Desk(store, loaded)
    tokens = [post(store, WEIGHT, f"2026-{place}", "me") for place in range(3)]
    write_file = type(store).write
    left = ["outbox"]

    def failing(self: Store, name: str, content: bytes, staging: str = "") -> None:
        if left and name.startswith(left[0]):
            raise StoreError("bucket", "a store that answers", "none")
        write_file(self, name, content, staging)

    monkeypatch.setattr(type(store), "write", failing)
    assert [one.number for one in desk.look(3)] == [0], "it is in the history: its islands are to hear of it"
    left[0] = FILE
    with pytest.raises(StoreError):
        desk.look(4)
    left.clear()
    assert [(one.number, one.epoch) for one in desk.look(5)] == [(1, 5), (2, 5)]
    answers = [await_answer(store, token, 0, lambda: 0.0, lambda _: None) for token in tokens]
    assert [one.epoch for one in answers if one] == [3, 5, 5]


def test_after_a_rollback_commands_come_after_those_that_were_decided(store, loaded) -> None:
    desk = Desk(store, loaded)
    post(store, WEIGHT, TIME, "me")
    desk.look(7)
    post(store, Request("disconnect", {"channel": "migrants-1"}), TIME, "me")
    (command,) = Desk(store, loaded).look(2)
    assert command.epoch == 7
    post(store, WEIGHT, TIME, "me")
    fresh = Desk(Store.open(store.at("other").place), loaded)
    assert fresh.commands == ()


def test_nobody_is_told_of_epoch_0_and_who_waits_at_the_end_is_answered(store, loaded) -> None:
    desk = Desk(store, loaded)
    post(store, WEIGHT, TIME, "me")
    assert [one.epoch for one in desk.look(0)] == [1]
    token = post(store, WEIGHT, TIME, "me")
    desk.close("the run has finished")
    assert await_answer(store, token, 0, lambda: 0.0, lambda _: None) == ENDED
    assert len(desk.commands) == 1


def test_a_run_that_was_steered_goes_the_same_way_from_its_journal(store, loaded) -> None:
    """What one process was told as it went, another reads in commands.jsonl: the same epochs, the same result."""
    desk = Desk(store, loaded)
    first = Steered(desk.plan(), 7)
    lines = {
        2: [WEIGHT, Request("lock", {"id": make_id(0, 0)})],
        3: [
            Request("add-island", {"name": "west", "like": "north", "set": []}),
            Request("connect", {"channel": {"from": "west", "to": "north-0"}}),
            Request("insert", {"genotype": json.dumps([0, 1] * 16), "islands": ["north-1"]}),
        ],
        5: [Request("remove-island", {"islands": ["north-2"]}), Request("target", {"values": {"ones": 9}})],
    }
    for epoch in range(7):
        for place, request in enumerate(lines.get(epoch, ())):
            post(store, request, f"{epoch}-{place}", "me")
        desk.look(epoch)
        first.remake(desk.plan())
        first.step(desk.commands)
    again = Desk(store, loaded)
    second = Steered(again.plan(), 7)
    for _ in range(7):
        second.step(again.commands)
    assert second.born() == first.born()
    assert second.states == first.states
    assert {number for number, state in first.states.items() if state.steered.goals} == {0, 1, 3, 4}
    assert len(desk.commands) == 7


# -- the command line --------------------------------------------------------------------------------------------------


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A run's folder as one has it that goes on, on another machine."""
    path = tmp_path / "run"
    path.mkdir()
    write(path, bits(), "experiment.yaml")
    manifest = {"run": "run", "status": "running", "machine": "elsewhere", "process": 1}
    (path / "manifest.json").write_text(json.dumps(manifest), encoding="utf-8")
    return path


def steer(folder: Path, *words: str) -> tuple[int, str, str]:
    result = CliRunner().invoke(main, ["steer", str(folder), *words], prog_name="atoll")
    return result.exit_code, result.stdout, result.stderr


def test_a_command_is_answered_by_the_run(folder) -> None:
    desk = Desk(Store.open(folder), load_experiment(folder / "experiment.yaml"))
    over = threading.Event()

    def drive() -> None:
        while not over.wait(0.01):
            desk.look(5, lambda request, epoch: "it is not paused" if request.verb == "resume" else "")

    driver = threading.Thread(target=drive)
    driver.start()
    try:
        assert steer(folder, "weight", "ones=3") == (0, "weight: accepted, from epoch 5 on\n", "")
        code, out, _ = steer(folder, "lock", "3", "--island", "north-0", "--json")
        assert (code, json.loads(out)) == (0, {"accepted": True, "epoch": 5, "reason": ""})
        code, out, err = steer(folder, "resume", "--json")
        assert (code, json.loads(out)) == (2, {"accepted": False, "epoch": None, "reason": "it is not paused"})
        assert err == f"atoll: {folder} refused 'resume': it is not paused\n"
    finally:
        over.set()
        driver.join()
    assert [(one.verb, one.epoch) for one in desk.commands] == [("weight", 5), ("lock", 5), ("resume", None)]
    assert "@" in desk.commands[0].by or desk.commands[0].by
    assert not list((folder / "inbox").iterdir())


@pytest.mark.parametrize(
    ("words", "part"),
    [
        (("wieght", "ones=3"), "did you mean 'weight'?"),
        (("weight", "onse=3"), "did you mean 'ones'?"),
        (("lock", "1", "--island", "nroth"), "did you mean 'north'?"),
        (("connect", "{from: north, to: [south"), "steer connect"),
        (("insert", "none"), "a genotype that north-0 can read"),
        ((), "steer: expected a verb"),
    ],
)
def test_what_cannot_be_meant_exits_with_2_and_writes_nothing(folder, words, part) -> None:
    code, out, err = steer(folder, *words)
    assert (code, out) == (2, "")
    assert part in err
    assert err.count("\n") == 1
    assert sorted(path.name for path in folder.iterdir()) == ["experiment.yaml", "manifest.json"]


@pytest.mark.parametrize("status", ["finished", "failed", "stopped"])
def test_a_run_that_has_ended_takes_no_commands(folder, status) -> None:
    path = folder / "manifest.json"
    path.write_text(json.dumps({**json.loads(path.read_text(encoding="utf-8")), "status": status}), encoding="utf-8")
    code, _, err = steer(folder, "pause")
    assert code == 2
    expected = f"expected a run that is running, got one that is {status}; nobody is there to take commands"
    assert err == f"atoll: {folder}: {expected}\n"
    assert not (folder / "inbox").exists()


def test_a_run_that_does_not_answer_is_given_up(folder) -> None:
    code, out, err = steer(folder, "pause", "--wait", "0")
    assert (code, out) == (1, "")
    assert f"{folder}: no answer from the run within 0 s, the command was withdrawn" in err
    assert not list((folder / "inbox").iterdir())


def test_individuals_of_a_steered_run_are_scored_by_the_goals_of_their_epoch(store, loaded) -> None:
    desk = Desk(store, loaded)
    run = Steered(desk.plan(), 7)
    lines = {
        2: [Request("add-island", {"name": "west", "like": "north", "set": []}), WEIGHT],
        4: [Request("target", {"values": {"ones": 9}, "islands": ["north-0", "west"]})],
        5: [Request("rate", {"values": {"mutation": 1.0}}), Request("weight", {"values": {"ones": 0.5}})],
    }
    for epoch in range(7):
        for place, request in enumerate(lines.get(epoch, ())):
            post(store, request, f"{epoch}-{place}", "me")
        desk.look(epoch)
        run.remake(desk.plan())
        run.step(desk.commands)
    past, build = Past(read_commands(store), desk.plan().islands), Biologies(lambda: 0.0)
    scorings = set()
    for (number, epoch), records in run.records.items():
        biology = build(past.spec(desk.plan().islands[number].name, epoch))
        scorings.add((number, biology.scoring))
        for row in records.born:
            assert biology.evaluate(biology.decode(row.genotype)).fitness == row.fitness
    assert [sum(number == one for number, _ in scorings) for one in range(5)] == [4, 3, 3, 3, 3]
