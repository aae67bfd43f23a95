"""Recipes: which steps, in which order. A new step is one file and one line here."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Annotated, Final

from pydantic import Field

from genome.errors import InputError
from genome.settings import Settings, near
from growth.protocol import Failure
from growth.refining.clean import clean
from growth.refining.mesh import Mesh
from growth.refining.remesh import remesh
from growth.refining.smooth import smooth
from growth.refining.solid import solid


class RefineSettings(Settings):
    """Settings of the steps, lengths in the form's unit.

    Attributes
    ----------
    length
        How long the edges of a remeshed form are; 2% of the bounding box's diagonal without.
    rounds
        How often smoothing moves the vertices forth and back.
    thickness
        How thick a surface becomes as a solid; 2% of the diagonal without.
    """

    length: Annotated[float, Field(gt=0, le=1e9)] | None = None
    rounds: Annotated[int, Field(ge=1, le=10_000)] = 10
    thickness: Annotated[float, Field(gt=0, le=1e9)] | None = None


Step = Callable[[Mesh, RefineSettings], Mesh | Failure]

STEPS: Final[Mapping[str, Step]] = {"clean": clean, "remesh": remesh, "smooth": smooth, "solid": solid}
"""The steps by name."""


def parse_recipe(text: str) -> tuple[str, ...]:
    """Read names with commas or blanks between them.

    Raises
    ------
    InputError
        For a step that there is none of, and for no step at all.
    """
    names = tuple(text.replace(",", " ").split())
    if not names:
        raise InputError("--recipe", f"steps: {', '.join(STEPS)}", "none", "for example --recipe clean,solid")
    for name in names:
        if name not in STEPS:
            raise InputError("--recipe", f"steps: {', '.join(STEPS)}", f"'{name}'", near(name, list(STEPS)))
    return names


def refine(mesh: Mesh, recipe: Sequence[str], settings: RefineSettings | None = None) -> Mesh | Failure:
    """Do the steps of a recipe one after the other.

    Returns
    -------
    Mesh or Failure
        The failure of the first step that fails, of the reason ``refining``.

    Raises
    ------
    InputError
        When pymeshlab cannot be used on this machine.
    """
    for name in recipe:
        found = STEPS[name](mesh, settings or RefineSettings())
        if isinstance(found, Failure):
            return found
        mesh = found
    return mesh
