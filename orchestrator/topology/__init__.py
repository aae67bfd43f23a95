"""Topologies: a way to write many channels at once.

A topology is a function of the number of islands to directed edges between their places, in ascending order and
without loops. A new one is one file here and one line of the registry.
"""
