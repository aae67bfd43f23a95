"""Refining a form for making: repair, remeshing, smoothing, and a solid for printing, by pymeshlab.

A step takes a mesh and gives a mesh. ``STEPS`` has them by name; a recipe is a list of names, done in order. pymeshlab
is imported where a step runs, for it is large and wants a graphics library that bare machines lack.
"""

from growth.refining.files import read_form
from growth.refining.mesh import Mesh, Quality, quality
from growth.refining.recipe import STEPS, RefineSettings, parse_recipe, refine

__all__ = ["STEPS", "Mesh", "Quality", "RefineSettings", "parse_recipe", "quality", "read_form", "refine"]
