"""Bracketed, stochastic, context-sensitive L-systems: the genotype of block bodies (Senatore 2009, chapter 2).

A genotype is an :class:`LSystem`: an axiom and production rules, whose words are trees, so that a malformed one cannot
be made. Variation works on the rules' successors alone. ``docs/formats/blocks.md`` describes the file.
"""

from genome.lsystem.crossover import crossover
from genome.lsystem.diversity import system_diversity
from genome.lsystem.encoding import decode, encode
from genome.lsystem.initial import random_system
from genome.lsystem.mutation import mutate
from genome.lsystem.settings import LSystemGenome, MutationRates
from genome.lsystem.system import LSystem, Rule
from genome.lsystem.text import format_blocks, parse_blocks
from genome.lsystem.word import Branch, Word, parse_word

__all__ = [
    "Branch",
    "LSystem",
    "LSystemGenome",
    "MutationRates",
    "Rule",
    "Word",
    "crossover",
    "decode",
    "encode",
    "format_blocks",
    "mutate",
    "parse_blocks",
    "parse_word",
    "random_system",
    "system_diversity",
]
