"""Model ``galasyn``: the thesis' load propagation, vectors shared out joint by joint."""

from __future__ import annotations

from evaluators.blocks.load import _galasyn as kernels
from evaluators.blocks.load.cuts import cuts
from evaluators.blocks.load.load import Load
from evaluators.blocks.load.settings import LoadSettings
from growth.blocks.body import Body


def galasyn(body: Body, settings: LoadSettings) -> Load:
    """Share out the weight above each layer by Galasyn's vectors (Senatore 2009, 'the one block problem').

    Each joint takes a share of the part's weight. What of it lies along the line from the centre of mass to the joint
    is a force there. What lies across turns about the joint; that moment is met by forces on the joints that turn too,
    each at right angles to the line between the two joints, in proportion to their own parts across (Figure 20: the
    outer joints meet each other's, the one in line with the load meets none). If none of the others turns, they share
    equally. In three dimensions the moment's part along the line between two joints has no such force and stays as a
    twist of the first. A joint without others away from it keeps its share and the moment whole.

    Parameters
    ----------
    body, settings
        As for :func:`rigid`.

    Returns
    -------
    Load
        Not in balance in general: ``residual`` says by how much.
    """
    cut = cuts(body, settings)
    return cut.load(
        *kernels.galasyn(cut.layers.points, cut.stiffness, cut.first, cut.order, cut.weights, cut.centres), settings
    )
