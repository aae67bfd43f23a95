"""Migration: channels carry packets from island to island.

At an epoch's end each outgoing edge of an island sends one :class:`~islands.migration.channel.Packet` of plain values
(:mod:`islands.migration.departures`), for which members are chosen (:mod:`islands.migration.emigrants`) when the
channel's conditions hold (:mod:`islands.migration.triggers`). At the start of the next epoch, before the first
selection, the target takes it in: migrants stand at its gate (:mod:`islands.migration.gate`), where some are let in, in
place of residents (:mod:`islands.migration.replacement`), translated on the way where genomes differ
(:mod:`islands.migration.adapters`); partners, components and surroundings are held (:mod:`islands.holdings`).
:mod:`islands.migration.routes` knows which edges there are.
"""
