"""Drawings of plans: SVG, DXF, IFC, GLB, PNG, and sheets of several plans (Rosenman 1997, Figure 10)."""

from evaluators.plans.drawings.draw import drawing
from evaluators.plans.drawings.drawing import Drawing

__all__ = ["Drawing", "drawing"]
