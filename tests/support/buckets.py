"""A real S3 server on loopback, in a process of its own: moto's."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager

BUCKET = "bucket"
KEYS = {"AWS_ACCESS_KEY_ID": "anybody", "AWS_SECRET_ACCESS_KEY": "hush-hush-hush"}
CLEARED = ("AWS_REGION", "AWS_DEFAULT_REGION", "AWS_ENDPOINT_URL", "AWS_ENDPOINT_URL_S3", "AWS_PROFILE")


@contextmanager
def serving(*, closed: bool = False) -> Iterator[str]:
    """Serve a bucket; give the endpoint's URL.

    Parameters
    ----------
    closed
        Once the bucket is made, nobody is known. Without, everybody is let in.
    """
    server = subprocess.Popen(
        [sys.executable, "-m", "moto.server", "-H", "127.0.0.1", "-p", "0"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        assert server.stderr is not None
        found = next(filter(None, (re.search(r"http://127\.0\.0\.1:\d+", line) for line in server.stderr)))
        drain = subprocess.Popen(["cat"], stdin=server.stderr, stdout=subprocess.DEVNULL)  # it tells of each request
        make_bucket(found[0])
        if closed:
            # As anything but a form, whose content it would take for its own.
            asked = urllib.request.Request(
                f"{found[0]}/moto-api/reset-auth", data=b"0", headers={"Content-Type": "text/plain"}
            )
            urllib.request.urlopen(asked, timeout=60).close()
        yield found[0]
    finally:
        server.terminate()
        server.wait()
        drain.wait()
        server.stderr.close()


def make_bucket(endpoint: str) -> None:
    """Make the bucket."""
    from pyarrow.fs import S3FileSystem

    files = S3FileSystem(
        access_key=KEYS["AWS_ACCESS_KEY_ID"],
        secret_key=KEYS["AWS_SECRET_ACCESS_KEY"],
        endpoint_override=endpoint,
        region="us-east-1",
        allow_bucket_creation=True,
    )
    files.create_dir(BUCKET)


def environment(endpoint: str) -> dict[str, str]:
    """Give the variables with which the bucket can be reached."""
    return {**KEYS, "AWS_ENDPOINT_URL": endpoint, "AWS_EC2_METADATA_DISABLED": "true"}


@contextmanager
def reaching(endpoint: str, **others: str) -> Iterator[None]:
    """Set this process's variables to reach the bucket, for so long."""
    wanted = {**environment(endpoint), **others}
    before = {name: os.environ.get(name) for name in (*wanted, *CLEARED)}
    for name in CLEARED:
        os.environ.pop(name, None)
    os.environ.update(wanted)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value
