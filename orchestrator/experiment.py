"""The experiment file as models: one file is one archipelago. ``docs/formats/experiment.md`` describes it."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

from pydantic import Field, StringConstraints, field_validator, model_validator

from evaluators.fitness import Goal
from genome.errors import InputError
from genome.settings import Settings, describe
from islands.settings import Algorithm
from orchestrator.channels import ChannelSettings, Count, Name

Seconds = Annotated[float, Field(gt=0, le=1e7)]


class IslandSettings(Settings):
    """One island, or ``count`` alike; ``epochs``: it breeds in so many, then rests."""

    kind: str
    species: Annotated[str, StringConstraints(min_length=1)] | None = None
    count: Count = 1
    population: Count = 48
    epochs: Count | None = None
    genome: dict[str, Any] = Field(default_factory=dict)
    growth: dict[str, Any] = Field(default_factory=dict)
    fitness: Annotated[dict[str, Goal], Field(min_length=1)]
    algorithm: Algorithm = Algorithm()


class IslandDefaults(Settings):
    """What every island takes unless it says otherwise; merged key by key, two levels deep."""

    kind: str | None = None
    species: str | None = None
    count: Count | None = None
    population: Count | None = None
    epochs: Count | None = None
    genome: dict[str, Any] | None = None
    growth: dict[str, Any] | None = None
    fitness: dict[str, Goal] | None = None
    algorithm: Algorithm | None = None


class LogSettings(Settings):
    """How often hosts write the log: every so many generations, rounded up to whole epochs."""

    flush_generations: Count = 25


class CheckpointSettings(Settings):
    """How often a checkpoint is made, in epochs, and how many are kept.

    ``spacing``: no sooner after the last one than after so many seconds, as far as that can be foreseen, so that
    epochs of milliseconds do not go into checkpoints.
    """

    every: Count = 4
    keep: Count = 2
    spacing: Annotated[float, Field(ge=0, le=1e7)] = 5.0


class FormSettings(Settings):
    """How many of each island's best forms are written at the end of the run."""

    best: Annotated[int, Field(ge=0, le=1000)] = 3


class DeadlineSettings(Settings):
    """How long the driver waits, in seconds, before it gives a host up.

    ``epoch`` is for one epoch; unset, it is the number of evaluations in a host's epoch times the longest that one may
    take, and at least 600 s. ``silence``: a host whose process answers nothing for so long, while it computes too, is
    taken for lost.
    """

    start: Seconds = 120.0
    epoch: Seconds | None = None
    finish: Seconds = 120.0
    silence: Seconds = 60.0


class Scale(Settings):
    """How many times as many islands, and as many members of each deme, as the file says."""

    islands: Annotated[int, Field(ge=1, le=10**6)] = 1
    demes: Annotated[int, Field(ge=1, le=10**6)] = 1


class Experiment(Settings):
    """A whole experiment."""

    name: Name
    seed: Annotated[int, Field(ge=0, lt=2**63)] = 0
    epochs: Annotated[int, Field(ge=0, le=10**9)] | None = None
    epoch: Count = 5
    generations: Annotated[int, Field(ge=0, le=10**12)] | None = None
    schedule: Literal["barrier", "dataflow", "async"] = "barrier"
    hosts: Count | Literal["auto"] = "auto"
    backend: Literal["ray", "inline"] = "ray"
    scale: Scale | None = None
    defaults: IslandDefaults | None = None
    islands: Annotated[dict[Name, IslandSettings], Field(min_length=1)]
    channels: list[ChannelSettings] = Field(default_factory=list)
    log: LogSettings = LogSettings()
    checkpoint: CheckpointSettings = CheckpointSettings()
    forms: FormSettings = FormSettings()
    deadlines: DeadlineSettings = DeadlineSettings()

    @field_validator("hosts", mode="before")
    @classmethod
    def _hosts(cls, value: object) -> object:
        if value == "auto" or (type(value) is int and value >= 1):
            return value
        raise InputError("", "'auto' or a number of at least 1", describe(value))

    @field_validator("scale", mode="before")
    @classmethod
    def _scale(cls, value: object) -> object:
        """One number multiplies both."""
        return {"islands": value, "demes": value} if type(value) is int else value

    @model_validator(mode="after")
    def _one_length(self) -> Self:
        if self.epochs is not None and self.generations is not None:
            got = f"both (epochs {self.epochs}, generations {self.generations})"
            raise InputError("", "either 'epochs' or 'generations'", got, "remove one of them")
        return self

    @property
    def length(self) -> int:
        """Epochs after the first population: as given, or as many as hold the generations asked for; else 10."""
        if self.epochs is not None:
            return self.epochs
        return 10 if self.generations is None else -(-self.generations // self.epoch)

    @property
    def flush_epochs(self) -> int:
        """Epochs between two writings of the log."""
        return -(-self.log.flush_generations // self.epoch)
