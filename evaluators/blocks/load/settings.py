"""How a body of blocks is loaded and what its joints bear: the ``load:`` section of an island of blocks."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, field_validator

from genome.errors import InputError
from genome.settings import Settings, Vector3

Strength = Annotated[float, Field(gt=0, le=1e12)]


class LoadSettings(Settings):
    """Settings of load analysis (Senatore 2009, 'the load propagation model').

    Attributes
    ----------
    model
        ``galasyn`` (the thesis' vectors), ``rigid`` (equilibrium of each part above a layer), ``frame`` (beams between
        block centres), ``limit`` (the largest load factor that the strengths allow).
    axial_strength
        The most that a joint's force may be, in the unit of ``weight``; ``None`` sets no bound.
    torsion_strength
        The most that a joint's moment may be, in weight times the lattice's unit of length; ``None`` sets no bound.
    weight
        Of one block.
    envelope_counts
        Whether blocks of the envelope weigh and bear; else they are not there.
    dimensions
        2 asks for bodies in one plane of x and z and refuses others.
    stages
        Growth under load: the analysis runs at that many evenly spaced prefixes of the internal blocks.
    stiffness
        Of joints over a face, an edge and a vertex, relative to each other.
    """

    model: Literal["galasyn", "rigid", "frame", "limit"] = "rigid"
    axial_strength: Strength | None = None
    torsion_strength: Strength | None = None
    weight: Annotated[float, Field(gt=0, le=1e12)] = 1.0
    envelope_counts: bool = True
    dimensions: Literal[2, 3] = 3
    stages: Annotated[int, Field(ge=1, le=1000)] = 1
    stiffness: Vector3 = (1.0, 1.0, 1.0)

    @field_validator("stiffness")
    @classmethod
    def _stiff(cls, value: Vector3) -> Vector3:
        for one in value:
            if not 1e-6 <= one <= 1e6:
                raise InputError("", "stiffnesses from 1e-6 to 1e6", f"{one:g}")
        return value
