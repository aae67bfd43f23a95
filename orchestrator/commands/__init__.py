"""The commands of ``atoll``: one module each, imported when it is called.

Each module holds its click command as ``command``. It reads its options, calls the orchestrator, and prints; the work
is done elsewhere. :mod:`orchestrator.cli` lists them and turns errors into one message and an exit code.
"""
