"""Growth of timed systems after McCormack: continuous development by events, development functions, words at any time.

``derive`` gives the word at a time; ``begin`` gives a derivation that goes on from one time to the next. Expressions
are compiled once, to instructions of a stack machine, and evaluated by kernels.
"""

from growth.timed.derivation import Derivation, begin, derive
from growth.timed.program import Program, compile_system
from growth.timed.settings import TimedGrowth
from growth.timed.word import Word

__all__ = ["Derivation", "Program", "TimedGrowth", "Word", "begin", "compile_system", "derive"]
