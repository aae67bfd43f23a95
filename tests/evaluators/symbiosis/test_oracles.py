"""Shells, rings and rooms whose scores are counted by hand (semantics.md, section 5)."""

import itertools
import math

import pytest
from partners import CUBIC, ISOSPATIAL, SQUARE, ball, partners, shell, without

from evaluators.symbiosis import LOGGED, score

ROOM = ball(CUBIC, 1)
SHELL = shell(CUBIC, 2)
WINDOW = [(x, y, 2) for x in (-1, 0, 1) for y in (-1, 0, 1)]
READINGS = pytest.mark.parametrize("surrounded", ["flood", "visibility"])


def scores(*species, **how):
    return score(partners(*species, **how), LOGGED)


def shares(*species, **how):
    found = scores(*species, **how)
    assert found["symbiotic"] == (found["enclosure_share"] + found["space_share"]) / 2
    return found["enclosure_share"], found["space_share"]


class TestCubic:
    @READINGS
    def test_a_closed_shell_round_its_space(self, surrounded):
        found = scores(SHELL, ROOM, surrounded=surrounded)
        assert len(SHELL) == found["enclosure_cells"] == 98
        assert (found["enclosure_share"], found["space_share"], found["symbiotic"]) == (1, 1, 1)
        assert found["enclosed"] == 27
        assert found["enclosed_ratio"] == 27 / 98
        assert found["economy"] == 27 / 125

    def test_a_face_taken_out(self):
        opened = without(SHELL, *WINDOW)
        found = scores(opened, ROOM)
        assert found["flood"] == 0
        assert found["visibility"] == 619 / 702  # 83 rays of 27 x 26 leave
        assert round(found["space_share"], 3) == 0.882
        assert shares(opened, ROOM, surrounded="flood") == (0, 0)
        # each of the 9 cells in the opening sees the frame in 8 directions and the shell below in 9: 2 x 17 / 26 - 1
        assert found["enclosed"] == pytest.approx(2 * 619 / 26 - 27 + 9 * 4 / 13)
        assert found["enclosure_share"] == pytest.approx(268 / 304)

    @READINGS
    def test_the_papers_enclosure_has_the_share_of_its_space(self, surrounded):
        half = [cell for cell in ROOM if cell[0] < 0]
        assert shares(SHELL, half, surrounded=surrounded) == (9 / 27, 1)
        assert shares(SHELL, half, surrounded=surrounded, profile="paper") == (1, 1)

    def test_a_hole_of_one_cell_in_a_thick_wall(self):
        thick = without(ball(CUBIC, 3), *ROOM)
        inner, outer = (0, 0, 2), (0, 0, 3)
        assert shares(thick, ROOM, surrounded="flood") == (1, 1)
        assert shares(without(thick, inner), ROOM, surrounded="flood") == (27 / 28, 1)
        assert shares(without(thick, outer), ROOM, surrounded="flood") == (1, 1)
        assert shares(without(thick, inner, outer), ROOM, surrounded="flood") == (0, 0)
        assert (
            scores(without(thick, inner, outer), ROOM)["visibility"] == 699 / 702
        )  # three rays go straight up and out

    def test_a_leak_over_an_edge(self):
        leaking = without(SHELL, (2, 2, 0))
        assert shares(leaking, ROOM, surrounded="flood") == (0, 0)
        assert shares(leaking, ROOM, surrounded="flood", passage="faces") == (1, 1)

    def test_bodies_apart(self):
        beside = [(x + 9, y, z) for x, y, z in ROOM]
        assert shares(SHELL, beside, surrounded="flood") == (0, 0)
        found = scores(SHELL, beside)
        assert found["enclosure_share"] == 0
        assert found["space_share"] < 0.1  # each sees the shell on one side alone
        assert found["enclosed"] == 27
        found = scores(SHELL, [*ROOM, *beside], surrounded="flood")
        assert (found["enclosure_share"], found["space_share"], found["parts"]) == (1, 0.5, 2)
        assert found["route_joins"] == 0.5

    def test_space_that_pokes_through_a_wall_opens_it(self):
        found = scores(SHELL, [*ROOM, (0, 0, 2)], surrounded="flood")
        assert (found["enclosure_share"], found["space_share"], found["overlap"]) == (0, 0, 1 / 28)
        assert (found["enclosure_cells"], found["doors"], found["route_reaches"]) == (98, 0, 1)

    @READINGS
    def test_space_carves_a_block(self, surrounded):
        found = scores(ball(CUBIC, 2), ROOM, surrounded=surrounded)
        assert (found["enclosure_share"], found["space_share"], found["overlap"]) == (1, 1, 1)
        assert found["economy"] == 27 / (27 + 125)

    def test_no_volume_outside_a_convex_wall(self):
        plate = [(x, y, 0) for x in range(5) for y in range(5)]
        assert scores(plate, surrounded="visibility")["enclosed"] == 0
        assert scores(ball(CUBIC, 2), surrounded="visibility")["enclosed"] == 0


class TestPlane:
    RING = shell(SQUARE, 2)
    COURT = ball(SQUARE, 1)

    @READINGS
    def test_a_ring(self, surrounded):
        assert len(self.RING) == 16
        assert shares(self.RING, self.COURT, lattice=SQUARE, surrounded=surrounded) == (1, 1)

    def test_a_gap(self):
        found = scores(without(self.RING, (2, 0, 0)), self.COURT, lattice=SQUARE)
        assert found["flood"] == 0
        assert found["visibility"] == 67 / 72  # three rays leave along the row, two across corners

    def test_a_corner_out_leaks_to_neighbours_alone(self):
        cut = without(self.RING, (2, 2, 0))
        assert scores(cut, self.COURT, lattice=SQUARE)["flood"] == 0
        assert scores(cut, self.COURT, lattice=SQUARE, passage="faces")["flood"] == 1


class TestIsospatial:
    @READINGS
    @pytest.mark.parametrize(("radius", "walls", "inside"), [(1, 12, 1), (2, 42, 13), (3, 92, 55)])
    def test_shells(self, radius, walls, inside, surrounded):
        around = shell(ISOSPATIAL, radius)
        found = scores(around, ball(ISOSPATIAL, radius - 1), lattice=ISOSPATIAL, surrounded=surrounded)
        assert len(around) == walls
        assert found["enclosed"] == found["space_cells"] == inside
        assert (found["enclosure_share"], found["space_share"], found["evenness"]) == (1, 1, 1)

    def test_one_cell_out(self):
        for gone in shell(ISOSPATIAL, 1):
            found = scores(without(shell(ISOSPATIAL, 1), gone), [(0, 0, 0)], lattice=ISOSPATIAL)
            assert (found["flood"], found["visibility"]) == (0, 11 / 12)


class TestRoute:
    def test_a_door_stays_a_wall_and_lets_people_out(self):
        found = scores(SHELL, ROOM, [(2, 0, 0)], surrounded="flood")
        assert (found["flood"], found["doors"], found["route_cells"]) == (1, 1, 1)
        assert (found["route_joins"], found["route_reaches"], found["route"]) == (1, 1, 1)

    def test_a_route_within_walls_does_not_lead_out(self):
        thick = without(ball(CUBIC, 3), *ROOM)
        found = scores(thick, ROOM, [(2, 0, 0)])
        assert (found["route_joins"], found["route_reaches"], found["doors"]) == (1, 0, 1)
        assert scores(thick, ROOM, [(2, 0, 0), (3, 0, 0)])["route_reaches"] == 1

    def test_one_does_not_walk_straight_up(self):
        rooms = [(0, 0, 0), (0, 0, 2)]
        assert scores([], rooms, [(0, 0, 1)])["route_joins"] == 0
        assert scores([], rooms, [(1, 0, 1)])["route_joins"] == 1
        shaft = scores(without(ball(CUBIC, 3), *ROOM), ROOM, [(0, 0, 2), (0, 0, 3)])
        assert (shaft["route_joins"], shaft["route_reaches"], shaft["doors"]) == (1, 0, 1)

    def test_parts_count_by_their_cells(self):
        five = [(0, 0, 0), (1, 0, 0), (2, 0, 0), (9, 0, 0), (9, 1, 0)]
        assert scores([], five, [(4, 0, 0), (3, 0, 0)])["route_joins"] == 3 / 5
        assert scores([], five, [(8, 0, 0)])["route_joins"] == 2 / 5
        assert scores([], five, [(8, 0, 0), (3, 0, 0)])["route_joins"] == 2 / 5  # it touches two cells, the other one
        assert scores([], five, [(x, 0, 0) for x in range(3, 9)])["route_joins"] == 1
        assert scores([], five)["route_joins"] == 3 / 5

    def test_the_main_part_touches_most_cells_not_most_often(self):
        often, most = [(1, 0, 0), (1, 1, 0), (1, -1, 0)], [(10, 0, 0)]
        assert scores([], [(0, 0, 0), (9, 0, 0), (11, 0, 0)], [*often, *most])["route_joins"] == 2 / 3

    def test_of_equals_the_first_that_grew(self):
        two = [(0, 0, 0), (9, 0, 0)]
        walls = [(10, 0, 0)]
        assert scores(walls, two, [(1, 0, 0), (10, 0, 0)])["doors"] == 0
        assert scores(walls, two, [(10, 0, 0), (1, 0, 0)])["doors"] == 1

    def test_without_space_it_joins_nothing(self):
        found = scores(SHELL, [], [(2, 0, 0)])
        assert (found["route_joins"], found["route_reaches"], found["route"]) == (0, 1, 0.5)


class TestEvenness:
    def evenness(self, walls, lattice=CUBIC):
        return scores(walls, lattice=lattice)["evenness"]

    def test_boxes_are_even_hollow_or_not(self):
        box = list(itertools.product(range(2), range(3), range(4)))
        assert self.evenness(box) == self.evenness(SHELL) == self.evenness([(0, 0, 0)]) == 1
        assert self.evenness([(0, 0, 0)], ISOSPATIAL) == self.evenness([(0, 0, 0)], SQUARE) == 1

    @pytest.mark.parametrize("n", [3, 4, 7])
    def test_a_pit(self, n):
        block = list(itertools.product(range(n), repeat=3))
        assert self.evenness(without(block, (1, 1, n - 1))) == 6 * n**2 / (6 * n**2 + 4)

    @pytest.mark.parametrize("teeth", [1, 2, 5])
    def test_a_comb(self, teeth):
        """A bar with teeth on it: 2 (l + 1) long ways, of which the teeth's 2 are met by each tooth."""
        length = 2 * teeth - 1
        comb = [(x, 0, 0) for x in range(length)] + [(x, 0, 1) for x in range(0, length, 2)]
        faces = 2 * (length + teeth) + 2 * length + 2 + 2 * teeth
        assert self.evenness(comb) == (2 * (length + teeth) + 2 * length + 4) / faces

    def test_an_open_shell_shows_its_inside(self):
        assert self.evenness(without(SHELL, *WINDOW)) == 150 / 198


class TestI:
    def test_cells_that_all_touch_have_0(self):
        assert scores([], list(itertools.product((0, 1), repeat=3)))["i_value"] == 0

    def test_a_path_of_five_and_a_pair(self):
        path = [(x, 0, 0) for x in range(5)]
        d_5 = 2 * (5 * (math.log2(7 / 3) - 1) + 1) / 12
        expected = (2 * 1 + 2 * 1 / 2 + 1 / 3) / 5 / d_5  # MD is 2.5 at the ends, then 1.75, and 1.5 in the middle
        assert scores([], path)["i_value"] == pytest.approx(expected)
        assert scores([], [*path, (20, 0, 0), (21, 0, 0)])["i_value"] == pytest.approx((5 * expected + 2) / 7)

    def test_compact_plans_are_better_than_long_ones(self):
        long = [(x, 0, 0) for x in range(9)]
        square = list(itertools.product(range(3), range(3), [0]))
        assert scores([], square, lattice=SQUARE)["i_value"] < scores([], long, lattice=SQUARE)["i_value"]
