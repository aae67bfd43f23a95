"""The one error that bad input raises, in every room of the house.

An :class:`InputError` says where the trouble is, what was expected, what came, and what to do about it. The
command line prints it as it is and exits with code 2; inside evolution nothing raises it.
"""

from __future__ import annotations


class InputError(ValueError):
    """Bad input, described for the person who wrote it.

    Parameters
    ----------
    where
        The place: ``file:line:column``, or ``file: key.path``, or a flag of the command line.
    expected
        What would have been right.
    got
        What came instead.
    remedy
        What to do; may be empty where it is plain from the rest.
    """

    def __init__(self, where: str, expected: str, got: str, remedy: str = "") -> None:
        self.where = where
        self.expected = expected
        self.got = got
        self.remedy = remedy
        super().__init__(where, expected, got, remedy)

    def __str__(self) -> str:
        text = f"{self.where}: expected {self.expected}, got {self.got}"
        return f"{text}; {self.remedy}" if self.remedy else text
