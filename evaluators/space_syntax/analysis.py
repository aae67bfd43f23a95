"""All measures of space syntax at once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from evaluators.space_syntax.asymmetry import integration, ra, rra
from evaluators.space_syntax.choice import choice, choice_share
from evaluators.space_syntax.control import connectivity, control
from evaluators.space_syntax.depth import mean_depth, total_depth
from evaluators.space_syntax.graph import Graph, components
from evaluators.space_syntax.missing import Values

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]


@final
@dataclass(frozen=True, slots=True, eq=False)
class SpaceSyntax:
    """Measures of n spaces, each within its own connected component of k spaces; arrays are (n,).

    Attributes
    ----------
    component
        int64, the component that each space is in, numbered in the order of their first spaces.
    sizes
        (c,) int64, the number of spaces in each component.
    total_depth
        int64.
    mean_depth
        Masked float64; no value for k = 1.
    ra, rra, integration, choice_share
        Masked float64; no value for k of 2 or less. Integration is infinite for a space that is next to all others.
    connectivity
        int64.
    control, choice
        float64.
    """

    component: Ints
    sizes: Ints
    total_depth: Ints
    mean_depth: Values
    ra: Values
    rra: Values
    integration: Values
    connectivity: Ints
    control: Floats
    choice: Floats
    choice_share: Values

    @property
    def connected(self) -> bool:
        """Whether all spaces hang together; none at all do."""
        return self.sizes.size <= 1


def analyse(graph: Graph) -> SpaceSyntax:
    """Measure every space of a graph.

    Parameters
    ----------
    graph
        As :func:`~evaluators.space_syntax.graph.of_edges` or :func:`~evaluators.space_syntax.graph.of_matrix` makes it;
        may be empty, and need not be connected: figures are those of each component by itself.
    """
    component, sizes = components(graph)
    own = sizes[component]
    total = total_depth(graph)
    mean = mean_depth(total, own)
    relative = ra(mean, own)
    real = rra(relative, own)
    through = choice(graph)
    return SpaceSyntax(
        component, sizes, total, mean, relative, real, integration(real), connectivity(graph), control(graph), through,
        choice_share(through, own),
    )  # fmt: skip
