"""Criteria of block bodies, and the load on them."""
