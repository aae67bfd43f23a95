"""The two stores behind :class:`islands.store.Store`: a local disk, and any other file system of Arrow.

:mod:`~islands.stores.places` reads the places that people write, :mod:`~islands.stores.s3` opens S3, and
:mod:`~islands.stores.troubles` says what went wrong with a store and what to do about it.
"""
