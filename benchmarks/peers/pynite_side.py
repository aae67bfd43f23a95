"""PyNiteFEA's side of the comparison of frames: run in the peers' environment, JSON in, JSON out.

In: ``rounds`` and ``frames``, each with ``nodes`` (coordinates), ``clamped`` (places), ``members`` (pairs of places),
``section`` (E, G, A, I, J) and ``weight`` on each node. Out: for each frame ``carried``, per member the force and the
moment, in world axes, that its second node does to its first at its middle, and ``seconds`` of assembly and solution,
the best of the rounds.
"""

from __future__ import annotations

import json
import sys
import time
from typing import Any

import numpy as np


def model(frame: dict[str, Any]) -> Any:  # noqa: ANN401 - PyNite has no types
    """Build a frame in PyNite."""
    from Pynite import FEModel3D

    young, shear, area, second, torsion = frame["section"]
    out = FEModel3D()
    out.add_material("block", young, shear, 0.2, 0.0)
    out.add_section("square", area, second, second, torsion)
    clamped = set(frame["clamped"])
    for place, (x, y, z) in enumerate(frame["nodes"]):
        out.add_node(f"N{place}", x, y, z)
        if place in clamped:
            out.def_support(f"N{place}", *[True] * 6)
        else:
            out.add_node_load(f"N{place}", "FZ", -frame["weight"])
    for place, (a, b) in enumerate(frame["members"]):
        out.add_member(f"M{place}", f"N{a}", f"N{b}", "block", "square")
    return out


def solved(frame: dict[str, Any]) -> tuple[Any, float]:
    """Build and solve; give the model and the time that it took."""
    start = time.perf_counter()
    out = model(frame)
    out.analyze_linear(check_statics=False, sparse=True)
    return out, time.perf_counter() - start


def carried(frame: dict[str, Any], solution: Any) -> list[list[float]]:  # noqa: ANN401
    """Read the members' forces and moments at their middles."""
    rows = []
    for place, (a, b) in enumerate(frame["members"]):
        member = solution.members[f"M{place}"]
        whole = (np.asarray(member.T()).T @ np.asarray(member.f("Combo 1"))).ravel()
        force, moment = whole[:3], whole[3:6]  # what the first node does to the member
        arm = (np.array(frame["nodes"][a], float) - np.array(frame["nodes"][b], float)) / 2.0
        rows.append([*(-force), *(-moment - np.cross(arm, force))])
    return [[float(value) for value in row] for row in rows]


def main() -> None:
    """Solve the frames of standard input."""
    asked = json.load(sys.stdin)
    out = []
    for frame in asked["frames"]:
        best = float("inf")
        for _ in range(asked["rounds"]):
            solution, seconds = solved(frame)
            best = min(best, seconds)
        out.append({"carried": carried(frame, solution), "seconds": best})
    json.dump(out, sys.stdout)


if __name__ == "__main__":
    main()
