"""Load analysis of a body by any of the models."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Final

from evaluators.blocks.load.frame import frame
from evaluators.blocks.load.galasyn import galasyn
from evaluators.blocks.load.limit import limit
from evaluators.blocks.load.load import Load
from evaluators.blocks.load.rigid import rigid
from evaluators.blocks.load.settings import LoadSettings
from genome.errors import InputError
from growth.blocks.body import Body

Model = Callable[[Body, LoadSettings], Load]

MODELS: Final[Mapping[str, Model]] = MappingProxyType(
    {"galasyn": galasyn, "rigid": rigid, "frame": frame, "limit": limit}
)
"""The models by the names that settings use."""


def analyse(body: Body, settings: LoadSettings) -> Load:
    """Find what each joint of a body carries.

    Parameters
    ----------
    body
        Its cells are all different. One without boundary floats as a whole.
    settings
        The model, strengths and weight; ``stages`` is not looked at
        (:func:`~evaluators.blocks.load.stages.grown_under_load`).

    Raises
    ------
    InputError
        For a body that does not lie in one plane of x and z, when two dimensions are asked for.
    """
    if settings.dimensions == 2 and not planar(body):
        raise InputError(
            "load.dimensions", "a body in one plane of x and z", "blocks at different y", "use dimensions: 3"
        )
    return MODELS[settings.model](body, settings)


def planar(body: Body) -> bool:
    """Tell whether all cells have one y."""
    return not len(body.cells) or bool((body.cells[:, 1] == body.cells[0, 1]).all())
