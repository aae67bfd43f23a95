"""Species that live in one space as files: walls that are seen through, the space in them, the way through it.

GLB has a node and a material for each, y up; the others keep z up. The same cells give the same bytes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Final, NamedTuple, final

import numpy as np

from genome.errors import InputError
from genome.files import write_whole
from growth.blocks.body import INTERNAL, Body
from growth.blocks.lattice import Ints, Lattice
from growth.blocks.parts import Part, glb, obj, voxels
from growth.blocks.skin import skin
from growth.forms import to_trimesh

COLOURS: Final[Mapping[str, tuple[int, int, int, int]]] = {
    "enclosure": (196, 204, 210, 90),
    "space": (214, 118, 82, 255),
    "route": (58, 104, 140, 255),
}
"""Base colours of the materials: milky glass, fired clay, slate."""

BITS: Final[Mapping[str, int]] = {"enclosure": 1, "space": 2, "route": 4}
"""What a voxel's value is the sum of, by the species that have a cell there."""


@final
class Cohabitants(NamedTuple):
    """The cells of several species in one space; two species may share a cell.

    Attributes
    ----------
    lattice
        Of all.
    enclosure, space, route
        (n, 3) int64, distinct; empty for a species that has nobody here.
    """

    lattice: Lattice
    enclosure: Ints
    space: Ints
    route: Ints

    def of(self, species: str) -> Ints:
        """Give the cells of a species."""
        found: Ints = getattr(self, species)
        return found

    def shown(self) -> dict[str, Ints]:
        """Give the cells of each species that are shown as its own: a route's before the space's before walls'.

        Space carves the walls that it grows into, and a route makes a door of a wall.
        """
        space = without(self.space, self.route)
        walls = without(self.enclosure, np.concatenate([self.space, self.route]))
        found = {"enclosure": walls, "space": space, "route": self.route}
        return {species: cells for species, cells in found.items() if len(cells)}


def without(cells: Ints, others: Ints) -> Ints:
    """Give those of (n, 3) cells that are none of (m, 3) others, in their order."""
    if not len(cells) or not len(others):
        return cells
    _, names = np.unique(np.concatenate([cells, others]), axis=0, return_inverse=True)
    names = names.reshape(-1)
    return np.ascontiguousarray(cells[~np.isin(names[: len(cells)], names[len(cells) :])])


def body_of(cells: Ints, lattice: Lattice) -> Body:
    """Give cells (n, 3) as a body of one system."""
    return Body(lattice, cells, np.full(len(cells), INTERNAL, dtype=np.uint8))


def write_cohabitants(
    company: Cohabitants, path: Path, title: str = "", extras: Mapping[str, str | float | bool] | None = None
) -> None:
    """Write species to a file, whole or not at all.

    Parameters
    ----------
    company
        What to write; one cell at least.
    path
        The file; its suffix chooses the format: ``.glb``, ``.obj``, ``.stl`` or ``.npz``.
    title, extras
        What the form is, kept in GLB (scene extras), OBJ (comments) and the grid (JSON); STL has no place for it.

    Raises
    ------
    InputError
        When the suffix is unknown, there are no cells, the grid would be too large, or the folder cannot be written to.
    """
    writer = WRITERS.get(path.suffix.lower())
    if writer is None:
        got = f"'{path.suffix}'" if path.suffix else "none"
        raise InputError(str(path), f"a suffix of cells ({', '.join(WRITERS)})", got, "choose one of these")
    if not any(len(company.of(species)) for species in BITS):
        raise InputError(str(path), "cells to write", "none")
    words: dict[str, Any] = {"title": title} if title else {}
    write_whole(path, writer(company, {**words, **(extras or {})}))


def _parts(company: Cohabitants) -> list[Part]:
    shown = company.shown()
    return [
        Part(species, skin(body_of(shown[species], company.lattice)), colour, species == "enclosure")
        for species, colour in COLOURS.items()
        if species in shown
    ]


def _glb(company: Cohabitants, extras: Mapping[str, Any]) -> bytes:
    return glb(_parts(company), extras)


def _obj(company: Cohabitants, extras: Mapping[str, Any]) -> bytes:
    return obj(_parts(company), extras)


def _stl(company: Cohabitants, extras: Mapping[str, Any]) -> bytes:
    """Write the walls alone, which can be built; where there are none, what there is."""
    from trimesh.exchange.stl import export_stl

    del extras  # a binary STL file has no place for them
    shown = company.shown()
    cells = shown.get("enclosure", np.concatenate(list(shown.values())))
    return bytes(export_stl(to_trimesh(skin(body_of(np.unique(cells, axis=0), company.lattice)).surface)))


def _npz(company: Cohabitants, extras: Mapping[str, Any]) -> bytes:
    """Write the sum of :data:`BITS` of the species that have a cell there."""
    every = np.concatenate([company.of(species) for species in BITS])
    bits = np.repeat(list(BITS.values()), [len(company.of(species)) for species in BITS])
    cells, names = np.unique(every, axis=0, return_inverse=True)
    values = np.zeros(len(cells), dtype=np.uint8)
    np.add.at(values, names.reshape(-1), bits.astype(np.uint8))
    return voxels(cells, values, company.lattice, extras)


WRITERS: Final[Mapping[str, Callable[[Cohabitants, Mapping[str, Any]], bytes]]] = {
    ".glb": _glb,
    ".obj": _obj,
    ".stl": _stl,
    ".npz": _npz,
}
"""How each suffix is written."""
