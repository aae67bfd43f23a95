"""HEMLS surfaces: Hemberg extended map L-systems, the growth engine of Genr8 (Hemberg and O'Reilly 2006, section 4).

A rewrite system replaces the edges of a map, and the branches that the successors leave are joined across regions, so
that a polygon grows into a surface. Between rewritings the surface grows in size and gives way to forces and
boundaries. The modules follow the way of a rule: its text (:mod:`~growth.hemls.rules`), its drawing
(:mod:`~growth.hemls.template`), its arrays (:mod:`~growth.hemls.program`), its application
(:mod:`~growth.hemls.rewriting`) to a map (:mod:`~growth.hemls.map`), and the steps of growth
(:mod:`~growth.hemls.engine`).
"""

from growth.hemls.engine import derive, grow
from growth.hemls.rules import System, parse_system
from growth.hemls.settings import SurfaceGrowth

__all__ = ["SurfaceGrowth", "System", "derive", "grow", "parse_system"]
