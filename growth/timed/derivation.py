"""Derivation by events: the word of a timed system at any time, whichever times came before (McCormack, section 3.1).

A module dies at the instant at which it reaches its terminal age; its children are born then. Instants are computed
from instants, never from the times asked for, and what a module draws at random is a function of its lineage: a
derivation that goes on from an earlier time gives the same bits as one from the axiom.
"""

from __future__ import annotations

import math
import time as clocks
from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from genome.errors import InputError
from genome.settings import describe
from genome.timed import TimedSystem, check_system
from growth.protocol import Clock, Failure
from growth.timed import _rewriting, _words
from growth.timed.program import Program, compile_system
from growth.timed.settings import TimedGrowth
from growth.timed.tables import CODE, DIES, EVENTS, KEY, MODULES, ROLES, START, START_CODE, TROUBLES, Ints, Modules
from growth.timed.word import Word

CLOSE: Final = 2.0**-40
"""Instants that differ by less than this part of them are one: 0.1 thrice is 0.3."""

SEEDS: Final = 2**63
"""Seeds are integers from 0 up to, and without, this."""

_NOBODY: Final = np.empty((0, 2), dtype=np.int64)


@final
@dataclass(frozen=True, slots=True, eq=False)
class Derivation:
    """A timed system at one time, to go on from. :func:`begin` makes one.

    Attributes
    ----------
    program
        The system, compiled.
    seed
        Decides what is drawn at random.
    budget
        How much it may grow.
    time
        The time, in the system's own unit.
    state
        The modules at that time.
    events
        How many births and askings of productions there have been.
    """

    program: Program
    seed: int
    budget: TimedGrowth
    time: float
    state: Modules
    events: int

    def at(self, time: float, clock: Clock = clocks.thread_time) -> Derivation | Failure:
        """Derive up to a time; an earlier one is derived anew from the axiom.

        Returns
        -------
        Derivation or Failure
            Equal to the direct derivation bit for bit. A failure has the reason ``expression`` (something in an
            expression, named with module and time), ``budget`` or ``clock``; this derivation stays as it is.

        Raises
        ------
        InputError
            When the time is negative or not finite.
        """
        if not 0.0 <= time < math.inf:
            raise InputError("time", "a time of 0 or more", describe(time))
        origin = self if time >= self.time else _at_the_axiom(self.program, self.seed, self.budget)
        deadline = clock() + self.budget.max_seconds
        horizon = time + time * CLOSE
        advance = _by_instants if self.program.contextual else _at_once
        reached = advance(origin, horizon, deadline, clock)
        if isinstance(reached, Failure):
            return reached
        state, events = reached
        if len(state.whole) > self.budget.max_modules:
            return _too_large(MODULES, self.budget, time)
        return replace(self, time=time, state=state, events=events)

    def word(self) -> Word | Failure:
        """Apply the development functions.

        Returns
        -------
        Word or Failure
            A failure has the reason ``expression``, with module and time.
        """
        program, state = self.program, self.state
        ages, factors, values, trouble, at = _words.developed(program.tables, state, self.time)
        if trouble:
            module = _described(program, _rewriting.alone(*state, at))
            role = f"the development function of {module}"
            return Failure("expression", f"{TROUBLES[trouble]}, in {role} at time {self.time:.9g}")
        codes, starts = state.whole[:, CODE].copy(), np.append(state.whole[:, START], len(values))
        return Word(self.time, program.names, program.commands, codes, starts, values, ages, factors,
                    program.radians, state.whole[:, KEY].copy(), program.figures)  # fmt: skip


def begin(system: TimedSystem, seed: int = 0, budget: TimedGrowth | None = None) -> Derivation | Failure:
    """Begin a derivation, at time 0.

    Parameters
    ----------
    system
        The genotype.
    seed
        From 0 up to 2**63 - 1; decides what is drawn at random.
    budget
        How much it may grow; the defaults where not given.

    Returns
    -------
    Derivation or Failure
        A failure has the reason ``rules`` where the parts of the system do not fit together; otherwise as of
        :meth:`Derivation.at`, for modules die at time 0, too.

    Raises
    ------
    InputError
        When the seed is none.
    """
    if type(seed) is not int or not 0 <= seed < SEEDS:
        raise InputError("seed", "a whole number from 0 to 2**63 - 1", describe(seed))
    try:
        check_system(system)
        program = compile_system(system)
    except InputError as error:
        return Failure("rules", str(error))
    return _at_the_axiom(program, seed, budget or TimedGrowth()).at(0.0)


def derive(
    system: TimedSystem,
    time: float,
    seed: int = 0,
    budget: TimedGrowth | None = None,
    clock: Clock = clocks.thread_time,
) -> Word | Failure:
    """Give the word of a system at a time. Parameters and failures as of :func:`begin` and :meth:`Derivation.at`."""
    derivation = begin(system, seed, budget)
    if isinstance(derivation, Failure):
        return derivation
    reached = derivation.at(time, clock)
    return reached if isinstance(reached, Failure) else reached.word()


def _at_the_axiom(program: Program, seed: int, budget: TimedGrowth) -> Derivation:
    """Give the one module that the axiom comes from at time 0."""
    whole = np.array([[START_CODE, 0, seed, 0, 0]], dtype=np.int64)
    state = Modules(whole, np.zeros((1, 2)), np.empty(0))
    return Derivation(program, seed, budget, 0.0, state, 0)


_Reached = tuple[Modules, int] | Failure


def _at_once(origin: Derivation, horizon: float, deadline: float, clock: Clock) -> _Reached:
    """Rewrite every module by itself up to the horizon: without contexts none has to do with another."""
    reached = _advanced(origin, origin.state, horizon, origin.events, _NOBODY, deep=True)
    return Failure("clock", "the growth took longer than max_seconds") if clock() > deadline else reached


def _by_instants(origin: Derivation, horizon: float, deadline: float, clock: Clock) -> _Reached:
    """Rewrite instant by instant; all who die at one see the word as it stood before it."""
    state, events = origin.state, origin.events
    while True:
        instant = float(state.reals[:, DIES].min(initial=math.inf))
        if instant > horizon:
            return state, events
        sides = _words.neighbours(state.whole, origin.program.tables.symbols)
        reached = _advanced(origin, state, instant + abs(instant) * CLOSE, events, sides, deep=False)
        if isinstance(reached, Failure):
            return reached
        state, events = reached
        if clock() > deadline:
            return Failure("clock", "the growth took longer than max_seconds")


def _advanced(origin: Derivation, state: Modules, limit: float, events: int, sides: Ints, *, deep: bool) -> _Reached:
    program, budget = origin.program, origin.budget
    state, events, trouble, role = _rewriting.advanced(
        program.tables, state, limit, deep, sides, events, budget.max_events, budget.max_modules
    )
    if trouble in (EVENTS, MODULES):
        return _too_large(trouble, budget, limit)
    if trouble:
        what = f"{ROLES[role]} of {_described(program, state)} at time {float(state.reals[0, DIES]):.9g}"
        return Failure("expression", f"{TROUBLES[trouble]}, in {what}")
    return state, events


def _too_large(trouble: int, budget: TimedGrowth, time: float) -> Failure:
    if trouble == EVENTS:
        return Failure("budget", f"more births and askings up to time {time:.9g} than the {budget.max_events} that "
                       "max_events allows")  # fmt: skip
    return Failure("budget", f"more modules at time {time:.9g} than the {budget.max_modules} that max_modules allows")


def _described(program: Program, module: Modules) -> str:
    """Write a single module, its parameters not developed."""
    values = ", ".join(f"{value:.6g}" for value in module.values.tolist())
    name = program.names[int(module.whole[0, CODE])]
    return f"{name}({values})" if values else name
