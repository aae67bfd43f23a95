"""Topologies: a way to write many channels at once.

A topology lays directed edges between the places 0, 1, ... of a number of islands. One without parameters is a function
of that number to pairs of places; one with parameters is a settings model with a method ``links``
(:mod:`~orchestrator.topology.protocol`). A new one is one file here and one line of the registry, or a plug-in.
"""
