"""The symbols of words, and what the turtle makes of them (Senatore 2009, 'the generative engine')."""

from __future__ import annotations

from typing import Final

FORWARD: Final = "F"
"""One step along the heading, and a block there."""

TURNS: Final = "+-&^£$%"
"""Yaw left and right about z, pitch down and up about y, roll left and right about x, half a turn about z."""

LETTERS: Final = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
"""What rules rewrite and match; the turtle passes over all but :data:`FORWARD`."""

OPEN: Final = "["
CLOSE: Final = "]"
SIBLING: Final = "|"

SYMBOLS: Final = TURNS + LETTERS
"""Whatever may stand in a word by itself."""

ALPHABET: Final = TURNS + OPEN + CLOSE + SIBLING + LETTERS
"""All characters of a written word; the engine's code of one is its place here."""

SPELLINGS: Final = {"f": "£"}
"""Other ways to write a symbol, read and never written: the thesis as printed has an f for the pound sign."""

EXPECTED: Final = "a symbol (a capital letter, + - & ^ £ $ %) or a bracket ([ | ])"
