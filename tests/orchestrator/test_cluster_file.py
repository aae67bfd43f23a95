"""The cluster launcher file against Ray's own schema."""

from __future__ import annotations

from pathlib import Path

import pytest

from genome.yaml import load_yaml

ROOT = Path(__file__).parents[2]


def test_cluster_yaml_is_valid_for_ray_up_and_names_every_node_type() -> None:
    util = pytest.importorskip("ray.autoscaler._private.util")
    config = util.prepare_config(load_yaml(ROOT / "cluster.yaml").data)
    util.validate_config(config)
    assert config["head_node_type"] in config["available_node_types"]


def test_a_run_finds_free_cpus_as_soon_as_the_cluster_stands() -> None:
    """A run refuses a cluster without one, and never asks for more than there are."""
    types = load_yaml(ROOT / "cluster.yaml").data["available_node_types"]
    cpus = {name: node["min_workers"] * node["resources"]["CPU"] for name, node in types.items()}
    assert cpus == {"head": 0, "worker": 32}


def test_a_setting_of_an_experiment_does_not_belong_there() -> None:
    util = pytest.importorskip("ray.autoscaler._private.util")
    config = load_yaml(ROOT / "cluster.yaml").data | {"islands": {}}
    with pytest.raises(Exception, match="'islands' was unexpected"):
        util.validate_config(util.prepare_config(config))
