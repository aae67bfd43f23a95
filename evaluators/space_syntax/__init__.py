"""Space syntax: how spaces lie in the graph of their connections (Hillier and Hanson 1984; Hillier 1996).

Any undirected graph will do: rooms and their doors, cells and their neighbours. :func:`analyse` gives all measures as a
:class:`SpaceSyntax`; each is a function of its own too.
"""

from evaluators.space_syntax.analysis import SpaceSyntax, analyse
from evaluators.space_syntax.asymmetry import d_value, integration, ra, rra
from evaluators.space_syntax.choice import choice, choice_share
from evaluators.space_syntax.control import connectivity, control
from evaluators.space_syntax.depth import mean_depth, total_depth
from evaluators.space_syntax.graph import Graph, components, of_edges, of_matrix
from evaluators.space_syntax.mean_rra import mean_rra

__all__ = [
    "Graph",
    "SpaceSyntax",
    "analyse",
    "choice",
    "choice_share",
    "components",
    "connectivity",
    "control",
    "d_value",
    "integration",
    "mean_depth",
    "mean_rra",
    "of_edges",
    "of_matrix",
    "ra",
    "rra",
    "total_depth",
]
