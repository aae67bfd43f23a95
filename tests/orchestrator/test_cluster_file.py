"""The cluster launcher file against Ray's own schema."""

from __future__ import annotations

import re
import shlex
import tomllib
from pathlib import Path

import pytest

from genome.yaml import load_yaml

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("name", ["cluster.yaml", "deploy/on-premise.yaml"])
def test_cluster_files_are_valid_for_ray_up_and_name_every_node_type(name) -> None:
    util = pytest.importorskip("ray.autoscaler._private.util")
    config = util.prepare_config(load_yaml(ROOT / name).data)
    util.validate_config(config)
    assert config["head_node_type"] in config["available_node_types"]


def test_the_kubernetes_job_asks_for_the_ray_that_is_locked_and_for_cpus_that_stand_when_it_starts() -> None:
    job = load_yaml(ROOT / "deploy" / "kuberay.yaml").data
    assert (job["apiVersion"], job["kind"]) == ("ray.io/v1", "RayJob")
    cluster = job["spec"]["rayClusterSpec"]
    (locked,) = re.findall(r"^ray==(\S+)", (ROOT / "requirements.lock").read_text(encoding="utf-8"), re.MULTILINE)
    assert cluster["rayVersion"] == locked
    (workers,) = cluster["workerGroupSpecs"]
    assert workers["replicas"] == workers["minReplicas"] == workers["maxReplicas"] == 4
    pods = [cluster["headGroupSpec"]["template"], workers["template"]]
    containers = [container for pod in pods for container in pod["spec"]["containers"]]
    assert len({container["image"] for container in containers}) == 1
    assert all(container["resources"]["requests"] == container["resources"]["limits"] for container in containers)
    # What it calls is a command of atoll with options that it has, and an experiment that is in the image.
    program, *words = shlex.split(job["spec"]["entrypoint"])
    assert program == "atoll"
    from orchestrator.commands.run import command

    context = command.make_context("run", words[1:])
    assert (context.params["address"], context.params["runs_dir"]) == ("auto", "s3://bucket/runs")
    assert (ROOT / context.params["experiment"]).is_file()


def test_the_image_takes_in_every_package() -> None:
    lines = (ROOT / "deploy" / "Dockerfile").read_text(encoding="utf-8").splitlines()
    copied = {line.split()[1] for line in lines if line.startswith("COPY") and line.split()[1] == line.split()[2]}
    packages = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    assert copied == {*packages["tool"]["hatch"]["build"]["targets"]["wheel"]["packages"], "experiments"}


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
