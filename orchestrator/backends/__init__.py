"""Backends perform the archipelago's instructions and report events: in this process, or on Ray."""
