"""Notes on channels that a run is too short, or its demes too small, for: they carry nothing, which may be meant."""

from __future__ import annotations

from orchestrator.channels import ChannelSettings
from orchestrator.experiment import Experiment
from orchestrator.members import Names, island_names, members_of, numbers_of

MOST_NAMED = 4


def idle(experiment: Experiment, source: str) -> tuple[str, ...]:
    """Give a note for each channel on which nothing can arrive, or some of whose sources never send.

    A run of no epochs needs none: it is its first populations.

    Parameters
    ----------
    experiment
        Its channels are completed.
    source
        The file's name, for messages.

    Raises
    ------
    InputError
        For islands that are not there.
    """
    islands = island_names(experiment)
    notes = []
    for number, channel in enumerate(experiment.channels):
        if channel.topology_name == "unconnected" or experiment.length == 0:
            continue
        told = _too_late(channel, experiment) or _too_small(
            channel, experiment, islands, f"{source}: channels.{number}"
        )
        if told:
            notes.append(f"channels.{number}: {told}")
    return tuple(notes)


def _too_late(channel: ChannelSettings, experiment: Experiment) -> str:
    """Say why a channel brings nothing in time: what is sent at the end of the last epoch is not taken in."""
    epochs = experiment.length
    first = next((e for e in range(channel.since, channel.since + channel.every + 1) if e % channel.every == 0), 0)
    if first == 0 and channel.kind == "migrants":
        first = channel.every
    if channel.until is not None and first >= channel.until:
        return f"no epoch from {channel.since} and before {channel.until} is one that 'every: {channel.every}' divides"
    if first >= epochs:
        return f"what it first carries, at the end of epoch {first}, comes too late for a run of {epochs} epochs"
    end = epochs if channel.until is None else min(epochs, channel.until)
    last = (end - 1) // channel.every * channel.every * experiment.epoch
    stagnation = channel.trigger.stagnation if channel.trigger is not None else None
    if stagnation is not None and stagnation > last:
        return f"a stagnation of {stagnation} generations comes too late: it carries for the last time after {last}"
    return ""


def _too_small(channel: ChannelSettings, experiment: Experiment, islands: Names, where: str) -> str:
    """Say which sources a condition on diversity never lets send."""
    if channel.trigger is None or channel.trigger.diversity is None:
        return ""
    if channel.source is None:
        sources = members_of(channel, islands, where)
    else:
        sources = numbers_of(channel.source, islands, f"{where}.from")
    alone = [islands[one][1] for one in sources if experiment.islands[islands[one][0]].population == 1]
    named = ", ".join(alone[:MOST_NAMED]) + (", ..." if len(alone) > MOST_NAMED else "")
    return f"a deme of one has no diversity, so these never send: {named}" if alone else ""
