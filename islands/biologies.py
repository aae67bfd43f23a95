"""Biologies as they are called for: islands that are alike in all that a biology sees share one."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any, Final, final

from growth.protocol import Clock
from islands.kinds.protocol import Biology, Compiled
from islands.kinds.registry import resolve_kind
from islands.spec import IslandSpec

REMEMBERED: Final = 4
"""Biologies of one group of islands that are kept, the last ones called for: an environment may be large."""


def compile_kernels(islands: Iterable[IslandSpec]) -> None:
    """Let each kind compile what it needs, so that no individual's growth has to wait for it, against its own clock."""
    for name, where in {spec.kind: spec.where("kind") for spec in islands}.items():
        kind = resolve_kind(name, where)
        if isinstance(kind, Compiled):
            kind.compile_kernels()


@final
class Biologies:
    """Makes biologies, and remembers them by group, goals and growth: all in which those of a run may differ.

    An island that is steered to other goals or strengths than its group's calls for another one.

    Parameters
    ----------
    clock
        Of the biologies.
    """

    def __init__(self, clock: Clock) -> None:
        self._clock: Final = clock
        self._made: Final[dict[str, dict[str, Biology[Any]]]] = {}

    def __call__(self, spec: IslandSpec) -> Biology[Any]:
        """Give the biology of an island with these settings.

        Raises
        ------
        InputError
            When its kind makes none of them.
        """
        group = self._made.setdefault(spec.group, {})
        settings = json.dumps([dict(spec.fitness), dict(spec.growth)], sort_keys=True)
        found = group.pop(settings, None)
        if found is None:
            found = resolve_kind(spec.kind, spec.where("kind")).build(spec, self._clock)
        group[settings] = found
        if len(group) > REMEMBERED:
            del group[next(iter(group))]
        return found
