"""`atoll validate`: its statistics, that it passes with the engine as it is, and that it fails with a broken one."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from click.testing import CliRunner
from scipy import stats

from islands.migration import replacement
from orchestrator.cli import main
from orchestrator.validate import leading_ones, rare_migration, takeover
from orchestrator.validate.case import Case
from orchestrator.validate.checking import BATCH, CHECKS, _batches, _perform, _performed, validate
from orchestrator.validate.leading_ones import LeadingOnes
from orchestrator.validate.means import compared
from orchestrator.validate.statistics import difference, mean_interval, quantile, share_interval
from orchestrator.validate.takeover import Takeover


def test_the_quantile_allows_for_the_number_of_comparisons() -> None:
    assert quantile(1) == pytest.approx(stats.norm.ppf(0.975))
    assert quantile(24) == pytest.approx(stats.norm.ppf(1 - 0.05 / 48))


def test_intervals_are_those_of_the_textbook() -> None:
    values = [1.0, 2.0, 3.0, 6.0]
    found = mean_interval(values, 1, published_runs=8)
    margin = stats.norm.ppf(0.975) * np.std(values, ddof=1) * math.sqrt(1 / 4 + 1 / 8)
    assert (found.estimate, found.low, found.high) == pytest.approx((3, 3 - margin, 3 + margin))
    share = share_interval(7, 20, 1)
    theirs = stats.binomtest(7, 20).proportion_ci(method="wilson")
    assert (share.low, share.high) == pytest.approx((theirs.low, theirs.high))


def test_the_difference_of_two_shares_is_newcombe_s() -> None:
    # His example: 56 of 70 against 48 of 80.
    found = difference(share_interval(56, 70, 1), share_interval(48, 80, 1))
    assert (found.estimate, found.low, found.high) == pytest.approx((0.2, 0.0524, 0.3339), abs=5e-5)


def test_a_mean_agrees_inside_its_interval_and_with_runs_that_ended() -> None:
    values = [9.0, 11.0] * 50
    inside, outside = compared("x", "y", 10.1, 1, values, 1), compared("x", "y", 10.9, 1, values, 1)
    assert (inside.ok, outside.ok) == (True, False)
    unfinished = compared("x", "y", 10.0, 1, [*values, None], 1)
    assert (unfinished.ok, unfinished.detail) == (False, "there are runs that did not come to their end")


def few(check, names: dict[str, int]):
    """The check with these cases alone, so many runs each."""
    made = type(check)()
    object.__setattr__(made, "cases", tuple(Case(name, runs) for name, runs in names.items()))
    return made


def outcomes(check, case: str, runs: int, *, migration: bool = True) -> list[float | None]:
    return [check.run(case, seed, migration=migration) for seed in range(runs)]


@pytest.mark.parametrize(("case", "published"), [("complete, every 1", 3.9), ("star, every 5", 14.1)])
def test_takeover_times_agree_and_do_not_without_migration(case, published) -> None:
    verdict = compared("takeover", case, published, 1, outcomes(Takeover(), case, 40), 1)
    assert verdict.ok, verdict
    assert set(outcomes(Takeover(), case, 3, migration=False)) == {None}


def test_a_broken_replacement_is_noticed(monkeypatch) -> None:
    def best_goes(residents, *_):
        return 0

    monkeypatch.setitem(replacement.REPLACERS, "worst", best_goes)
    verdict = compared("takeover", "ring, every 1", 12.2, 1, outcomes(Takeover(), "ring, every 1", 10), 1)
    assert not verdict.ok


def test_the_optimum_of_leading_ones_comes_sooner_with_company() -> None:
    check = LeadingOnes()
    together = outcomes(check, "torus", 6)
    assert compared("leading_ones", "torus", 255, 0, together, 1).ok
    assert not compared("leading_ones", "torus", 255, 0, outcomes(check, "torus", 2, migration=False), 1).ok


def test_the_same_seed_gives_the_same_figure_and_batches_cover_every_run() -> None:
    check = Takeover(runs=2 * BATCH + 1)
    assert check.run("complete, every 1", 5, migration=True) == check.run("complete, every 1", 5, migration=True)
    one = validate([Takeover(runs=3)], 1)
    assert {verdict.runs for verdict in one} == {3}
    assert [verdict.case for verdict in one] == [case.name for case in check.cases]


def test_a_run_that_does_not_end_decides_its_batch_where_all_should() -> None:
    check = few(Takeover(), {"complete, every 1": 10})
    (batch,) = _batches(check, migration=False)
    assert _perform(batch) == [None] * 10
    (batch,) = _batches(few(rare_migration.RareMigration(), {"never": 4}), migration=True)
    assert len(_perform(batch)) == 4


def test_the_cases_are_those_published() -> None:
    assert [check.name for check in CHECKS] == ["takeover", "leading_ones", "rare_migration"]
    assert len(takeover.PUBLISHED) == 14
    assert takeover.RUNS == 200
    assert len(leading_ones.PUBLISHED) == 7
    assert leading_ones.RUNS == 60
    assert sum(check.comparisons for check in CHECKS) == 24


def test_the_command_exits_with_1_when_a_figure_does_not_agree(monkeypatch) -> None:
    monkeypatch.setattr("orchestrator.validate.checking.CHECKS", (Takeover(runs=2),))
    monkeypatch.setattr("orchestrator.backends.cluster.machine_cpus", lambda: 1)
    result = CliRunner().invoke(main, ["validate", "--only", "takeover", "--without-migration", "--json"])
    assert result.exit_code == 1
    told = json.loads(result.stdout.splitlines()[-1])
    assert told["ok"] is False
    assert {row["ok"] for row in told["checks"] if row["case"] != "one deme"} == {False}
    assert result.stderr.count("FAIL") == 14


def test_an_unknown_check_is_refused() -> None:
    result = CliRunner().invoke(main, ["validate", "--only", "takeovr"])
    assert result.exit_code == 2
    assert "did you mean 'takeover'" in result.stderr


def test_processes_give_what_one_gives() -> None:
    check = few(Takeover(), {"complete, every 1": 12})
    batches = _batches(check, migration=True)
    assert [batch.runs for batch in batches] == [10, 2]
    assert list(_performed(batches, 2)) == list(_performed(batches, 1))


def test_rare_migration_compares_shares() -> None:
    check = rare_migration.RareMigration()
    good = check.judge({"rare": [1.0] * 36 + [None] * 4, "never": [1.0] * 8 + [None] * 32, "always": [None] * 40}, 24)
    assert [verdict.ok for verdict in good] == [True, True]
    assert "found in 0.90 of the runs against 0.20" in good[0].detail
    bad = check.judge({"rare": [1.0] * 16 + [None] * 24, "never": [1.0] * 8 + [None] * 32, "always": [None] * 40}, 24)
    assert [verdict.ok for verdict in bad] == [False, True]
