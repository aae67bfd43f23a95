from __future__ import annotations

import numpy as np
import pytest

from genome.errors import InputError
from genome.polyform import (
    Assembly,
    Attachment,
    Conjoining,
    Part,
    Room,
    crossover,
    decode_assembly,
    decode_room,
    encode,
)

ROOM = Room((Conjoining(2, 0), Conjoining(1, 1)))
HOUSE = Assembly((Part(7, ROOM), Part(9, Assembly((Part(8, Room((), 1)),), ()))), (Attachment(0, 1, 2),))


def test_a_room_is_written_as_its_conjoinings_and_read_again() -> None:
    assert encode(ROOM) == '{"format":1,"first":0,"joins":[[2,0],[1,1]]}'
    assert decode_room(encode(ROOM)) == ROOM


def test_an_assembly_carries_its_parts_whole() -> None:
    assert decode_assembly(encode(HOUSE)) == HOUSE
    assert HOUSE.size == 4
    assert HOUSE.rooms() == (ROOM, Room((), 1))


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[]",
        '{"format":2,"first":0,"joins":[]}',
        '{"format":1,"first":0,"joins":[[1]]}',
        '{"format":1,"first":0,"joins":[[1,-1]]}',
        '{"format":1,"first":true,"joins":[]}',
        '{"format":1,"first":0,"joins":[],"more":1}',
        '{"format":1,"parts":[],"joins":[]}',
        '{"format":1,"parts":[{"id":1,"genotype":{"first":0,"joins":[]}}],"joins":[[0,0,0]]}',
        "[" * 5000,
    ],
)
def test_other_texts_are_refused(text: str) -> None:
    for read in (decode_room, decode_assembly):
        with pytest.raises(InputError):
            read(text)


def test_children_are_cut_at_one_site_where_both_can_be_built() -> None:
    rng = np.random.default_rng(1)
    seen = set()
    for _ in range(200):
        one, other = crossover("aaaaaa", "bbbbbb", rng, lambda genes: genes.count("a") % 2 == 0)
        assert sorted(one + other) == list("aaaaaabbbbbb")
        seen.add("".join(one))
    assert seen <= {"aabbbb", "aaaabb", "aaaaaa"}
    assert {"aabbbb", "aaaabb"} <= seen


def test_parents_come_back_where_nothing_can_be_built_or_cut() -> None:
    rng = np.random.default_rng(1)
    assert crossover("ab", "cd", rng, lambda _: False) == (("a", "b"), ("c", "d"))
    assert crossover("a", "b", rng, lambda _: True) == (("a",), ("b",))
