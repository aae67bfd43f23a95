"""Settings of all tests."""

from __future__ import annotations

from hypothesis import HealthCheck, settings

# No test is to fail because the machine is busy.
settings.register_profile("atoll", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("atoll")
