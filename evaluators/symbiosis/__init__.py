"""Criteria of species that evolve by each other: enclosures, the space in them, and routes through it.

A good enclosure surrounds much of its space, and a good space lies for the most part in its enclosure (Coates,
Broughton and Jackson 1999, as Senatore 2009 has it, 'coevolutionary approach to architecture').
"""

from evaluators.symbiosis.settings import SymbiosisSettings
from evaluators.symbiosis.symbiosis import ROLES, Role, Symbiosis

__all__ = ["ROLES", "Role", "Symbiosis", "SymbiosisSettings"]
