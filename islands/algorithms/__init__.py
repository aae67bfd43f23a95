"""How a deme turns one generation into the next: one file an algorithm.

All of them breed alike (:mod:`~islands.algorithms.breeding`). An algorithm says how many offspring there are, and who
of them and of their parents makes the next deme (:mod:`~islands.algorithms.scheme`).
"""
