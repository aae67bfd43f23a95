"""Plug-ins that break at a run's start, each in its own way."""

from __future__ import annotations

import sys
from typing import Any, ClassVar

from bits import BitsBiology, BitsKind


def leaving(count: int) -> list[tuple[int, int]]:
    sys.exit(f"cannot lay {count}\nislands")


def interrupted(count: int) -> list[tuple[int, int]]:
    raise KeyboardInterrupt


def repeated(count: int) -> list[tuple[int, int]]:
    return [*((place, (place + 1) % count) for place in range(count)), (0, 1)]


class Unmade:
    source: ClassVar[tuple[str, ...]] = ("bits",)
    target: ClassVar[tuple[str, ...]] = ("bits",)

    def __init__(self) -> None:
        raise ZeroDivisionError("no adapter\ntoday")

    def build(self, source: Any, target: Any) -> Any:
        return str


class Unbuilt(Unmade):
    def __init__(self) -> None:
        pass

    def build(self, source: Any, target: Any) -> Any:
        sys.exit("no build")


class Kindless(Unbuilt):
    source: ClassVar[Any] = None


class Waiting(Unbuilt):
    def build(self, source: Any, target: Any) -> Any:
        raise KeyboardInterrupt


class NoBuildKind(BitsKind):
    name: ClassVar[str] = "no-build"

    def build(self, spec: Any, clock: Any) -> BitsBiology:
        raise RuntimeError("no biology\ntoday")


class NoInitKind(BitsKind):
    name: ClassVar[str] = "no-init"

    def __init__(self) -> None:
        sys.exit(3)


class NoNeedsKind(BitsKind):
    name: ClassVar[str] = "no-needs"

    def needs(self, spec: Any) -> tuple[str, ...]:
        raise RuntimeError("no needs")


class NoGivesKind(BitsKind):
    name: ClassVar[str] = "no-gives"

    def gives(self, spec: Any) -> dict[str, str]:
        raise RuntimeError("no gifts")


class OneNeedKind(BitsKind):
    """Says its one need, and what it takes, without brackets."""

    name: ClassVar[str] = "one-need"
    needs: ClassVar[str] = "partners"
    gives: ClassVar[dict[str, str]] = {"partners": "word"}
    takes: ClassVar[dict[str, str]] = {"partners": "word"}

    def build(self, spec: Any, clock: Any) -> BitsBiology:
        made = BitsBiology(spec, clock)
        made.evaluate_with = lambda genotype, partners: made.evaluate(genotype)
        return made


class LeftKind(OneNeedKind):
    """Has no use for its like."""

    name: ClassVar[str] = "left"
    gives: ClassVar[dict[str, str]] = {"partners": "left"}
    takes: ClassVar[dict[str, str]] = {"partners": "right"}


class RightKind(OneNeedKind):
    name: ClassVar[str] = "right"
    gives: ClassVar[dict[str, str]] = {"partners": "right"}
    takes: ClassVar[dict[str, str]] = {"partners": "left"}
