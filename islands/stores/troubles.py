"""What went wrong with a store, in words that help, and without what must not be told."""

from __future__ import annotations

import re
from typing import Final

from genome.mishaps import one_line
from islands.store import StoreError

AWS: Final = re.compile(r"AWS Error (\w+) during (\w+) operation(?: \(HTTP status \d+\))?:? ?(.*)", re.DOTALL)
KEYS: Final = "check AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY, and that they may read and write there"
NETWORK: Final = "check the network and the endpoint (AWS_ENDPOINT_URL, or endpoint_override in the URI)"

REFUSALS: Final = {
    "INVALID_ACCESS_KEY_ID": "an access key that it does not know",
    "SIGNATURE_DOES_NOT_MATCH": "a secret key that is not the access key's",
    "INVALID_SIGNATURE": "a secret key that is not the access key's",
    "INVALID_CLIENT_TOKEN_ID": "an access key that it does not know",
    "UNRECOGNIZED_CLIENT": "an access key that it does not know",
    "MISSING_AUTHENTICATION_TOKEN": "no keys",
    "EXPIRED_TOKEN": "a session that is over",
    "ACCESS_DENIED": "access denied",
}


def told(where: str, expected: str, error: Exception) -> StoreError:
    """Turn an error of Arrow's into one that says what to do.

    Parameters
    ----------
    where
        The place, without secrets.
    expected
        What would have been right.
    error
        What Arrow raised.
    """
    text = one_line(str(error))
    found = AWS.search(text)
    if found is None:
        return StoreError(where, expected, text[:300], "check the place, the network and your credentials")
    code, operation, detail = found.groups()
    if code in REFUSALS:
        return StoreError(where, expected, REFUSALS[code], KEYS)
    if code == "NO_SUCH_BUCKET":
        return StoreError(where, "a bucket that is there", "none by that name", "make the bucket first")
    if code == "NETWORK_CONNECTION":
        reason = detail.partition("; Details: ")[2] or detail or "the connection failed"
        return StoreError(where, expected, f"no connection ({reason.strip()})", NETWORK)
    if code == "INTERNAL_FAILURE" and not detail.strip():
        # What Arrow says of requests without keys that are refused, too.
        return StoreError(where, expected, f"a failure of {operation} without a reason", KEYS)
    return StoreError(where, expected, f"{code} of {operation} ({detail[:200].strip()})", KEYS)
