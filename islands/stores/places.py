"""The places that people write: paths, and URIs that hold no secret."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final
from urllib.parse import SplitResult, parse_qsl, quote, unquote, urlencode, urlsplit

from genome.errors import InputError

URI: Final = re.compile(r"[A-Za-z][A-Za-z0-9+.-]*://")
SECRET: Final = re.compile(r"secret|password|token|key|credential|signature", re.IGNORECASE)
"""What an option's name holds when its value is nobody's business."""
REMEDY: Final = (
    "leave keys to the environment (AWS_ACCESS_KEY_ID, AWS_SECRET_ACCESS_KEY, ...), where nothing records them"
)


@dataclass(frozen=True, slots=True)
class Place:
    """A URI in its parts.

    Attributes
    ----------
    scheme, authority
        ``s3`` and the bucket.
    path
        Below it, without slashes at its ends.
    options
        Of the query, in order.
    """

    scheme: str
    authority: str
    path: str
    options: Mapping[str, str]

    def below(self, *parts: str) -> Place:
        """Give a place below."""
        return replace(self, path=joined(self.path, *parts))

    def bare(self) -> str:
        """Give the URI without its options."""
        path = f"/{quote(self.path)}" if self.path else ""
        return f"{self.scheme}://{self.authority}{path}"

    def whole(self) -> str:
        """Give the URI."""
        return f"{self.bare()}?{urlencode(self.options, safe=':/')}" if self.options else self.bare()


def joined(*parts: str) -> str:
    """Join names with slashes; empty ones count for nothing."""
    return "/".join(stripped for part in parts if (stripped := part.strip("/")))


def is_uri(text: str) -> bool:
    """Tell whether a place is a URI."""
    return URI.match(text) is not None


def local_path(uri: str) -> Path | None:
    """Give the path that a ``file`` URI names; ``None`` for another scheme.

    Raises
    ------
    InputError
        When it names another machine, or no absolute path.
    """
    found = _split(uri)
    if found.scheme.lower() != "file":
        return None
    if found.netloc not in ("", "localhost") or not found.path.startswith("/"):
        raise InputError(uri, "file:///, then an absolute path", f"'{found.netloc or found.path}' after file://")
    return Path(unquote(found.path))


def parse_place(uri: str) -> Place:
    """Take a URI apart.

    Raises
    ------
    InputError
        When it names no bucket, has options twice, or has a secret in it, which the message does not repeat.
    """
    found = _split(uri)
    scheme = found.scheme.lower()
    user, at, _ = found.netloc.rpartition("@")
    options = parse_qsl(found.query, keep_blank_values=True)
    shown = f"{scheme}://{found.netloc.rpartition('@')[2]}{found.path}"
    # Without a colon it is a user's name, or a container of abfs; of S3 it is half a secret.
    if at and (":" in user or scheme == "s3"):
        raise InputError(shown, "a place without keys or passwords", "one with something before '@'", REMEDY)
    for name, value in options:
        if SECRET.search(name) or ("@" in value and "://" in value):
            raise InputError(shown, "a place without keys or passwords", f"the option '{name}'", REMEDY)
    if not found.netloc or found.fragment:
        raise InputError(shown, "a place such as s3://bucket/runs", "no bucket" if not found.netloc else "a '#' in it")
    if len(dict(options)) < len(options):
        raise InputError(shown, "each option once", f"'{found.query}'")
    return Place(scheme, found.netloc, joined(unquote(found.path)), dict(options))


def _split(uri: str) -> SplitResult:
    try:
        return urlsplit(uri)
    except ValueError as error:
        raise InputError("the place of runs", "a URI such as s3://bucket/runs", f"one that is none ({error})") from None
