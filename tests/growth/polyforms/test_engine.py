from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from reference_polyforms import assembled, conjoined, is_disc

from genome.polyform import Assembly, Attachment, Conjoining, Part, Room
from growth.polyforms import (
    CUBE,
    HEXAGON,
    SQUARE,
    TILINGS,
    TRIANGLE,
    Plan,
    Polyform,
    Tiling,
    assemble,
    distances,
    draw_assembly,
    draw_room,
    grow_room,
    mend_assembly,
    redraw_assembly,
    redraw_room,
)

ALL = pytest.mark.parametrize("tiling", TILINGS.values(), ids=TILINGS)
Shape = frozenset[tuple[int, int, int]]


def room(*names: str, tiling: Tiling = SQUARE, first: int = 0) -> Room:
    return Room(tuple(Conjoining(tiling.letters.index(name[0]), int(name[1:]) - 1) for name in names), first)


def grown(one: Room, tiling: Tiling) -> Polyform:
    form = grow_room(one, tiling)
    assert isinstance(form, Polyform)
    return form


def drawn(parts: list[Part], tiling: Tiling, rng: np.random.Generator) -> Assembly:
    found = draw_assembly(parts, tiling, rng)
    assert isinstance(found, Assembly)
    return found


def fixed(form: Polyform) -> Shape:
    """Give a form wherever it lies."""
    low = form.cells.min(axis=0) * ([1, 1, 0] if form.tiling.types > 1 else [1, 1, 1])
    return frozenset((x, y, z) for x, y, z in (form.cells - low).tolist())


def numbers_of_forms(tiling: Tiling, most: int) -> Iterator[int]:
    """Count the forms that genotypes of 1, 2, ... cells reach; one genotype goes on for each form."""
    level = {fixed(grown(Room((), first), tiling)): Room((), first) for first in range(tiling.types)}
    yield len(level)
    for _ in range(most - 1):
        after: dict[Shape, Room] = {}
        for one in level.values():
            for vector in range(len(tiling.letters)):
                for edge in range(2 * one.size + 1):
                    longer = Room((*one.joins, Conjoining(vector, edge)), one.first)
                    form = grow_room(longer, tiling)
                    if isinstance(form, Polyform):
                        after[fixed(form)] = longer
                    elif "no free edge" in form.detail:
                        break
        level = after
        yield len(level)


@pytest.mark.parametrize(
    ("tiling", "counts"),
    [
        (SQUARE, [1, 2, 6, 19, 63, 216, 756]),  # fixed polyominoes without holes, semantics.md section 3
        (HEXAGON, [1, 3, 11, 44, 186]),
        (TRIANGLE, [2, 3, 6, 14, 36, 94]),
        (CUBE, [1, 3, 15, 86]),
    ],
    ids=["square", "hexagon", "triangle", "cube"],
)
def test_genotypes_reach_every_form_without_holes(tiling: Tiling, counts: list[int]) -> None:
    assert list(numbers_of_forms(tiling, len(counts))) == counts


def test_the_papers_trimino() -> None:
    assert grown(room("E1", "N2"), SQUARE).cells.tolist() == [[0, 0, 0], [0, 1, 0], [-1, 1, 0]]


def test_a_ring_is_discarded_where_it_would_close_and_where_its_ends_would_touch() -> None:
    six = ("S1", "S1", "E3", "E3", "N3")
    touching = grow_room(room(*six, "E1"), SQUARE)
    assert str(touching) == "conjoining: number 6: joined at E1 the boundary is no simple polygon"
    assert isinstance(grow_room(room(*six, "N3"), SQUARE), Polyform)
    closed = grow_room(room(*six, "N3", "W5"), SQUARE)
    assert str(closed) == "conjoining: number 7: joined at W5 the boundary is no simple polygon"


def test_an_edge_that_is_not_there_is_named() -> None:
    assert str(grow_room(room("E1", "N3"), SQUARE)) == "conjoining: number 2: there is no free edge N3"


@ALL
@given(data=st.data())
@settings(max_examples=40, deadline=None)
def test_rooms_grow_as_the_reference_says(tiling: Tiling, data: st.DataObject) -> None:
    first = data.draw(st.integers(0, tiling.types - 1))
    gene = st.tuples(st.integers(0, len(tiling.letters) - 1), st.integers(0, 3))
    joins = data.draw(st.lists(gene, max_size=9))
    form = grow_room(Room(tuple(Conjoining(*one) for one in joins), first), tiling)
    expected = conjoined(joins, tiling, first)
    assert (list(map(tuple, form.cells.tolist())) if isinstance(form, Polyform) else None) == expected


@ALL
@given(seed=st.integers(0, 2**32), sizes=st.lists(st.integers(1, 7), min_size=2, max_size=3), data=st.data())
@settings(max_examples=30, deadline=None)
def test_parts_conjoin_as_the_reference_says(tiling: Tiling, seed: int, sizes: list[int], data: st.DataObject) -> None:
    rng = np.random.default_rng(seed)
    rooms = [draw_room(size, tiling, rng) for size in sizes]
    gene = st.tuples(st.integers(0, len(tiling.letters) - 1), st.integers(0, 3), st.integers(0, 3))
    joins = data.draw(st.lists(gene, min_size=len(sizes) - 1, max_size=len(sizes) - 1))
    parts = tuple(Part(k, one) for k, one in enumerate(rooms))
    plan = assemble(Assembly(parts, tuple(Attachment(*one) for one in joins)), tiling)
    cells = [[(x, y, z) for x, y, z in grown(one, tiling).cells.tolist()] for one in rooms]
    assert (list(map(tuple, plan.cells.tolist())) if isinstance(plan, Plan) else None) == assembled(
        cells, joins, tiling
    )


@ALL
def test_what_is_drawn_can_be_grown_and_is_of_its_size(tiling: Tiling) -> None:
    rng = np.random.default_rng(3)
    for size in (1, 2, 12, 24):
        form = grown(draw_room(size, tiling, rng), tiling)
        assert len({tuple(cell) for cell in form.cells.tolist()}) == size
        assert is_disc([(x, y, z) for x, y, z in form.cells.tolist()], tiling)


@ALL
def test_a_house_keeps_its_rooms_whole(tiling: Tiling) -> None:
    rng = np.random.default_rng(5)
    sizes = [[4, 9, 6], [3, 7]]
    zones = [
        drawn([Part(k, draw_room(size, tiling, rng)) for k, size in enumerate(zone)], tiling, rng) for zone in sizes
    ]
    house = drawn([Part(k, zone) for k, zone in enumerate(zones)], tiling, rng)
    plan = assemble(house, tiling)
    assert isinstance(plan, Plan)
    assert np.bincount(plan.rooms).tolist() == [4, 9, 6, 3, 7]
    for number, one in enumerate(house.rooms()):
        own = plan.cells[plan.rooms == number]
        alone = grown(one, tiling).cells
        assert (own - own[0] == alone - alone[0]).all()


def test_each_first_edge_is_drawn_as_often_as_any_other() -> None:
    rng = np.random.default_rng(7)
    firsts = [draw_room(2, SQUARE, rng).joins[0].vector for _ in range(4000)]
    counts = np.bincount(firsts, minlength=4)
    assert ((counts - 1000) ** 2 / 1000).sum() < 16.27  # chi squared, 3 degrees of freedom, p = 0.001


def test_redrawing_keeps_what_stands_before_and_what_still_fits_behind() -> None:
    rng = np.random.default_rng(9)
    one = draw_room(15, SQUARE, rng)
    for at in range(14):
        other = redraw_room(one, at, SQUARE, rng)
        assert other.joins[:at] == one.joins[:at]
        assert isinstance(grow_room(other, SQUARE), Polyform)
        prefix = Room((*other.joins[: at + 1], *one.joins[at + 1 :]))
        if isinstance(grow_room(prefix, SQUARE), Polyform):
            assert other == prefix


def test_redrawing_an_attachment_keeps_the_parts() -> None:
    rng = np.random.default_rng(11)
    one = drawn([Part(k, draw_room(6, SQUARE, rng)) for k in range(4)], SQUARE, rng)
    others = [redraw_assembly(one, 1, SQUARE, rng) for _ in range(20)]
    for other in others:
        assert isinstance(other, Assembly)
        assert other.parts == one.parts
        assert other.joins[0] == one.joins[0]
    assert len(set(others)) > 10


def test_parts_that_cannot_be_grown_fail_as_they_do_alone() -> None:
    bad = Part(0, room("E7"))
    assert str(assemble(Assembly((bad,), ()), SQUARE)) == "conjoining: number 1: there is no free edge E7"


def test_mending_keeps_what_fits_and_draws_the_rest() -> None:
    rng = np.random.default_rng(13)
    one = drawn([Part(k, draw_room(6, SQUARE, rng)) for k in range(4)], SQUARE, rng)
    assert mend_assembly(one, SQUARE, rng) == one
    swapped = Assembly((Part(9, draw_room(9, SQUARE, rng)), *one.parts[1:]), (Attachment(0, 99, 0), *one.joins[1:]))
    mended = mend_assembly(swapped, SQUARE, rng)
    assert isinstance(mended, Assembly)
    assert isinstance(assemble(mended, SQUARE), Plan)
    assert mended.parts == swapped.parts


def test_distances_are_what_forms_do_not_share() -> None:
    def plan(*cells: tuple[int, int, int]) -> Plan:
        rows = np.array(cells)
        return Plan(SQUARE, np.column_stack([rows[:, :2], np.zeros(len(rows), dtype=np.int64)]), rows[:, 2])

    forms = [plan((0, 0, 0), (1, 0, 0)), plan((5, 5, 0), (6, 5, 1)), plan((0, 0, 1), (0, 1, 1), (0, 2, 1))]
    assert distances(forms) == pytest.approx(np.array([[0, 2 / 3, 1], [2 / 3, 0, 1], [1, 1, 0]]))
    assert distances([]).shape == (0, 0)
