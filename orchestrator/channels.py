"""A channel of the experiment file: its settings, which keys belong to which kind, and their defaults."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Final, Literal, Self

from pydantic import BeforeValidator, Field, StringConstraints, field_validator, model_validator

from genome.errors import InputError
from genome.settings import Settings, describe
from islands.migration.channel import Channel, ChannelKind, Chooser, Pairing, PairingScheme, PairingScore, Replacer
from islands.migration.channel import Trigger as Condition
from islands.settings import Probability
from orchestrator.topology.registry import with_parameters

Name = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]*$", max_length=100)]
Count = Annotated[int, Field(ge=1, le=1_000_000)]
Share = Annotated[float, Field(gt=0, le=1)]

OF_KIND: Final[Mapping[str, ChannelKind]] = {
    "replace": "migrants",
    "accept": "migrants",
    "mode": "migrants",
    "adapter": "migrants",
    "pairing": "partners",
    "pairings": "partners",
    "score": "partners",
    "archive": "partners",
    "measures": "partners",
    "keep": "components",
}
"""Keys that belong to channels of one kind alone."""

DEFAULTS: Final[Mapping[ChannelKind, Mapping[str, Any]]] = {
    "migrants": {"replace": "worst", "accept": "always", "mode": "copy"},
    "partners": {"pairing": "best", "score": "mean", "archive": 0, "measures": False},
    "components": {},
    "surroundings": {},
}
"""What a channel of a kind has where nothing is said; the rest depends on other keys."""

USUAL_PAIRINGS: Final[Mapping[PairingScheme, int]] = {"best": 1, "random": 1, "several": 2, "archive": 2, "mixed": 3}
LEAST_MIXED: Final = 3

OF_FORM: Final = {"among": "topology", "unreached": "topology", "join": "from"}
"""Keys that belong to channels of a topology, or to those from islands to others."""


class TriggerSettings(Settings):
    """When a source sends, besides the interval; exactly one key is given.

    Attributes
    ----------
    generations
        Every so many generations, a multiple of the experiment's ``epoch``: another way to write ``every``.
    stagnation
        Once the best of its deme has not improved for so many generations.
    diversity
        While the diversity of its deme is under this bound.
    """

    generations: Count | None = None
    stagnation: Count | None = None
    diversity: Share | None = None

    @model_validator(mode="after")
    def _exactly_one(self) -> Self:
        given = [key for key in ("generations", "stagnation", "diversity") if getattr(self, key) is not None]
        if len(given) != 1:
            got = " and ".join(given) or "none"
            raise InputError("", "one of 'generations', 'stagnation' and 'diversity'", got)
        return self


def _topology(value: object) -> object:
    if value is None or isinstance(value, str) or (isinstance(value, dict) and isinstance(value.get("name"), str)):
        return value
    raise InputError("", "a topology's name, or its 'name' with parameters", describe(value), "write topology: ring")


class ChannelSettings(Settings):
    """A channel: a topology ``among`` islands, or edges ``from`` islands ``to`` others."""

    kind: ChannelKind = "migrants"
    name: Name | None = None
    topology: Annotated[str | dict[str, Any] | None, BeforeValidator(_topology)] = None
    among: str | list[str] | None = None
    unreached: Literal["refuse", "allow"] | None = None
    source: str | list[str] | None = Field(default=None, alias="from")
    target: str | list[str] | None = Field(default=None, alias="to")
    join: Literal["all", "matching"] | None = None
    every: Count = 1
    since: Annotated[int, Field(ge=0, le=10**9)] = 0
    until: Count | None = None
    count: Count | None = None
    rate: Share | None = None
    select: Chooser = "best"
    tournament: Count = 2
    routing: Literal["broadcast", "point"] = "broadcast"
    weight: Probability = 1.0
    trigger: TriggerSettings | None = None
    replace: Replacer | None = None
    accept: Literal["always", "better"] | None = None
    mode: Literal["copy", "move"] | None = None
    adapter: Annotated[str, StringConstraints(min_length=1)] | None = None
    pairing: PairingScheme | None = None
    pairings: Count | None = None
    score: PairingScore | None = None
    archive: Annotated[int, Field(ge=0, le=1_000_000)] | None = None
    measures: bool | None = None
    keep: Count | None = None

    @field_validator("among", "source", "target", mode="before")
    @classmethod
    def _names(cls, value: object) -> object:
        names = value if isinstance(value, list) else [value]
        if value is not None and not all(isinstance(name, str) for name in names):
            raise InputError("", "an island's name or a list of names", describe(value))
        return value

    @model_validator(mode="after")
    def _one_form(self) -> Self:
        point = self.source is not None or self.target is not None
        if point and (self.source is None or self.target is None):
            missing = "from" if self.source is None else "to"
            raise InputError("", "both 'from' and 'to'", f"no '{missing}'", "add it")
        if point and (self.topology is not None or self.among is not None):
            raise InputError("", "'from' and 'to', or 'topology' and 'among'", "both", "remove one of them")
        if not point and self.topology is None:
            raise InputError("", "'topology' and 'among', or 'from' and 'to'", "neither", "add topology: ring")
        return self

    @property
    def topology_name(self) -> str:
        """By what name the topology goes; empty for a channel from islands to others."""
        return str(self.topology["name"]) if isinstance(self.topology, dict) else self.topology or ""

    @property
    def parameters(self) -> dict[str, Any]:
        """The topology's parameters."""
        given = self.topology if isinstance(self.topology, dict) else {}
        return {key: value for key, value in given.items() if key != "name"}


def completed(channel: ChannelSettings, where: str, epoch: int) -> ChannelSettings:
    """Check that a channel's keys belong together, and write out their defaults.

    Parameters
    ----------
    channel
        As the file has it.
    where
        Its place in the file, for messages.
    epoch
        Generations of an epoch.

    Raises
    ------
    InputError
        Naming the key that does not belong, or does not fit the others.
    """
    _refuse_strangers(channel, where)
    changes: dict[str, Any] = {
        key: value for key, value in DEFAULTS[channel.kind].items() if getattr(channel, key) is None
    }
    if channel.weight == 0:
        raise InputError(
            f"{where}.weight", "a probability above 0", "0, by which it never carries", "remove the channel"
        )
    if channel.until is not None and channel.until <= channel.since:
        got = f"{channel.until}, by which it never carries"
        raise InputError(f"{where}.until", f"an epoch after 'since', {channel.since}", got)
    if channel.count is not None and channel.rate is not None:
        raise InputError(f"{where}.rate", "either 'count' or 'rate'", "both", "remove one of them")
    if channel.count is None and channel.rate is None:
        changes["count"] = 1
    if channel.topology is not None:
        topology = with_parameters(channel.topology_name, channel.parameters, f"{where}.topology")
        written = channel.parameters
        if isinstance(topology, Settings):
            written = topology.model_dump(mode="json", exclude_none=True)
        changes["topology"] = {"name": channel.topology_name, **written} if written else channel.topology_name
        changes["unreached"] = channel.unreached or "refuse"
    else:
        changes["join"] = channel.join or "all"
    if channel.trigger is not None and channel.trigger.generations is not None:
        changes |= {"every": _interval(channel, channel.trigger.generations, where, epoch), "trigger": None}
    channel = channel.model_copy(update=changes)
    if channel.kind == "partners":
        return _paired(channel, where)
    if channel.kind == "components":
        return _kept(channel, where)
    return channel


def channel_of(channel: ChannelSettings, number: int, name: str, largest: int) -> Channel:
    """Give a channel as islands know it, of completed settings.

    Parameters
    ----------
    channel, number, name
        The settings, the place in the experiment's list, and the name.
    largest
        Members of the largest deme that sends.
    """
    trigger = pairing = None
    if channel.trigger is not None:
        trigger = Condition(channel.trigger.stagnation, channel.trigger.diversity)
    if channel.kind == "partners":
        pairing = Pairing(
            scheme=channel.pairing or "best",
            count=channel.pairings or 1,
            score=channel.score or "mean",
            archive=channel.archive or 0,
            measures=channel.measures or False,
        )
    made = Channel(
        number=number,
        name=name,
        kind=channel.kind,
        every=channel.every,
        count=channel.count or 1,
        rate=channel.rate,
        select=channel.select,
        tournament=channel.tournament,
        replace=channel.replace or "worst",
        accept=channel.accept or "always",
        move=channel.mode == "move",
        routing=channel.routing,
        trigger=trigger,
        pairing=pairing,
        keep=channel.keep or 1,
        since=channel.since,
        until=channel.until,
    )
    if channel.kind == "components" and channel.keep is None:
        from dataclasses import replace

        return replace(made, keep=made.size(largest))
    return made


def _refuse_strangers(channel: ChannelSettings, where: str) -> None:
    for key, kind in OF_KIND.items():
        if getattr(channel, key) is not None and channel.kind != kind:
            got = f"'{key}' on a channel of kind {channel.kind}"
            raise InputError(f"{where}.{key}", f"'{key}' on a channel of kind {kind} alone", got, "remove the key")
    for key, form in OF_FORM.items():
        if getattr(channel, key) is not None and (form == "topology") != (channel.topology is not None):
            forms = ("'topology'", "'from' and 'to'")
            wanted, has = forms if form == "topology" else forms[::-1]
            raise InputError(f"{where}.{key}", f"'{key}' with {wanted} alone", f"'{key}' with {has}", "remove the key")


def _interval(channel: ChannelSettings, generations: int, where: str, epoch: int) -> int:
    """Give the epochs between two sendings, from a trigger in generations."""
    key = f"{where}.trigger.generations"
    if "every" in channel.model_fields_set:
        raise InputError(key, "either 'every' or 'trigger: {generations: n}'", "both", "remove one of them")
    if generations % epoch:
        below = generations // epoch * epoch
        near = f"{below} or {below + epoch}" if below else str(epoch)
        remedy = f"take {near}: migrants travel at the end of epochs"
        raise InputError(key, f"a multiple of the epoch's {epoch} generations", str(generations), remedy)
    return generations // epoch


def _paired(channel: ChannelSettings, where: str) -> ChannelSettings:
    scheme, archive = channel.pairing or "best", channel.archive or 0
    pairings = channel.pairings or USUAL_PAIRINGS[scheme]
    if scheme == "best" and pairings > 1:
        remedy = "take pairing: several, random, archive or mixed"
        raise InputError(f"{where}.pairings", "1 with pairing: best", str(pairings), remedy)
    if scheme == "mixed" and pairings < LEAST_MIXED:
        expected = f"{LEAST_MIXED} or more with pairing: mixed: the best, another one shown, and a past one"
        raise InputError(f"{where}.pairings", expected, str(pairings), "take more, or pairing: archive")
    least = {"archive": max(1, pairings - 1), "mixed": (pairings - 1) // 2}.get(scheme, 0)
    if archive < least:
        expected = f"an archive of {least} or more for pairing: {scheme} with pairings: {pairings}"
        raise InputError(f"{where}.archive", expected, str(archive), f"add archive: {max(least, 10)}")
    if channel.measures and not archive:
        remedy = "add archive: 10"
        raise InputError(f"{where}.measures", "an archive to measure the best against", "none", remedy)
    return channel.model_copy(update={"pairings": pairings})


def _kept(channel: ChannelSettings, where: str) -> ChannelSettings:
    if channel.count is None:
        return channel
    keep = channel.count if channel.keep is None else channel.keep
    if keep < channel.count:
        expected = f"at least the {channel.count} that arrive at a time"
        raise InputError(f"{where}.keep", expected, str(keep), "raise 'keep' or lower 'count'")
    return channel.model_copy(update={"keep": keep})
