"""Criteria as a plug-in would bring them: one good, the others bad in their own ways."""

import numpy as np


def vertices(surface, environment):
    return np.int64(len(surface.vertices))


def raises(surface, environment):
    raise RuntimeError("no\n  luck")


def leaves(surface, environment):
    raise SystemExit(3)


def speaks_badly(surface, environment):
    raise ValueError("bad \udcff text")


def beyond_floats(surface, environment):
    return 10**400


def infinite(surface, environment):
    return float("inf")


def undefined(surface, environment):
    return np.float64("nan")


def text(surface, environment):
    return "1.0"


def truth(surface, environment):
    return True


def writes(surface, environment):
    surface.vertices[:] = 0
    return 0.0


class Holder:
    inner = staticmethod(vertices)


NUMBER = 3
