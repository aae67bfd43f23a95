"""Opening S3: Amazon's, or a server that speaks like it."""

from __future__ import annotations

import os
from dataclasses import replace
from typing import Any, Final
from urllib.parse import urlsplit

from genome.errors import InputError
from genome.settings import near
from islands.stores.places import Place
from islands.stores.troubles import told

OPTIONS: Final = ("endpoint_override", "region", "scheme")
CONNECT_S: Final = 3
SILENCE_S: Final = 5
"""Seconds without a byte after which a request has failed."""
ATTEMPTS: Final = 3
"""Of each request; a store that is down is told of within seconds."""


def open_s3(place: Place) -> tuple[Any, str, Place]:
    """Give the file system, the folder's path in it, and the place with all that opening it again needs.

    The endpoint and the region come from the URI, else from the environment (``AWS_ENDPOINT_URL_S3``,
    ``AWS_ENDPOINT_URL``; ``AWS_REGION``, ``AWS_DEFAULT_REGION``); Amazon is asked for the region of its own buckets.
    Keys come from the environment, or what else the SDK knows (profiles, roles of a machine).

    Raises
    ------
    InputError
        For an option that S3 does not have, or an endpoint that is none.
    StoreError
        When Amazon does not tell the bucket's region.
    """
    from pyarrow.fs import AwsStandardS3RetryStrategy, S3FileSystem

    for name in place.options:
        if name not in OPTIONS:
            raise InputError(place.bare(), f"options {', '.join(OPTIONS)}", f"'{name}'", near(name, list(OPTIONS)))
    options = dict(place.options)
    endpoint, scheme = _endpoint(place)
    if endpoint:
        options.update(endpoint_override=endpoint, scheme=scheme)
    options["region"] = options.get("region") or _region(place, endpoint)
    files = S3FileSystem(
        **options,
        connect_timeout=CONNECT_S,
        request_timeout=SILENCE_S,
        retry_strategy=AwsStandardS3RetryStrategy(max_attempts=ATTEMPTS),
        allow_delayed_open=True,  # one PUT for a file of few megabytes
    )
    full = replace(place, options=dict(sorted(options.items())))
    return files, f"{place.authority}/{place.path}".rstrip("/"), full


def _endpoint(place: Place) -> tuple[str, str]:
    """Give the endpoint's address and scheme; empty ones for Amazon."""
    given = place.options.get("endpoint_override", "")
    where = "endpoint_override" if given else "AWS_ENDPOINT_URL"
    text = given or os.environ.get("AWS_ENDPOINT_URL_S3", "") or os.environ.get("AWS_ENDPOINT_URL", "")
    if not text:
        return "", ""
    url = urlsplit(text if "://" in text else f"{place.options.get('scheme', 'https')}://{text}")
    if "@" in url.netloc or not url.netloc or url.scheme not in ("http", "https"):
        got = "one with something before '@'" if "@" in url.netloc else f"'{text}'"
        raise InputError(where, "an address such as http://localhost:9000", got, "keys have variables of their own")
    return url.netloc + url.path.rstrip("/"), url.scheme


def _region(place: Place, endpoint: str) -> str:
    from pyarrow.fs import resolve_s3_region

    region = os.environ.get("AWS_REGION") or os.environ.get("AWS_DEFAULT_REGION")
    if region or endpoint:
        return region or "us-east-1"
    try:
        return str(resolve_s3_region(place.authority))
    except OSError as error:
        raise told(place.bare(), "a bucket of Amazon's whose region can be asked for", error) from None
