"""The criteria on grown forms: the figures of the square and triangle systems, and random genomes from end to end."""

from pathlib import Path

import numpy as np
import pytest

from evaluators.registry import CRITERIA
from evaluators.score import score
from genome.genr8 import Genr8Genome, Mapped
from genome.integers import random_genes
from growth.environment import Environment
from growth.hemls import SurfaceGrowth, grow, parse_system
from growth.surface import Surface

SYSTEMS = Path(__file__).parents[2] / "experiments" / "systems"
HERE = Environment.empty()


def grown(name, **settings):
    found = grow(parse_system((SYSTEMS / name).read_text(), name), SurfaceGrowth(**settings), HERE)
    assert isinstance(found, Surface)
    return found


@pytest.mark.parametrize("scale", [1.0, 1.5, 2.0])
@pytest.mark.parametrize(("steps", "vertices_to_edges"), [(0, 1), (1, 0.75), (2, 0.625), (3, 0.5625)])
def test_the_square_without_forces(steps, scale, vertices_to_edges):
    scores = score(grown("square.hemls", steps=steps, scale=scale), HERE, CRITERIA)
    assert scores == {
        "size": pytest.approx(2 * scale**steps, rel=1e-12),
        "smoothness": pytest.approx(0, abs=1e-12),
        "soft_boundaries": 0,
        "subdivisions": vertices_to_edges,
        "symmetry": 1,
        "undulation": pytest.approx(0, abs=1e-12),
    }


@pytest.mark.parametrize(("steps", "vertices", "edges"), [(1, 6, 9), (2, 15, 30), (3, 45, 108)])
def test_the_triangle_without_forces(steps, vertices, edges):
    scores = score(grown("triangle.hemls", steps=steps), HERE, CRITERIA)
    assert scores["subdivisions"] == vertices / edges
    assert scores["size"] == pytest.approx((1 + 3**0.5 / 2) * 1.5**steps)


def test_every_random_genome_maps_to_rules_that_grow_to_a_form_with_scores():
    genome = Genr8Genome()
    mapper = genome.mapper(Path())
    rng = np.random.default_rng(3)
    for _ in range(150):
        found = mapper.map(random_genes(rng, genome.length, genome.gene_ceiling))
        assert isinstance(found, Mapped)
        form = grow(parse_system(found.text, "genome"), SurfaceGrowth(steps=3), HERE)
        assert isinstance(form, Surface)
        assert list(score(form, HERE, CRITERIA)) == list(CRITERIA)
