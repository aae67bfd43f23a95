"""Island kinds: what an island breeds, from the genotype to the scores.

A kind brings the models of its settings and a biology, by which an island makes, crosses, mutates, scores and writes
its individuals (:mod:`~islands.kinds.protocol`); the island itself never looks into a genotype. Built is
:mod:`~islands.kinds.surface`, Genr8's surfaces. A new kind is one file here and one line in
:mod:`~islands.kinds.registry`, or a plug-in.
"""
