"""What a host tells of its islands: their best forms, and why all of a deme are invalid."""

from __future__ import annotations

import time

from archipelagos import island, spec
from bits import BitsKind

from islands.forms import best_forms
from islands.host import Host
from islands.individual import Individual
from islands.orders import HostPlan
from islands.tally import most_frequent_error


def member(identity: int, fitness: float | None, scores: tuple[tuple[str, float], ...], error: str = ""):
    return Individual(identity, (identity % 2,) * 4, fitness, scores, error)


def test_best_forms_differ_in_their_scores_and_the_lowest_id_stands_for_equals() -> None:
    a, b = (("ones", 4.0), ("zeros", 1.0)), (("ones", 4.0), ("zeros", 1.0 + 2**-52))
    deme = [
        member(9, 4.0, a), member(3, 4.0, a), member(5, 4.0, b), member(7, 4.0, b),
        member(2, 1.0, (("ones", 1.0), ("zeros", 0.0))), member(1, None, ()),
    ]  # fmt: skip
    assert [one.id for one in best_forms(island(), deme, 12)] == [3, 5, 2]
    assert [one.id for one in best_forms(island(), deme, 2)] == [3, 5]
    assert best_forms(island(), deme, 0) == []


def test_without_scores_genotypes_tell_forms_apart() -> None:
    deme = [member(identity, 1.0, ()) for identity in range(6)]
    assert [one.id for one in best_forms(island(), deme, 4)] == [0, 1]


def test_the_most_frequent_error_is_of_the_commonest_reason() -> None:
    errors = ["mapping: x", "mapping: x", "budget: 1", "budget: 2", "budget: 2", ""]
    deme = [member(identity, None, (), error) for identity, error in enumerate(errors)]
    assert most_frequent_error(deme) == "budget: 2"
    assert most_frequent_error([member(0, 1.0, ())]) == ""
    assert most_frequent_error([member(0, None, (), "rules: " + "x" * 999)]).endswith("x…")


def test_a_summary_tells_the_trouble_of_a_deme_that_is_all_invalid_alone(tmp_path) -> None:
    isles = (spec(0, growth={"raise_ending": "0"}, genome={"length": 1}), spec(1, group="good"))
    plan = HostPlan(0, 1, "test", 5, str(tmp_path), isles, (), (0, 0), 1, 1, 3)
    host = Host(plan)
    host.ready()
    bad, good = host.advance(0, 0, -1).summaries
    assert (good.trouble, good.invalid) == ("", 0)
    assert bad.trouble == ""
    assert 0 < bad.invalid < 12
    isles = (spec(0, growth={"fail_ending": ""}),)
    host = Host(HostPlan(0, 1, "test", 5, str(tmp_path), isles, (), (0,), 1, 1, 3))
    host.ready()
    biology = host._islands[0].biology
    biology.evaluate = lambda genotype: (_ for _ in ()).throw(SystemExit("no licence"))
    (bad,) = host.advance(0, 0, -1).summaries
    assert (bad.trouble, bad.invalid, bad.best) == ("exception: SystemExit: no licence", 12, None)


def test_the_log_is_written_as_far_as_all_hosts_have_come_and_ends_where_it_is_told(tmp_path) -> None:
    isles = (spec(0), spec(1))
    host = Host(HostPlan(0, 2, "test", 5, str(tmp_path), isles, (), (0, 0), 1, 3, 1, epochs=9))
    host.ready()

    def names() -> list[str]:
        return sorted(path.stem[1:14] for path in tmp_path.glob("log/generations/*.parquet"))

    host.advance(5, 5, -1)
    assert names() == []
    host.advance(6, 6, 2)
    assert names() == []
    host.advance(9, 9, 6)
    assert names() == ["000000-000003", "000004-000006"]
    done = host.finish(forms=True, settled=6, through=8)
    assert names() == ["000000-000003", "000004-000006", "000007-000008"]
    assert [(row.epoch, row.evaluations) for row in done.summaries] == [(8, 20), (8, 20)]
    assert sorted(path.name for path in (tmp_path / "forms").iterdir()) == ["isle-0-best1.txt", "isle-1-best1.txt"]


def test_summaries_count_from_the_call_before(tmp_path) -> None:
    host = Host(HostPlan(0, 1, "test", 5, str(tmp_path), (spec(0),), (), (0,), 2, 3, 1))
    host.ready()
    told = [host.advance(epoch, epoch, -1).summaries[0] for epoch in (0, 1, 4)]
    assert [(row.epoch, row.generation, row.evaluations) for row in told] == [(0, 0, 12), (1, 2, 20), (4, 8, 60)]


def test_growth_is_timed_by_the_processor_after_kernels_are_compiled(tmp_path, monkeypatch) -> None:
    """A process that stands still for a while, or waits for the compiler, must not breed others."""
    told = []

    class Kind(BitsKind):
        def compile_kernels(self) -> None:
            told.append("compiled")

        def build(self, given, clock):
            told.append(clock)
            return super().build(given, clock)

    monkeypatch.setattr("islands.biologies.resolve_kind", lambda name, where: Kind())
    Host(HostPlan(0, 1, "test", 5, str(tmp_path), (spec(0),), (), (0,), 1, 3, 1)).ready()
    assert told == ["compiled", time.thread_time]


def test_nothing_goes_on_after_trouble(tmp_path, monkeypatch) -> None:
    host = Host(HostPlan(0, 1, "test", 5, str(tmp_path), (spec(0),), (), (0,), 1, 3, 1))
    host.ready()
    host.advance(1, 1, -1)
    monkeypatch.setattr(host._log, "add", lambda *given: (_ for _ in ()).throw(OSError(28, "No space left")))
    told = host.advance(5, 5, 0)
    assert (told.epoch, told.trouble, told.stopped) == (1, "OSError: [Errno 28] No space left", False)
    monkeypatch.undo()
    assert host.advance(9, 9, 0)[:2] == (1, ())
