"""YAML as Atoll reads it: strict, plain, and with the line of every key.

The text is parsed by ruamel.yaml; the values are made here from its events, because no loader refuses all that
leads people astray: a key given twice, the truth values of YAML 1.1 (``no`` is a text here), keys that are not
texts, several documents in one file, tags that make objects, and aliases that unfold without end. Scalars follow
the core schema of YAML 1.2 (section 10.3.2), except that a number with a leading zero is refused.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from genome.errors import InputError

MAX_DEPTH: Final = 64
"""How deep lists and mappings may be nested, aliases unfolded."""

MAX_VALUES: Final = 1_000_000
"""How many values a file may hold, aliases unfolded: a few lines of nested aliases can stand for billions."""

_NULL = re.compile(r"null|Null|NULL|~|")
_TRUE = re.compile(r"true|True|TRUE")
_FALSE = re.compile(r"false|False|FALSE")
_DECIMAL = re.compile(r"[-+]?(0|[1-9][0-9]*)")
_OCTAL = re.compile(r"0o([0-7]+)")
_HEXADECIMAL = re.compile(r"0x([0-9a-fA-F]+)")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_INFINITE = re.compile(r"([-+]?)\.(inf|Inf|INF)")
_NAN = re.compile(r"\.(nan|NaN|NAN)")
_LEADING_ZERO = re.compile(r"[-+]?0[0-9]")
_STANDARD_TAG = "tag:yaml.org,2002:"


@dataclass(frozen=True, slots=True)
class _Node:
    """A value of the file: a scalar, a list of nodes, or a mapping of names to nodes, with its line and extent."""

    value: str | int | float | bool | tuple[_Node, ...] | dict[str, _Node] | None
    line: int
    size: int = 1
    depth: int = 1

    def plain(self) -> Any:  # noqa: ANN401 - whatever the file holds
        """Give fresh plain data, so that two uses of one alias share nothing."""
        if isinstance(self.value, tuple):
            return [node.plain() for node in self.value]
        if isinstance(self.value, dict):
            return {key: node.plain() for key, node in self.value.items()}
        return self.value


@dataclass(frozen=True, slots=True)
class Document:
    """A YAML file's content.

    Attributes
    ----------
    data
        Plain data: dict with text keys, list, str, int, float, bool, None. Floats may be NaN or infinite; settings
        models refuse those.
    source
        The file's name, for messages.
    """

    data: Any
    source: str
    _root: _Node
    _key_lines: Mapping[int, Mapping[str, int]]

    def line_of(self, path: Sequence[str | int]) -> int | None:
        """Give the line (from 1) at which the value of a key path is written.

        Parts of the path that the file does not have are passed over (pydantic adds the names of a union's members),
        so that the line of a missing key is the line of the mapping that lacks it.
        """
        node, line = self._root, self._root.line
        for part in path:
            if isinstance(node.value, dict) and part in node.value:
                line = self._key_lines.get(id(node), {}).get(str(part), node.value[str(part)].line)
                node = node.value[str(part)]
            elif isinstance(node.value, tuple) and isinstance(part, int) and 0 <= part < len(node.value):
                node = node.value[part]
                line = node.line
        return line


def load_yaml(path: Path) -> Document:
    """Read a YAML file.

    Parameters
    ----------
    path
        The file; UTF-8, one document.

    Raises
    ------
    InputError
        When the file is missing, is no regular file, is not UTF-8, is empty, or is not plain, strict YAML.
    """
    source = str(path)
    try:
        raw = path.read_bytes()
    except FileNotFoundError:
        raise InputError(source, "a YAML file", "no such file", "check the path") from None
    except IsADirectoryError:
        raise InputError(source, "a YAML file", "a folder", "give the file inside it") from None
    except OSError as error:
        raise InputError(source, "a readable YAML file", error.strerror or str(error)) from None
    try:
        text = raw.decode("utf-8")
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        where = f"{source}:{line}"
        raise InputError(where, "UTF-8 text", f"the byte {raw[error.start]:#04x}", "save it as UTF-8") from None
    return parse_yaml(text, source)


def parse_yaml(text: str, source: str) -> Document:
    """Read YAML from a text; see :func:`load_yaml`."""
    builder = _Builder(source)
    root = builder.build(_events(text.removeprefix("\ufeff"), source))
    return Document(root.plain(), source, root, builder.key_lines)


def _events(text: str, source: str) -> Iterator[Any]:
    from ruamel.yaml import YAML
    from ruamel.yaml.error import MarkedYAMLError, YAMLError

    try:
        yield from YAML(typ="safe", pure=True).parse(text)
    except MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        where = f"{source}:{mark.line + 1}:{mark.column + 1}" if mark else source
        problem = " ".join(str(error.problem or error.context).split())
        raise InputError(where, "well-formed YAML", problem) from None
    except YAMLError as error:
        raise InputError(source, "well-formed YAML", " ".join(str(error).split())) from None


class _Builder:
    """Builds nodes from parser events, without recursion, and refuses what the module's docstring says."""

    def __init__(self, source: str) -> None:
        self.source = source
        self.key_lines: dict[int, dict[str, int]] = {}
        self.anchors: dict[str, _Node] = {}
        self.kept: list[_Node] = []  # keeps every mapping alive, so that its id stays its own

    def build(self, events: Iterator[Any]) -> _Node:
        from ruamel.yaml import events as kind

        root: _Node | None = None
        open_items: list[tuple[Any, list[tuple[_Node, bool]]]] = []
        for event in events:
            if isinstance(event, kind.DocumentStartEvent) and root is not None:
                raise InputError(self._at(event), "one document", "another '---'", "split the file")
            if isinstance(event, (kind.SequenceStartEvent, kind.MappingStartEvent)):
                if len(open_items) >= MAX_DEPTH:
                    raise self._too_deep(event)
                open_items.append((event, []))
                continue
            start: Any = event
            if isinstance(event, kind.ScalarEvent):
                node = self._scalar(event)
            elif isinstance(event, kind.AliasEvent):
                node = self._alias(event)
            elif isinstance(event, (kind.SequenceEndEvent, kind.MappingEndEvent)):
                start, items = open_items.pop()
                node = self._collection(start, items)
            else:
                continue
            if start.anchor is not None and not isinstance(start, kind.AliasEvent):
                self.anchors[str(start.anchor)] = node
            if open_items:
                open_items[-1][1].append((node, _is_merge(start)))
            else:
                root = node
        if root is None or (root.value is None and root.size == 1):
            raise InputError(self.source, "YAML keys and values", "an empty file")
        return root

    def _collection(self, start: Any, items: list[tuple[_Node, bool]]) -> _Node:  # noqa: ANN401 - an event
        from ruamel.yaml import events as kind

        if isinstance(start, kind.SequenceStartEvent):
            self._check_tag(start, "seq")
            nodes = tuple(node for node, _ in items)
            return self._sized(start, nodes, nodes)
        self._check_tag(start, "map")
        entries: dict[str, _Node] = {}
        lines: dict[str, int] = {}
        merged: dict[str, _Node] = {}
        for (key, is_merge), (value, _) in zip(items[::2], items[1::2], strict=True):
            if is_merge:
                merged = {**self._merged(key, value), **merged}
                continue
            name = self._key(key)
            if name in entries:
                where = f"{self.source}:{key.line}"
                raise InputError(where, "each key once", f"'{name}' again (line {lines[name]})", "remove one of them")
            entries[name] = value
            lines[name] = key.line
        node = self._sized(start, {**merged, **entries}, tuple({**merged, **entries}.values()))
        self.key_lines[id(node)] = lines
        self.kept.append(node)
        return node

    def _sized(self, start: Any, value: Any, parts: tuple[_Node, ...]) -> _Node:  # noqa: ANN401 - an event, a value
        size = 1 + sum(part.size for part in parts)
        depth = 1 + max((part.depth for part in parts), default=0)
        if size > MAX_VALUES:
            raise InputError(self._at(start), f"at most {MAX_VALUES} values", f"{size} with its aliases unfolded")
        if depth > MAX_DEPTH:
            raise self._too_deep(start)
        return _Node(value, start.start_mark.line + 1, size, depth)

    def _key(self, key: _Node) -> str:
        if isinstance(key.value, str):
            return key.value
        where = f"{self.source}:{key.line}"
        if isinstance(key.value, (tuple, dict)):
            raise InputError(where, "a text as key", "a list or mapping")
        raise InputError(where, "a text as key", repr(key.value), f"write '{key.value}' in quotes")

    def _merged(self, key: _Node, value: _Node) -> dict[str, _Node]:
        """Give the entries that a merge key ``<<`` brings; of several mappings the first wins."""
        sources = value.value if isinstance(value.value, tuple) else (value,)
        merged: dict[str, _Node] = {}
        for source in sources:
            if not isinstance(source.value, dict):
                raise InputError(f"{self.source}:{key.line}", "a mapping (or a list of them) to merge", "another value")
            merged = {**source.value, **merged}
        return merged

    def _alias(self, event: Any) -> _Node:  # noqa: ANN401 - an event
        name = str(event.anchor)
        if name not in self.anchors:
            raise InputError(self._at(event), f"an anchor '&{name}' that ends before it is used", f"'*{name}'")
        return self.anchors[name]

    def _scalar(self, event: Any) -> _Node:  # noqa: ANN401 - an event
        line = event.start_mark.line + 1
        text = str(event.value)
        plain = event.style is None and event.ctag is None
        if not plain:
            value = _resolved(text) if event.ctag is not None and event.style is None else text
            if event.ctag is not None:
                value = text if str(event.ctag) in ("!", f"{_STANDARD_TAG}str") else value
                self._check_tag(event, _tag_of(value))
            return _Node(value, line)
        if _LEADING_ZERO.match(text) and _FLOAT.fullmatch(text):
            remedy = "drop the zeros, or put a text in quotes; octal is 0o17"
            raise InputError(self._at(event), "a number without leading zeros", text, remedy)
        return _Node(_resolved(text), line)

    def _check_tag(self, event: Any, expected: str) -> None:  # noqa: ANN401 - an event
        tag = None if event.ctag is None else str(event.ctag)
        if tag not in (None, "!", f"{_STANDARD_TAG}{expected}"):
            shown = str(tag).replace(_STANDARD_TAG, "!!")
            raise InputError(self._at(event), "plain YAML", f"the tag {shown}", "remove the tag")

    def _too_deep(self, event: Any) -> InputError:  # noqa: ANN401 - an event
        return InputError(self._at(event), f"at most {MAX_DEPTH} levels", "deeper nesting")

    def _at(self, event: Any) -> str:  # noqa: ANN401 - an event
        return f"{self.source}:{event.start_mark.line + 1}:{event.start_mark.column + 1}"


def _is_merge(event: Any) -> bool:  # noqa: ANN401 - an event
    return getattr(event, "style", "") is None and getattr(event, "value", None) == "<<" and event.ctag is None


def _tag_of(value: object) -> str:
    names = {bool: "bool", int: "int", float: "float", str: "str", type(None): "null"}
    return names[type(value)]


def _resolved(text: str) -> str | int | float | bool | None:
    """Give the value of a plain scalar by the core schema of YAML 1.2 (section 10.3.2)."""
    if _NULL.fullmatch(text):
        return None
    if _TRUE.fullmatch(text):
        return True
    if _FALSE.fullmatch(text):
        return False
    if len(text) <= 4000 and _DECIMAL.fullmatch(text):
        return int(text)
    if octal := _OCTAL.fullmatch(text):
        return int(octal[1], 8)
    if hexadecimal := _HEXADECIMAL.fullmatch(text):
        return int(hexadecimal[1], 16)
    if _FLOAT.fullmatch(text):
        return float(text)
    if infinite := _INFINITE.fullmatch(text):
        return -math.inf if infinite[1] == "-" else math.inf
    return math.nan if _NAN.fullmatch(text) else text
