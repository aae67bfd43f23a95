"""The turtle: it walks along a word and draws parts in space (McCormack, section 4)."""

from growth.timed.turtle.drawing import draw
from growth.timed.turtle.settings import TurtleSettings

__all__ = ["TurtleSettings", "draw"]
