"""Criteria of species that evolve by each other: enclosures, the space in them, and routes through it.

A good enclosure surrounds much of its space, and a good space lies for the most part in its enclosure (Coates,
Broughton and Jackson 1999, as Senatore 2009 has it, 'coevolutionary approach to architecture').
"""

from evaluators.symbiosis.registry import LOGGED, SYMBIOSIS_CRITERIA, SymbiosisCriterion, resolve, resolve_all
from evaluators.symbiosis.score import score
from evaluators.symbiosis.settings import SymbiosisSettings
from evaluators.symbiosis.surroundings import Surroundings, surroundings
from evaluators.symbiosis.symbiosis import ROLES, Role, Symbiosis

__all__ = [
    "LOGGED",
    "ROLES",
    "SYMBIOSIS_CRITERIA",
    "Role",
    "Surroundings",
    "Symbiosis",
    "SymbiosisCriterion",
    "SymbiosisSettings",
    "resolve",
    "resolve_all",
    "score",
    "surroundings",
]
