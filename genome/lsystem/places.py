"""Places in a word: where its branches are, and words with something else there.

A path leads from the whole word to one of its branches: a pair (item, sibling) for each branch point on the way. The
empty path is the whole word, the trunk.
"""

from __future__ import annotations

import numpy as np

from genome.lsystem.word import Branch, Item, Word

Path = tuple[tuple[int, int], ...]


def trunk_and_branches(word: Word) -> list[Path]:
    """Give the paths of the trunk and of all branches, in the order in which they are written."""
    found: list[Path] = [()]
    for at, item in enumerate(word.items):
        if isinstance(item, Branch):
            for number, sibling in enumerate(item.siblings):
                found.extend(((at, number), *rest) for rest in trunk_and_branches(sibling))
    return found


def branches(word: Word) -> list[Path]:
    """Give the paths of all branches, without the trunk."""
    return trunk_and_branches(word)[1:]


def part(word: Word, path: Path) -> Word:
    """Give the branch at a path."""
    for at, number in path:
        branch = word.items[at]
        assert isinstance(branch, Branch)
        word = branch.siblings[number]
    return word


def replaced(word: Word, path: Path, new: Word) -> Word:
    """Give a word with another branch at a path; an empty one takes the branch away, and the last takes its point."""
    if not path:
        return new
    (at, number), *rest = path
    branch = word.items[at]
    assert isinstance(branch, Branch)
    inner = replaced(branch.siblings[number], tuple(rest), new)
    siblings = (*branch.siblings[:number], *([inner] if inner.items else []), *branch.siblings[number + 1 :])
    kept: list[Item] = [Branch(siblings)] if siblings else []
    return Word((*word.items[:at], *kept, *word.items[at + 1 :]))


def with_branch(word: Word, branch: Word, rng: np.random.Generator) -> Word:
    """Grow a branch at a random place, each as likely: between any two items, at their ends, or as one more sibling.

    The place before a trunk's first item is one too; there the branch grows from where the turtle comes from.
    """
    places: list[tuple[Path, int, bool]] = []
    for path in trunk_and_branches(word):
        items = part(word, path).items
        places.extend((path, at, False) for at in range(len(items) + 1))
        places.extend((path, at, True) for at, item in enumerate(items) if isinstance(item, Branch))
    path, at, beside = places[int(rng.integers(len(places)))]
    items = part(word, path).items
    old = items[at] if beside else None
    siblings = (*old.siblings, branch) if isinstance(old, Branch) else (branch,)
    return replaced(word, path, Word((*items[:at], Branch(siblings), *items[at + beside :])))


def stretch(word: Word, rng: np.random.Generator) -> tuple[int, int]:
    """Draw a stretch of a word's own items, start and end, each as likely; not all of them where there are several."""
    count = len(word.items)
    spans = [(a, b) for a in range(count) for b in range(a + 1, count + 1) if count == 1 or b - a < count]
    return spans[int(rng.integers(len(spans)))]
