"""The ways through a plan, from door to door."""

from __future__ import annotations

from collections.abc import Callable

from evaluators.plans.layout import Layout


def reachable(layout: Layout) -> float:
    """Give the share of the rooms that one reaches through doors from the entrance; without one, from the best room."""
    return _share_from(layout, lambda _: False)


def circulation(layout: Layout) -> float:
    """Give the share of the rooms that one reaches through doors without walking through a private room."""
    private = [wish.private for wish in layout.brief.rooms.values()]
    return _share_from(layout, lambda room: private[room])


def through_doors(layout: Layout) -> list[list[int]]:
    """Give the rooms to which each room has a door."""
    ways: list[list[int]] = [[] for _ in range(layout.plan.count)]
    for first, second in layout.doors:
        ways[first].append(second)
        ways[second].append(first)
    return ways


def _share_from(layout: Layout, closed: Callable[[int], bool]) -> float:
    """Give the share of rooms that are reached; one may enter a closed room, and not leave it for another."""
    count = layout.plan.count
    ways = through_doors(layout)
    entrance = layout.brief.entrance
    if entrance is not None:
        return _reached(list(layout.brief.rooms).index(entrance), ways, closed) / count
    return max(_reached(start, ways, closed) for start in range(count)) / count


def _reached(start: int, ways: list[list[int]], closed: Callable[[int], bool]) -> int:
    seen = {start}
    todo = [start]
    while todo:
        room = todo.pop()
        if room != start and closed(room):
            continue
        for other in ways[room]:
            if other not in seen:
                seen.add(other)
                todo.append(other)
    return len(seen)
