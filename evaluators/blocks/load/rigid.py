"""Model ``rigid``: what stands above a layer is a rigid body on elastic joints."""

from __future__ import annotations

from evaluators.blocks.load import _rigid as kernels
from evaluators.blocks.load.cuts import cuts
from evaluators.blocks.load.layers import TURNING
from evaluators.blocks.load.load import Load
from evaluators.blocks.load.settings import LoadSettings
from growth.blocks.body import Body


def rigid(body: Body, settings: LoadSettings) -> Load:
    """Let each connected part above each layer stand as a rigid body on elastic joints.

    The six equations of equilibrium of each part decide (semantics.md, section 4, model ``rigid``). A joint resists a
    displacement of the part there with a force in the opposite direction, and its turn with a moment, in the ratio
    :data:`~evaluators.blocks.load.layers.TURNING`, the same in all directions.

    Parameters
    ----------
    body
        A body; what floats carries nothing.
    settings
        Stiffness, weight and strengths.

    Returns
    -------
    Load
        In balance but for rounding: ``residual`` stays under 1e-9.
    """
    cut = cuts(body, settings)
    points = cut.layers.points
    return cut.load(
        *kernels.rigid(points, cut.stiffness, TURNING, cut.first, cut.order, cut.weights, cut.centres), settings
    )
