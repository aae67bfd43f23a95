"""Variation of timed systems: their numbers and their productions, so that every child is a system of the language.

``Breeder`` draws, mutates and crosses :class:`~genome.timed.genotype.TimedGenotype` values; what is new in a
production is written by grammatical evolution, in a grammar that is the system's own unless another is named.
"""

from genome.timed.variation.alphabet import own_grammar
from genome.timed.variation.breeder import Breeder, load_breeder
from genome.timed.variation.loading import named_path, shipped_systems, system_text
from genome.timed.variation.settings import NumberBounds, ProductionRates, TimedGenome
from genome.timed.variation.structure import bare_productions, differs_in_production, distances, diversity, stochastic

__all__ = [
    "Breeder",
    "NumberBounds",
    "ProductionRates",
    "TimedGenome",
    "bare_productions",
    "differs_in_production",
    "distances",
    "diversity",
    "load_breeder",
    "named_path",
    "own_grammar",
    "shipped_systems",
    "stochastic",
    "system_text",
]
