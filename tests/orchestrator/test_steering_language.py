"""The command language: words into requests, and requests against a run."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from experiments import bits, write
from genome.errors import InputError
from orchestrator.loading import load_experiment
from orchestrator.steering.checks import checked
from orchestrator.steering.command import VERBS, Request
from orchestrator.steering.language import Words, read, split
from orchestrator.steering.structure import Structure, structure_of


@pytest.fixture
def structure(tmp_path: Path) -> Structure:
    data = bits()
    del data["defaults"]["fitness"]
    data["islands"]["north"]["fitness"] = {"ones": {"goal": "maximise"}}
    data["islands"]["south"]["fitness"] = {"zeros": {"goal": "target", "value": 3}}
    return structure_of(load_experiment(write(tmp_path, data)))


def asked(verb: str, *words: str, **options) -> Request:
    return read(verb, Words(words, **options))


def spoken(line, options) -> Request:
    verb, words = split(line)
    return asked(verb, *words, **options)


@pytest.mark.parametrize(
    ("line", "arguments"),
    [
        (("pause",), {}),
        (("stop",), {}),
        (("weight", "size=3", "undulation=0.5"), {"values": {"size": 3, "undulation": 0.5}}),
        (("target", "x=-2.5e1"), {"values": {"x": -25.0}}),
        (("rate", "elite=4", "mutation=.5"), {"values": {"elite": 4, "mutation": 0.5}}),
        (("promote", "1099511627776"), {"id": 1099511627776}),
        (("promote", "none"), {}),
        (("lock", "0"), {"id": 0}),
        (("insert", "[1,2]"), {"genotype": "[1,2]"}),
        (("remove-island", "north-1"), {"islands": ["north-1"]}),
        (("disconnect", "migrants-0"), {"channel": "migrants-0"}),
        (("connect", "{from: a, to: b, count: 2}"), {"channel": {"from": "a", "to": "b", "count": 2}}),
    ],
)
def test_words_become_arguments(line, arguments) -> None:
    verb, words = split(line)
    request = asked(verb, *words)
    assert (request.verb, request.arguments) == (verb, arguments)
    # Whole numbers stay whole: an elite is no fraction.
    assert json.dumps(request.arguments) == json.dumps(arguments)


def test_islands_are_named_by_an_option() -> None:
    request = asked("weight", "size=3", islands=("a", "b"))
    assert request.arguments == {"values": {"size": 3}, "islands": ["a", "b"]}


@pytest.mark.parametrize(
    ("line", "options", "message"),
    [
        ((), {}, f"steer: expected a verb, got nothing; known: {', '.join(VERBS)}"),
        (("wieght", "a=1"), {}, "steer: expected a verb, got 'wieght'; did you mean 'weight'?"),
        (("pause", "now"), {}, "steer pause: expected nothing after it, got 'now'"),
        (("weight",), {}, "steer weight: expected CRITERION=NUMBER, got nothing; for example: weight size=3"),
        (
            ("weight", "size=1e400"),
            {},
            "steer weight: expected a number that is not too large to be one, got 'size=1e400'",
        ),
        (("weight", "size"), {}, "steer weight: expected CRITERION=NUMBER, got 'size'; for example: weight size=3"),
        (
            ("rate", "elite=nan"),
            {},
            "steer rate: expected RATE=NUMBER, got 'elite=nan'; for example: rate mutation=0.4",
        ),
        (("weight", "a=1", "a=2"), {}, "steer weight: expected each name once, got 'a=2'"),
        (("insert",), {}, "steer insert: expected a genotype, as the log writes it, got nothing"),
        (
            ("insert", "[1,", "2]"),
            {},
            "steer insert: expected a genotype, as the log writes it, got '[1, 2]'; quote what has spaces in it",
        ),
        (("disconnect", " "), {}, "steer disconnect: expected a channel's name, got ' '"),
        (("pause",), {"islands": ("a",)}, "steer pause: expected no --island, got a; 'pause' takes none"),
        (
            ("lock", "1"),
            {"like": "a"},
            "steer lock: expected no --like and no --set, got --like a; they belong to 'add-island'",
        ),
        (
            ("connect", "ring"),
            {},
            (
                "steer connect: expected a channel: keys and values, got 'ring'; for example: connect '{kind: "
                "migrants, from: north-0, to: south}'"
            ),
        ),
    ],
)
def test_what_is_no_command_is_told(line, options, message) -> None:
    with pytest.raises(InputError) as caught:
        spoken(line, options)
    assert str(caught.value) == message


@pytest.mark.parametrize("word", ["-1", "1.5", "x", "٣", "9" * 19, "none"])
def test_what_is_no_id_is_told(word) -> None:
    with pytest.raises(InputError, match=r"^steer lock: expected the id of an individual, got"):
        asked("lock", word)


# -- against a run -----------------------------------------------------------------------------------------------------


def test_goals_are_those_of_islands_that_have_them(structure) -> None:
    assert checked(asked("weight", "ones=2"), structure, 3).arguments == {
        "values": {"ones": 2},
        "islands": ["north-0", "north-1", "north-2"],
    }
    assert checked(asked("target", "zeros=2"), structure, 3).arguments["islands"] == ["south"]
    named = asked("weight", "ones=2", islands=("north-1", "north"))
    assert checked(named, structure, 3).arguments["islands"] == ["north-0", "north-1", "north-2"]
    everywhere = checked(asked("rate", "mutation=0.5"), structure, 3)
    assert "islands" not in everywhere.arguments
    for request in (everywhere, checked(asked("weight", "ones=2"), structure, 3)):
        assert checked(request, structure, 3) == request, "the driver checks what was checked"


@pytest.mark.parametrize(
    ("line", "islands", "message"),
    [
        (
            "weight onse=1",
            (),
            "steer weight: expected a criterion that an island has a goal for, got 'onse'; did you mean 'ones'?",
        ),
        (
            "weight ones=1 zeros=1",
            (),
            (
                "steer weight: expected criteria of one island, got ones and zeros, which are goals of "
                "different islands; give a command for each"
            ),
        ),
        (
            "weight ones=1",
            ("south",),
            "steer weight on south: expected a criterion that the island has a goal for, got 'ones'; known: zeros",
        ),
        ("weight ones=-1", (), "steer weight on north ones: weight: expected greater than or equal to 0, got -1.0"),
        ("rate elite=12", (), "steer rate on north elite: expected less than the population of 12, got 12"),
        ("rate elite=9", ("south",), "steer rate on south elite: expected less than the population of 9, got 9"),
        ("rate elite=1.5", (), "steer rate on north: elite: expected a whole number, got 1.5"),
        ("rate crossover=2", (), "steer rate on north: crossover: expected less than or equal to 1, got 2"),
        (
            "rate mutatoin=1",
            (),
            "steer rate on north: expected a rate of the algorithm, got 'mutatoin'; did you mean 'mutation'?",
        ),
        (
            "rate offspring=3",
            (),
            (
                "steer rate on north: expected no offspring with the algorithm 'generational', got 3; did you "
                "mean name: plus?"
            ),
        ),
        ("promote 1", ("nroth",), "steer promote: expected an island of the run, got 'nroth'; did you mean 'north'?"),
        (
            "lock 4398046511104",
            (),
            (
                "steer lock: expected the id of an individual of the run, got 4398046511104, which would be "
                "of an island number 4"
            ),
        ),
        (
            "remove-island nort",
            (),
            "steer remove-island: expected an island of the run, got 'nort'; did you mean 'north'?",
        ),
        (
            "disconnect migrants",
            (),
            "disconnect: expected a channel of the run, got 'migrants'; did you mean 'migrants-1'?",
        ),
    ],
)
def test_what_does_not_suit_the_run_is_told(structure, line, islands, message) -> None:
    verb, *words = line.split()
    with pytest.raises(InputError) as caught:
        checked(asked(verb, *words, islands=islands), structure, 3)
    assert str(caught.value) == message


def test_a_genotype_is_read_and_scored_on_trial(structure) -> None:
    south = ("south",)
    good = asked("insert", json.dumps([0, 1] * 16), islands=south)
    assert checked(good, structure, 3, trial=True).arguments["islands"] == ["south"]
    with pytest.raises(InputError) as caught:
        checked(asked("insert", "nothing", islands=south), structure, 3, trial=True)
    assert str(caught.value) == (
        "steer insert: expected a genotype that south can read, got 'nothing' (JSONDecodeError: Expecting value: "
        "line 1 column 1 (char 0))"
    )
    with pytest.raises(InputError) as caught:
        checked(asked("insert", json.dumps([1] * 32), islands=("north-0",)), structure, 3, trial=True)
    assert "a genotype that is valid on north-0" in str(caught.value)
    assert "growth: an ending that fails" in str(caught.value)


def test_a_new_island_is_like_a_group_but_for_what_is_set(structure) -> None:
    like = structure.loaded.data()["islands"]["north"]
    request = checked(asked("add-island", "west", like="north", settings=("population=5",)), structure, 3)
    assert request.arguments == {"name": "west", "settings": {**like, "count": 1, "population": 5}}
    other = checked(asked("add-island", "west", like="north", settings=("genome.length=8", "count=2")), structure, 3)
    settings = other.arguments["settings"]
    assert settings["count"] == 2
    assert settings.get("species") != like["species"]
    for words, message in (
        (
            Words(("west",)),
            "steer add-island --like: expected a group of islands of the run, got none; known: north, south",
        ),
        (
            Words(("north-1",), like="north"),
            "add-island: expected a name that no island has or had, got 'north-1'; choose another",
        ),
        (
            Words(("west",), like="north", settings=("population=0",)),
            "add-island: islands.west.population: expected greater than or equal to 1, got 0",
        ),
        (
            Words(("west",), like="north", settings=("populatoin=3",)),
            "add-island: islands.west.populatoin: expected a known key, got 'populatoin'; did you mean 'population'?",
        ),
    ):
        with pytest.raises(InputError) as caught:
            checked(read("add-island", words), structure, 3)
        assert str(caught.value) == message


@pytest.mark.parametrize(
    ("verb", "arguments"),
    [
        ("pause", {"now": 1}),
        ("weight", {"values": {}}),
        ("weight", {"values": {"ones": "2"}}),
        ("weight", {"values": {"ones": True}}),
        ("weight", {"values": {"ones": float("inf")}}),
        ("weight", {"values": {"ones": float("nan")}}),
        ("weight", {"values": {"ones": 10**400}}),
        ("rate", {"values": {"elite": 1}, "more": 1}),
        ("lock", {}),
        ("lock", {"id": True}),
        ("lock", {"id": -1}),
        ("remove", {"id": 2**63}),
        ("lock", {"id": 1, "islands": []}),
        ("lock", {"id": 1, "islands": "north"}),
        ("insert", {"genotype": [1]}),
        ("add-island", {"name": "west"}),
        ("add-island", {"name": "west", "like": "north", "set": [1]}),
        ("remove-island", {"islands": []}),
        ("connect", {"channel": "ring"}),
        ("disconnect", {"channel": {}}),
    ],
)
def test_arguments_of_another_shape_are_refused(structure, verb, arguments) -> None:
    with pytest.raises(InputError, match=f"^steer {verb}: expected"):
        checked(Request(verb, arguments), structure, 3)
