"""What a host tells of its islands: their best forms, and why all of a deme are invalid."""

from __future__ import annotations

from archipelagos import island, spec

from islands.host import Host, HostPlan, best_forms, most_frequent_error
from islands.individual import Individual


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
    bad, good = host.advance(0)[0]
    assert (good.trouble, good.invalid) == ("", 0)
    assert bad.trouble == ""
    assert 0 < bad.invalid < 12
    isles = (spec(0, growth={"fail_ending": ""}),)
    host = Host(HostPlan(0, 1, "test", 5, str(tmp_path), isles, (), (0,), 1, 1, 3))
    host.ready()
    biology = host._islands[0].biology
    biology.evaluate = lambda genotype: (_ for _ in ()).throw(SystemExit("no licence"))
    (bad,) = host.advance(0)[0]
    assert (bad.trouble, bad.invalid, bad.best) == ("exception: SystemExit: no licence", 12, None)
