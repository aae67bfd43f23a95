"""``frame`` against PyNiteFEA, on ten bodies that ``python -m benchmarks.blocks_loads --record`` wrote down."""

import json
from pathlib import Path

import numpy as np
import pytest

from evaluators.blocks.load import LoadSettings, analyse
from evaluators.blocks.load.layers import layers
from growth.blocks.body import Body
from growth.blocks.lattice import CUBIC, EDGE, VERTEX

RECORD = json.loads((Path(__file__).parent / "pynite.json").read_text())
BODIES = {
    row["name"]: Body(CUBIC, np.array(row["cells"], np.int64), np.array(row["systems"], np.uint8)) for row in RECORD
}


def loops(body):
    """How many joints more than a tree would need that hangs from the boundary as one."""
    found = layers(body)
    return len(found.joints) - np.count_nonzero(found.depth > 0)


@pytest.mark.parametrize("row", RECORD, ids=lambda row: row["name"])
def test_every_joint_carries_what_pynite_finds(row):
    load = analyse(BODIES[row["name"]], LoadSettings(model="frame"))
    carried = np.array(row["carried"])
    assert load.joints.tolist() == row["joints"]
    assert np.hstack([load.forces, load.moments]) == pytest.approx(carried, abs=1e-6 * np.abs(carried).max())


def test_there_are_ten_bodies_some_with_loops_some_trees_over_edges_and_corners():
    assert len(BODIES) == 10
    assert sum(loops(body) > 0 for body in BODIES.values()) >= 3
    for name, kind in (("tree over edges", EDGE), ("tree over corners", VERTEX)):
        found = layers(BODIES[name])
        inner = (found.depth[found.joints] > 0).all(axis=1)
        assert (found.kinds[inner] == kind).all()
        assert inner.sum() == len(BODIES[name].internal) - 1  # a tree
