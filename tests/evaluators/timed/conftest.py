"""Settings of the tests of timed forms' criteria."""

from __future__ import annotations

import pytest

from growth.timed.warm import compile_kernels


@pytest.fixture(scope="session", autouse=True)
def _compiled():
    """Compile first: with a cold cache, compiling would count against the clock of the first form's growth."""
    compile_kernels()
