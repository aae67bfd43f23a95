"""The islands: demes that evolve apart from each other, and the few migrants that travel between them.

An island is a pure function (:mod:`~islands.island`): its state and who arrives give its next state, who departs, and
the records of what happened. It draws from random streams of its own (:mod:`~islands.streams`), so that a run gives the
same on any number of processes. What it breeds is a matter of its kind (:mod:`~islands.kinds`), how of its algorithm
(:mod:`~islands.algorithms`), who travels of :mod:`~islands.migration`, and whom and where it is scored with of what it
holds (:mod:`~islands.holdings`, :mod:`~islands.pairings`, :mod:`~islands.context`). A host (:mod:`~islands.host`) holds
several islands, steps them, and writes their part of the log (:mod:`~islands.log`, in the frozen schemas of
:mod:`~islands.schemas`). :mod:`~islands.actor` makes a host a Ray
actor, and is the only module here that knows Ray.
"""
