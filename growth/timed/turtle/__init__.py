"""The turtle: it walks along a word and draws parts in space (McCormack, section 4)."""

from growth.timed.turtle.drawing import draw
from growth.timed.turtle.settings import TurtleSettings
from growth.timed.turtle.unknown import unknown_symbols

__all__ = ["TurtleSettings", "draw", "unknown_symbols"]
