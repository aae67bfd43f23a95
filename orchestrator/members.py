"""The islands that a channel names: by their own names, or by the name of their group."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from genome.errors import InputError
from genome.settings import describe, near
from orchestrator.channels import ChannelSettings
from orchestrator.experiment import Experiment

MEANT: Final = ("unconnected", "edges", "graph")
"""Topologies whose edges among one island need no note: there are none, or they are written out."""

Names = Sequence[tuple[str, str]]
"""Group and name of each island, in the order of their numbers."""


def island_names(experiment: Experiment) -> list[tuple[str, str]]:
    """Give group and name of each island: of a group that counts several, ``GROUP-0``, ``GROUP-1``, ..."""
    names: list[tuple[str, str]] = []
    for group, settings in experiment.islands.items():
        alone = settings.count == 1
        names.extend((group, group if alone else f"{group}-{place}") for place in range(settings.count))
    return names


def numbers_of(given: str | Sequence[str], islands: Names, where: str) -> list[int]:
    """Give the numbers of islands by name, or by the name of their group, in the order named.

    Raises
    ------
    InputError
        When none is of such a name, or one is named twice: by itself, or as one of its group.
    """
    names = [given] if isinstance(given, str) else given
    by_name: dict[str, list[int]] = {}
    for number, (group, name) in enumerate(islands):
        for key in dict.fromkeys((group, name)):
            by_name.setdefault(key, []).append(number)
    for name in names:
        if name not in by_name:
            known = list(dict.fromkeys([*(group for group, _ in islands), *(name for _, name in islands)]))
            raise InputError(where, "an island of the experiment", describe(name), near(name, known))
    numbers: dict[int, str] = {}
    for name in names:
        for number in by_name[name]:
            if number in numbers:
                got = f"{islands[number][1]} twice, as {describe(numbers[number])} and as {describe(name)}"
                raise InputError(where, "islands or groups, each once", got, "remove one of them")
            numbers[number] = name
    return list(numbers)


def members_of(channel: ChannelSettings, islands: Names, where: str) -> list[int]:
    """Give the numbers of the islands that a channel's topology is laid out on, in the order of their places.

    Raises
    ------
    InputError
        When ``among`` names none, one twice, or one that is not there.
    """
    if channel.among is None:
        return list(range(len(islands)))
    if not channel.among:
        raise InputError(f"{where}.among", "an island or a group", "none", "without 'among' it is all islands")
    return numbers_of(channel.among, islands, f"{where}.among")


def lonely(experiment: Experiment, source: str) -> tuple[str, ...]:
    """Give a note for each channel whose topology has one island only: it carries nothing, which may be meant.

    Raises
    ------
    InputError
        As :func:`members_of`.
    """
    islands = island_names(experiment)
    notes = []
    for number, channel in enumerate(experiment.channels):
        if channel.topology is None or channel.topology_name in MEANT:
            continue
        members = members_of(channel, islands, f"{source}: channels.{number}")
        if len(members) == 1:
            alone = islands[members[0]][1]
            notes.append(f"channels.{number}: topology {channel.topology_name} of one island, {alone}, carries nothing")
    return tuple(notes)
