"""Growth of block bodies: words of bracketed L-systems, read by a turtle on a lattice (Senatore 2009, chapter 2).

:mod:`~growth.blocks.lattice` says what cells there are and which touch; :mod:`~growth.blocks.body` is the form.
"""
