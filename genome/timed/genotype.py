"""The genotype of an individual of timed forms: a system, and the seed of its stochastic choices."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any, Final, final

from genome.errors import InputError
from genome.settings import describe, near
from genome.timed import encoding
from genome.timed.system import TimedSystem

SEEDS: Final = 2**63
"""Seeds are integers from 0 up to, and without, this."""

FORMAT: Final = 1
"""The version of the encoding."""

_KEYS: Final = ("format", "seed", "system")


@final
@dataclass(frozen=True, slots=True)
class TimedGenotype:
    """What an individual inherits.

    Attributes
    ----------
    system
        Whatever derivation begins with.
    seed
        Decides what is drawn at random in its derivation; from 0 up to 2**63 - 1.
    """

    system: TimedSystem
    seed: int = 0


def encode_genotype(genotype: TimedGenotype) -> str:
    """Write a genotype as a JSON object without blanks; equal ones give equal texts.

    Its ``system`` is what :func:`genome.timed.encode` writes.
    """
    system = json.loads(encoding.encode(genotype.system))
    data = {"format": FORMAT, "seed": genotype.seed, "system": system}
    return json.dumps(data, separators=(",", ":"), ensure_ascii=False, allow_nan=False)


def decode_genotype(text: str) -> TimedGenotype:
    """Read what :func:`encode_genotype` wrote.

    Raises
    ------
    InputError
        For anything else, and for a system that does not fit together.
    """
    try:
        data: Any = json.loads(text)
    except (ValueError, RecursionError):
        data = None
    if not isinstance(data, dict):
        raise InputError("genotype", "a timed genotype as a JSON object", describe(text))
    for key in data:
        if key not in _KEYS:
            raise InputError(f"genotype: {key}", "a known key", describe(key), near(key, list(_KEYS)))
    version, seed = data.get("format"), data.get("seed")
    if type(version) is not int or version != FORMAT:
        raise InputError("genotype: format", f"{FORMAT}, the version of this encoding", describe(version))
    if type(seed) is not int or not 0 <= seed < SEEDS:
        raise InputError("genotype: seed", "a whole number from 0 to 2**63 - 1", describe(seed))
    try:
        written = json.dumps(data.get("system"))
    except RecursionError:
        raise InputError("genotype: system", "a timed system", "one nested without end") from None
    return TimedGenotype(encoding.decode(written), seed)
