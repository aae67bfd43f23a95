"""Adapters: what translates genotypes on their way between islands whose genomes differ.

A channel of migrants may join islands of different species where its edges name an adapter. Whoever comes through one
is an individual of its own there: another genotype, another id, origin ``adaptation``, the migrant its one parent.

An adapter is found by name here, by import path, or among the entry points of ``atoll.adapters``. A new one is one
class and one line of ``ADAPTERS``.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from itertools import cycle, islice
from typing import Any, ClassVar, Final, Protocol, final, runtime_checkable

from evaluators.plugins import find
from genome.errors import InputError
from islands.kinds.registry import resolve_kind
from islands.migration.gate import Translate
from islands.spec import IslandSpec

GROUP: Final = "atoll.adapters"

ADAPTERS: Final = {
    "resize": "islands.migration.adapters:Resize",
}
"""Built adapters and where they stand; imported when first used."""


@runtime_checkable
class Adapter(Protocol):
    """Makes translations between the genotypes of two islands.

    Attributes
    ----------
    source, target
        Names of the kinds of island that it translates from and to.
    """

    source: ClassVar[tuple[str, ...]]
    target: ClassVar[tuple[str, ...]]

    def build(self, source: IslandSpec, target: IslandSpec) -> Translate:
        """Make the translation of encoded genotypes from one island to another.

        The translation may raise whatever it likes for a genotype that it cannot translate: that migrant is turned
        away, with the reason in its row.

        Raises
        ------
        InputError
            When the two islands do not suit; nothing else is to be raised here.
        """
        ...


def build_adapter(name: str, source: IslandSpec, target: IslandSpec, where: str) -> Translate:
    """Find an adapter and make its translation from one island to another.

    Parameters
    ----------
    name
        Its name, import path or entry point.
    source, target
        The islands.
    where
        The place in the experiment, for messages.

    Raises
    ------
    InputError
        When there is none by that name, what is there is no adapter or makes no translation, or the two islands do not
        suit.
    """
    found = find(name, where, "adapter", ADAPTERS, GROUP)
    adapter = found() if isinstance(found, type) else found
    if not isinstance(adapter, Adapter):
        missing = [part for part in ("source", "target", "build") if not hasattr(adapter, part)]
        got = f"'{name}', a {type(adapter).__name__} without {', '.join(missing)}"
        raise InputError(where, "an adapter", got, "an adapter has source, target and build")
    for end, spec, kinds in (("from", source, adapter.source), ("to", target, adapter.target)):
        kind = resolve_kind(spec.kind, spec.where("kind")).name
        if kind not in kinds:
            got = f"'{name}', which translates {end} {' or '.join(kinds)}"
            raise InputError(where, f"an adapter {end} the kind '{kind}' of island {spec.name}", got)
    try:
        made: object = adapter.build(source, target)
    except InputError as error:
        raise InputError(error.where or where, error.expected, error.got, error.remedy) from None
    if not callable(made):
        got = f"'{name}', whose build gives a {type(made).__name__}"
        raise InputError(where, "an adapter that makes a translation", got, "give a function from text to text")
    return made


def adapters_into(
    target: IslandSpec, sources: Iterable[tuple[str, IslandSpec]], where: str
) -> Mapping[tuple[str, int], Translate]:
    """Make the translations that an :class:`~islands.island.Island` is given.

    Parameters
    ----------
    target
        The island.
    sources
        Adapter's name and source island of each of its incoming edges that has an adapter.
    where
        The place in the experiment, for messages.

    Raises
    ------
    InputError
        As :func:`build_adapter`.
    """
    return {(name, source.number): build_adapter(name, source, target, where) for name, source in sources}


@final
class Resize:
    """Fits a genome to another length and another range of genes, between islands of one kind.

    A longer genome is cut off; a shorter one is repeated from its start, as a mapping reads it that wraps. A gene at or
    above the target's ceiling becomes its remainder.
    """

    source: ClassVar[tuple[str, ...]] = ("bits", "surface")
    target: ClassVar[tuple[str, ...]] = ("bits", "surface")

    def build(self, source: IslandSpec, target: IslandSpec) -> Translate:
        """Make the translation.

        Raises
        ------
        InputError
            For islands of two kinds.
        """
        kinds = [resolve_kind(spec.kind, spec.where("kind")) for spec in (source, target)]
        if kinds[0].name != kinds[1].name:
            got = f"{source.name} of kind '{kinds[0].name}' and {target.name} of kind '{kinds[1].name}'"
            raise InputError("", "two islands of one kind for the adapter 'resize'", got)
        settings: Any = kinds[1].genome.model_validate(dict(target.genome))
        length: int = settings.length
        if kinds[1].name == "bits":
            return lambda text: "".join(_fitted(text, length))
        ceiling: int = settings.gene_ceiling
        return lambda text: json.dumps([gene % ceiling for gene in _fitted(json.loads(text), length)])


def _fitted(genes: Any, length: int) -> Iterable[Any]:  # noqa: ANN401 - characters or numbers
    if not genes:
        raise ValueError("an empty genome cannot be lengthened")
    return islice(cycle(genes), length)
