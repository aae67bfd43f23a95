"""Published behaviour of island models, reproduced by the engine that runs experiments.

Each check runs islands of bit strings through :meth:`islands.island.Island.advance` and the channels' own edges, not
on Ray and without a log, and compares means or shares with figures from outside by intervals that allow for the
number of comparisons. The seeds are fixed, so that a check passes or fails for good.
"""
