"""Migration: channels carry packets of migrants from deme to deme.

At an epoch's end each outgoing edge of an island chooses emigrants from its deme (:mod:`islands.migration.emigrants`)
and sends them as a :class:`~islands.migration.channel.Packet` of plain values. At the start of the next epoch, before
the first selection, the target lets them join (:mod:`islands.migration.replacement`) in the order of its channels.
"""
