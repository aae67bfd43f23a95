"""Finds a criterion of symbiotic species by its name: one of the project's, an import path, or an installed plug-in's.

To add one, write it in a file of its own and name it in :data:`SYMBIOSIS_CRITERIA`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Final

from evaluators.catalogue import Catalogue
from evaluators.symbiosis.counts import enclosure_cells, route_cells, space_cells
from evaluators.symbiosis.evenness import evenness
from evaluators.symbiosis.exposure import particles, sun
from evaluators.symbiosis.i_value import i_value
from evaluators.symbiosis.overlap import overlap
from evaluators.symbiosis.parts import parts
from evaluators.symbiosis.readings import flood, visibility
from evaluators.symbiosis.route import doors, route, route_joins, route_reaches
from evaluators.symbiosis.shares import enclosure_share, space_share, symbiotic
from evaluators.symbiosis.symbiosis import Symbiosis
from evaluators.symbiosis.volume import economy, enclosed, enclosed_ratio

SymbiosisCriterion = Callable[[Symbiosis], float]
"""A function of partners in one space to one finite number; it changes nothing."""

LOGGED: Final[Mapping[str, SymbiosisCriterion]] = MappingProxyType(
    {
        "enclosure_share": enclosure_share,
        "space_share": space_share,
        "symbiotic": symbiotic,
        "flood": flood,
        "visibility": visibility,
        "enclosed": enclosed,
        "economy": economy,
        "enclosed_ratio": enclosed_ratio,
        "enclosure_cells": enclosure_cells,
        "space_cells": space_cells,
        "route_cells": route_cells,
        "overlap": overlap,
        "parts": parts,
        "i_value": i_value,
        "route": route,
        "route_joins": route_joins,
        "route_reaches": route_reaches,
        "doors": doors,
        "evenness": evenness,
    }
)
"""Those that are logged with every individual that has its partners."""

SYMBIOSIS_CRITERIA: Final[Mapping[str, SymbiosisCriterion]] = MappingProxyType(
    {**LOGGED, "sun": sun, "particles": particles}
)
"""The project's own criteria of symbiotic species; the last two take long, and are scored where there is a goal."""

_FOUND: Final = Catalogue[SymbiosisCriterion](SYMBIOSIS_CRITERIA)
resolve = _FOUND.resolve
resolve_all = _FOUND.resolve_all
