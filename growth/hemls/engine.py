"""Growth of a HEMLS surface: increase in size within an environment, rewriting, joining (Hemberg 2006, section 4.3)."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator

import numpy as np

from growth.environment import Environment
from growth.hemls import _whole
from growth.hemls.map import HalfEdgeMap, seed
from growth.hemls.program import compile_system
from growth.hemls.rewriting import Rewriting, over_budget, release
from growth.hemls.rules import System
from growth.hemls.settings import SurfaceGrowth
from growth.protocol import Budget, Clock, Failure
from growth.surface import Surface

FARTHEST = 1e9
"""A form with a vertex farther out than this has diverged."""
_FAR = f"a vertex lies farther out than {FARTHEST:g}"


def grow(
    system: System,
    settings: SurfaceGrowth | None = None,
    environment: Environment | None = None,
    clock: Clock = time.thread_time,
) -> Surface | Failure:
    """Grow a surface from a rewrite system.

    Parameters
    ----------
    system
        The rules, as parsed.
    settings
        Steps, scale, budget and the like; the defaults where not given.
    environment
        Forces and boundaries; empty where not given.
    clock
        Tells the time for the safety net behind the budget.

    Returns
    -------
    Surface or Failure
        A failure has the reason ``budget``, ``clock``, ``boundary`` or ``diverged``.
    """
    outcome: HalfEdgeMap | Failure = Failure("budget", "no step was made")
    for outcome in derive(system, settings, environment, clock):
        if isinstance(outcome, Failure):
            return outcome
    assert isinstance(outcome, HalfEdgeMap)
    return outcome.surface(system.labels)


def derive(
    system: System,
    settings: SurfaceGrowth | None = None,
    environment: Environment | None = None,
    clock: Clock = time.thread_time,
) -> Iterator[HalfEdgeMap | Failure]:
    """Give the map after each step, the seed first; the one map is grown on, so copy what is to be kept.

    A failure is the last thing given. Parameters are those of :func:`grow`.
    """
    settings = settings or SurfaceGrowth()
    environment = environment or Environment.empty()
    deadline = clock() + settings.budget.seconds
    m = seed(system.axiom, settings.start_length, settings.place)
    failure = _unfit(m, settings.budget) or release(m, environment, 0)
    if failure is not None:
        yield failure
        return
    yield m
    rewriting = Rewriting(
        map=m,
        program=compile_system(system),
        environment=environment,
        budget=settings.budget,
        branch_angle=system.branch_angle,
        branch_distance=math.inf if settings.branch_distance is None else settings.branch_distance,
        n_labels=len(system.labels),
    )
    for step in range(settings.steps):
        failure = _enlarge(m, settings.scale, environment) or _rewrite(rewriting, system.sync, clock, deadline)
        if failure is not None:
            yield Failure(failure.reason, f"step {step + 1}: {failure.detail}")
            return
        yield m


def _unfit(m: HalfEdgeMap, budget: Budget) -> Failure | None:
    """Tell what keeps a seed from growing."""
    if m.edges > budget.elements:
        return over_budget("edges", m.edges, budget.elements, "max_elements")
    return Failure("diverged", _FAR) if _whole.farther_than(m.points, FARTHEST) else None


def _enlarge(m: HalfEdgeMap, scale: float, environment: Environment) -> Failure | None:
    """Move every vertex away from the centre and along the forces, up to the first boundary."""
    points = m.points[: m.vertices]
    target = np.empty_like(points)
    _whole.enlarge(points, m.vertices, scale, target)
    target += environment.forces(points)
    if _whole.farther_than(target, FARTHEST):
        return Failure("diverged", _FAR)
    m.points[: m.vertices] = environment.move(points, target) if environment.has_hard else target
    return None


def _rewrite(rewriting: Rewriting, sync: bool, clock: Clock, deadline: float) -> Failure | None:
    """Apply the rules, all at once or group by group, each followed by joining."""
    groups = rewriting.program.groups
    if sync:
        chosen = [rewriting.choose(group) for group in groups]
        edges, rules = (np.concatenate([pair[i] for pair in chosen]) for i in range(2))
        failure = rewriting.apply(edges, rules) or rewriting.join()
        if failure is not None:
            return failure
    else:
        for group in groups:
            if clock() > deadline:
                return Failure("clock", "the growth took longer than max_seconds")
            edges, rules = rewriting.choose(group)
            failure = (rewriting.apply(edges, rules) if len(edges) else None) or rewriting.join()
            if failure is not None:
                return failure
    rewriting.finish()
    return Failure("clock", "the growth took longer than max_seconds") if clock() > deadline else None
