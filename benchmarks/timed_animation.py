"""An animated GLB file, against a GLB file for each time by trimesh; and how long criteria take, beside the growth.

The animal goes through one cycle of its gait in 51 drawings, whose parts move; the flower grows in 81, in which parts
are born and vertices move within parts. trimesh is given each drawing as one mesh of triangles, made before. Limits: in
no more time, and in no more bytes.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Final

import numpy as np
import trimesh
from trimesh.exchange.gltf import export_glb

from benchmarks.timing import best_of
from evaluators.timed import TIMED_CRITERIA, TimedForm, Unfolding, score, unfold
from genome.timed import parse_tl
from growth.forms import to_trimesh
from growth.timed.animation import animated_glb

SYSTEMS: Final = Path("experiments/systems")
ROUNDS: Final = 5
SHOWN: Final = (("gait", 2.0, 4.0, 51), ("flower", 0.0, 16.0, 81))


def unfolded(name: str, since: float, until: float, samples: int) -> Unfolding:
    """Draw a shipped system at even times."""
    system = parse_tl((SYSTEMS / f"{name}.tl").read_text(encoding="utf-8"), name)
    found = unfold(system, TimedForm(since=since, time=until, samples=samples))
    assert isinstance(found, Unfolding), found
    return found


def scene(mesh: trimesh.Trimesh) -> bytes:
    """Write one time by trimesh."""
    return bytes(export_glb(trimesh.Scene(mesh), include_normals=True))


def main() -> int:
    """Print ratios; give 1 where a limit is missed."""
    met = True
    for name, since, until, samples in SHOWN:
        unfolded(name, since, until, 2)  # the kernels' compilation is another matter
        form = unfolded(name, since, until, samples)
        meshes = [to_trimesh(one.surface()) for one in form.drawings if len(one)]
        ours, theirs = best_of(
            lambda form=form: animated_glb(form.drawings),  # type: ignore[misc]
            lambda meshes=meshes: [scene(mesh.copy()) for mesh in meshes],  # type: ignore[misc]
            rounds=ROUNDS,
        )
        size, sizes = len(animated_glb(form.drawings)), sum(len(scene(mesh)) for mesh in meshes)
        print(f"{name}, {samples} drawings: animated file {1e3 * ours:.0f} ms, {size / 1e6:.2f} MB; "
              f"a file each by trimesh {1e3 * theirs:.0f} ms, {sizes / 1e6:.2f} MB; "
              f"{theirs / ours:.1f} times as fast, {sizes / size:.1f} times as small")  # fmt: skip
        met &= ours <= theirs and size <= sizes
        grown, scored = best_of(
            lambda: unfolded(name, since, until, 12),  # noqa: B023 - called within the round
            lambda: score(form, TIMED_CRITERIA),  # noqa: B023
            rounds=ROUNDS,
        )
        shares = 1e3 * np.array([grown / 12, scored / samples])
        print(f"{name}: grown and drawn in {shares[0]:.1f} ms a time, all criteria {shares[1]:.1f} ms a time")
    return 0 if met else 1


if __name__ == "__main__":
    sys.exit(main())
