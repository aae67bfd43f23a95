"""The criteria of one sort of form by name: the project's own, an import path, or an installed plug-in's."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType
from typing import Any, Final, Generic, TypeVar, cast, final

from evaluators.plugins import find_function

C = TypeVar("C", bound=Callable[..., Any])

GROUP: Final = "atoll.evaluators"
"""The entry points' group of installed plug-ins, that of all criteria."""


@final
class Catalogue(Generic[C]):
    """Finds criteria.

    Parameters
    ----------
    own
        The project's, whose names no plug-in can take.
    """

    __slots__ = ("own",)

    def __init__(self, own: Mapping[str, C]) -> None:
        self.own: Final[Mapping[str, C]] = MappingProxyType(dict(own))

    def resolve(self, name: str, where: str = "fitness") -> C:
        """Find one criterion.

        Parameters
        ----------
        name
            One of the project's own, ``package.module:object``, or the name of an entry point of the group
            ``atoll.evaluators``.
        where
            The place that an error names.

        Raises
        ------
        InputError
            Where there is no such criterion, it cannot be imported, or it cannot be called.
        """
        return cast("C", find_function(name, where, "criterion", self.own, GROUP))

    def resolve_all(self, criteria: Iterable[str] | Mapping[str, C]) -> Mapping[str, C]:
        """Find several criteria, in the order given; those found already stay, which saves looking each up again."""
        return criteria if isinstance(criteria, Mapping) else {name: self.resolve(name) for name in criteria}
