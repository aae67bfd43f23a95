"""Interventions: what somebody asks of islands while they evolve; one file a command.

An :class:`~islands.interventions.intervention.Intervention` is plain values. At the start of the epoch at which it
takes effect, an island lets it change who lives there and what it is steered to (:mod:`islands.steered`, a part of its
state): a pure function, told by an event for each island. First come those that change goals, rates and members, in
their order; then what channels brought other than migrants is taken in, and the deme is scored again where that or new
goals ask for it; then those who are inserted join, and then migrants.
"""
