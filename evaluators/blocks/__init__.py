"""Criteria of block bodies (Senatore 2009, chapters 1 and 3), and the load on them.

A criterion is a function of a :class:`~evaluators.blocks.structure.Structure`, a body and what its joints carry.
:mod:`~evaluators.blocks.load` finds the latter.
"""

from evaluators.blocks.registry import BLOCK_CRITERIA, BlockCriterion, resolve, resolve_all
from evaluators.blocks.score import score
from evaluators.blocks.structure import Structure

__all__ = ["BLOCK_CRITERIA", "BlockCriterion", "Structure", "resolve", "resolve_all", "score"]
