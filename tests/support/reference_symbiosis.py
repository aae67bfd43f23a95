"""What partners of enclosure and space make of each other, as plain Python over sets, from the definitions alone."""

from __future__ import annotations

import itertools

import numpy as np

from growth.blocks.lattice import FACE


def cells_of(array):
    return [tuple(cell) for cell in array.tolist()]


def plus(cell, step, times=1):
    return tuple(a + times * b for a, b in zip(cell, step, strict=True))


class Reference:
    """Everything by search and by rays cell by cell, in a box with a wide margin."""

    def __init__(self, symbiosis, margin=2):
        self.lattice, self.settings = symbiosis.lattice, symbiosis.settings
        self.enclosure, self.space, self.route = map(cells_of, (symbiosis.enclosure, symbiosis.space, symbiosis.route))
        self.offsets = cells_of(self.lattice.offsets)
        self.walls = set(self.enclosure) - set(self.space)
        everything = [*self.enclosure, *self.space, *self.route] or [(0, 0, 0)]
        flat = not self.lattice.offsets[:, 2].any()
        ranges = []
        for axis in range(3):
            values = [cell[axis] for cell in everything]
            wide = 0 if flat and axis == 2 else margin
            ranges.append(range(min(values) - wide, max(values) + wide + 1))
        self.box = {c for c in itertools.product(*ranges) if not (self.lattice.parity and sum(c) % 2)}
        self.rim = {c for c in self.box if any(self.at_rim(c, axis, ranges) for axis in range(2 if flat else 3))}
        self.longest = max(len(r) for r in ranges)
        self.outside = self.flooded()
        self.dry = self.box - self.walls - self.outside

    @staticmethod
    def at_rim(cell, axis, ranges):
        return cell[axis] in (ranges[axis][0], ranges[axis][-1])

    def flooded(self):
        faces = self.settings.passage == "faces"
        kinds = self.lattice.contacts.tolist()
        steps = [o for o, kind in zip(self.offsets, kinds, strict=True) if not faces or kind == FACE]
        found, waiting = set(self.rim), list(self.rim)
        while waiting:
            cell = waiting.pop()
            for step in steps:
                near = plus(cell, step)
                if near in self.box and near not in self.walls and near not in found:
                    found.add(near)
                    waiting.append(near)
        return found

    def sees(self, cell):
        """The number of directions in which a ray from a cell meets a wall."""
        return sum(any(plus(cell, o, n) in self.walls for n in range(1, self.longest)) for o in self.offsets)

    def weight(self, cell):
        return max(0.0, 2 * self.sees(cell) / len(self.offsets) - 1)

    def parts(self, cells, steps):
        left, found = list(cells), []
        while left:
            part, waiting = {left[0]}, [left[0]]
            while waiting:
                near = [plus(waiting[0], step) for step in steps]
                new = [n for n in near if n in cells and n not in part]
                part.update(new)
                waiting = [*waiting[1:], *new]
            found.append(part)
            left = [cell for cell in left if cell not in part]
        return found

    def walked(self):
        """The main part, and the cells of space that it touches."""
        steps = [o for o in self.offsets if o[:2] != (0, 0)]
        best, most = set(), -1
        for part in self.parts(self.route or self.space, steps):
            touched = {s for s in self.space if s in part or any(plus(s, o) in part for o in steps)}
            if len(touched) > most:
                best, most, kept = part, len(touched), touched
        return best, kept if best else set(), steps

    def scores(self):
        space, own = self.space, len(self.enclosure)
        n = len(space) or 1
        flood = sum(cell in self.dry for cell in space) / n
        visibility = sum(self.sees(cell) for cell in space) / n / len(self.offsets)
        wet = self.settings.surrounded == "flood"
        enclosed = len(self.dry) if wet else sum(self.weight(cell) for cell in self.box - self.walls)
        inside = flood * n if wet else sum(self.weight(cell) for cell in space)
        space_share = flood if wet else visibility
        share = space_share if self.settings.profile == "paper" else inside / enclosed if enclosed else 0.0
        main, touched, steps = self.walked()
        parts = self.parts(space, self.offsets)
        joins = sum(len(part) for part in parts if part & touched) / n
        reaches = float(any(c in self.outside or any(plus(c, o) in self.outside for o in steps) for c in main))
        return {
            "enclosure_share": share, "space_share": space_share, "symbiotic": (share + space_share) / 2,
            "flood": flood, "visibility": visibility, "enclosed": enclosed,
            "economy": enclosed / (enclosed + own) if own else 0.0, "enclosed_ratio": enclosed / own if own else 0.0,
            "enclosure_cells": own, "space_cells": len(space), "route_cells": len(self.route),
            "overlap": len(set(space) & set(self.enclosure)) / n, "parts": len(parts),
            "i_value": self.i_value(parts), "route": (joins + reaches) / 2, "route_joins": joins,
            "route_reaches": reaches, "doors": len(main & self.walls), "evenness": self.evenness(),
        }  # fmt: skip

    def i_value(self, parts):
        import networkx as nx

        graph = nx.Graph((a, plus(a, o)) for a in self.space for o in self.offsets if plus(a, o) in self.space)
        values = []
        for part in parts:
            k = len(part)
            for cell in part:
                if k <= 2:
                    values.append(1.0)
                    continue
                depth = sum(nx.single_source_shortest_path_length(graph, cell).values())
                ra = 2 * (depth / (k - 1) - 1) / (k - 2)
                values.append(ra / (2 * (k * (np.log2((k + 2) / 3) - 1) + 1) / ((k - 1) * (k - 2))))
        return sum(values) / len(values) if values else 1.0

    def evenness(self):
        sides = [o for o, kind in zip(self.offsets, self.lattice.contacts.tolist(), strict=True) if kind == FACE]
        faces = sum(plus(cell, o) in self.outside for cell in self.walls for o in sides)
        leaving = sum(
            not any(plus(c, o, n) in self.walls for n in range(1, self.longest)) for c in self.walls for o in sides
        )
        return leaving / faces if faces else 0.0
