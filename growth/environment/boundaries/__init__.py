"""Boundaries: what growth may not pass (hard) or should not (soft).

Every boundary parts space into a solid and a free side. The convex shapes are exact, in closed form; a mesh is any
closed one that trimesh loads. All answer the same questions, those of ``protocol.py``. A new shape is one file here
and one line in ``registry.py``.
"""
