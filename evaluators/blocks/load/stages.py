"""Growth under load: a body must stand at every stage of its growth (Senatore 2009, 'morphogenesis under load')."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from evaluators.blocks.load.analysis import analyse, planar
from evaluators.blocks.load.load import Load
from evaluators.blocks.load.settings import LoadSettings
from growth.blocks.body import Body
from growth.protocol import Failure

if TYPE_CHECKING:
    from growth.blocks import BlockGrowth


def grown_under_load(body: Body, growth: BlockGrowth, settings: LoadSettings) -> Load | Failure:
    """Analyse a body at stages of its growth.

    Parameters
    ----------
    body
        The body; its internal blocks are in the order in which they grew.
    growth
        How it grew: what stages stand on, and whether they have an envelope.
    settings
        With the number of stages s. Stage i holds the first n i / s of the n internal blocks, rounded up; a stage
        without a block more than the one before is not analysed again.

    Returns
    -------
    Load or Failure
        The load of the body itself, with the margins of all stages; or ``unstable`` with what fails at the first stage
        that does not stand.
    """
    if settings.dimensions == 2 and not planar(body):
        return Failure("load", "a body in one plane of x and z is wanted (dimensions: 2), its blocks differ in y")
    loads: list[Load] = []
    for stage, (present, load) in enumerate(_stages(body, growth, settings), 1):
        if not load.stable:
            return Failure("unstable", f"{why_unstable(present, load, settings)} at stage {stage} of {settings.stages}")
        loads.append(load)
    return _whole(loads)


def loaded_throughout(body: Body, growth: BlockGrowth, settings: LoadSettings) -> Load:
    """Analyse a body at stages of its growth, whether it stands at them or not; as :func:`grown_under_load` otherwise.

    Raises
    ------
    InputError
        When two dimensions are asked for, and the body has three.
    """
    return _whole([load for _, load in _stages(body, growth, settings)])


def _stages(body: Body, growth: BlockGrowth, settings: LoadSettings) -> Iterator[tuple[Body, Load]]:
    """Give what is there at each stage, and its load."""
    from growth.blocks import stand

    count, stages = len(body.internal), settings.stages
    sizes = [-(-count * stage // stages) for stage in range(1, stages + 1)]
    load: Load | None = None
    present = body
    for stage, size in enumerate(sizes, 1):
        if load is None or size != sizes[stage - 2]:
            present = body if stage == stages or size == count else stand(body.internal[:size], growth)
            load = analyse(present, settings)
        yield present, load


def _whole(loads: Sequence[Load]) -> Load:
    return replace(loads[-1], margins=tuple(load.margin for load in loads))


def why_unstable(body: Body, load: Load, settings: LoadSettings) -> str:
    """Say what does not hold: the blocks that float, the load factor, or the joint farthest over its strength.

    Parameters
    ----------
    body, load, settings
        A body, its load, which is not stable, and how it was analysed.

    Returns
    -------
    str
        As in "joint (0,0,0)-(0,0,1): torsional 12.3 over 10 (and 3 more joints)".
    """
    if load.floating.size:
        first = _cell(body, int(load.floating[0]))
        if not len(body.boundary):
            return f"the body touches no ground: all its {load.floating.size} blocks float"
        return f"block {first}{_more(load.floating.size, 'block')} joined to no ground"
    if load.failed.size:
        place = int(load.failed[0])
        a, b = load.joints[place].tolist()
        broken = [
            f"{name} {carried[place]:.6g} over {strength:g}"
            for name, carried, strength in (
                ("translational", load.translational, settings.axial_strength),
                ("torsional", load.torsional, settings.torsion_strength),
            )
            if strength is not None and carried[place] > strength
        ]
        return f"joint {_cell(body, a)}-{_cell(body, b)}: {', '.join(broken)}{_more(load.failed.size, 'joint')}"
    return f"the joints bear {load.factor:.6g} times the weight"


def _cell(body: Body, place: int) -> str:
    x, y, z = body.cells[place].tolist()
    return f"({x},{y},{z})"


def _more(count: int, noun: str) -> str:
    return "" if count == 1 else f" (and {count - 1} more {noun}{'s' if count > 2 else ''})"
