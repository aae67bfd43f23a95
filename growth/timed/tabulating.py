"""Computing the tables of cross-sections and surfaces from the expressions that files have for them."""

from __future__ import annotations

from typing import final

import numpy as np

from genome.errors import InputError
from genome.timed import Expression, Section, Sheet
from growth.timed import _expressions
from growth.timed.assembler import Assembler, Place
from growth.timed.figures import CELLS, SAMPLES, Figures
from growth.timed.tables import NONE, TROUBLES, Floats


@final
class Tabulator:
    """Computes the tables of a system and those inside it, and keeps which code has which."""

    def __init__(self) -> None:
        self.sections: list[Floats] = []
        self.surfaces: list[Floats] = []
        self.places: dict[tuple[int, str], tuple[int, int]] = {}
        self.rows: list[tuple[int, int]] = []

    def add(self, place: Place) -> None:
        """Compute the tables of a system's own sections and surfaces, its defines known.

        Raises
        ------
        InputError
            When a radius is not over 0, or a value is not finite.
        """
        system = place.scope.system
        for section in system.sections:
            self.places[id(system), section.symbol] = (len(self.sections), NONE)
            self.sections.append(_radii(section, place))
        for sheet in system.surfaces:
            self.places[id(system), sheet.symbol] = (NONE, len(self.surfaces))
            self.surfaces.append(_lattice(sheet, place))

    def choose(self, place: Place | None, command: str) -> None:
        """Say which command the next code is, and whose."""
        nothing = (NONE, NONE)
        self.rows.append(nothing if place is None else self.places.get((id(place.scope.system), command), nothing))

    def figures(self) -> Figures:
        """Give what was found."""
        rows = np.array(self.rows, dtype=np.int64).reshape(-1, 2)
        sections, surfaces = np.array(self.sections).reshape(-1, SAMPLES), np.array(self.surfaces)
        side = CELLS + 1
        return Figures(sections, surfaces.reshape(-1, side, side, 3), rows[:, 0].copy(), rows[:, 1].copy())


def _radii(section: Section, place: Place) -> Floats:
    angles = 2.0 * np.pi * np.arange(SAMPLES) / SAMPLES
    values = _values(section, section.radius, angles[:, None], place)
    at = int(np.argmin(values))
    if values[at] <= 0.0:
        where = place.scope.system.complaint_place(section.at)
        got = f"{values[at]:.6g} at {section.names[0]} = {angles[at]:.6g}"
        raise InputError(where, f"a radius of {section.symbol} over 0 at every angle", got, "see docs/formats/tl.md")
    return values


def _lattice(sheet: Sheet, place: Place) -> Floats:
    steps = np.arange(CELLS + 1) / CELLS
    u, v = np.meshgrid(steps, steps, indexing="ij")
    given = np.stack([u.reshape(-1), v.reshape(-1)], axis=1)
    places = [_values(sheet, expression, given, place) for expression in sheet.place]
    return np.stack(places, axis=1).reshape(CELLS + 1, CELLS + 1, 3)


def _values(figure: Section | Sheet, expression: Expression, given: Floats, place: Place) -> Floats:
    """Evaluate an expression for rows of values of a figure's names."""
    names = figure.names
    assembler = Assembler(len(names))
    number = assembler.add(expression, place.meanings({name: slot for slot, name in enumerate(names)}), place)
    ops, args = np.array(assembler.ops, dtype=np.int64), np.array(assembler.args, dtype=np.float64)
    spans = np.array(assembler.spans, dtype=np.int64)
    values, trouble, at = _expressions.sampled(ops, args, spans, number, given, assembler.room)
    if trouble:
        told = ", ".join(f"{name} = {value:.6g}" for name, value in zip(names, given[at].tolist(), strict=True))
        where = place.scope.system.complaint_place(figure.at)
        raise InputError(where, f"values of {figure.symbol}", f"{TROUBLES[trouble]}, at {told}")
    return np.asarray(values)
