"""The main job, ``experiments/archipelago.yaml``: every kind of island, and channels of all kinds in real use."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner

from genome.errors import InputError
from islands.kinds.registry import KINDS
from orchestrator.cli import main
from orchestrator.folder import open_run
from orchestrator.loading import load_experiment
from orchestrator.query import ask

ROOT = Path(__file__).resolve().parents[2]
JOB = ROOT / "experiments" / "archipelago.yaml"
PAGE = ROOT / "docs" / "experiments" / "archipelago.md"


def query_of_page() -> str:
    """Give the query that the page shows, which counts what channels brought that was of use."""
    _, _, rest = PAGE.read_text(encoding="utf-8").partition("```sql\n")
    return rest.partition("```")[0]


def test_it_has_every_kind_of_island_and_of_channel() -> None:
    experiment = load_experiment(JOB).experiment
    assert {island.kind for island in experiment.islands.values()} == set(KINDS) - {"bits"}
    assert {channel.kind for channel in experiment.channels} == {"migrants", "partners", "components", "surroundings"}


def test_scale_multiplies_islands_and_demes() -> None:
    def sizes(*overrides: str) -> dict[str, tuple[int, int]]:
        islands = load_experiment(JOB, overrides).experiment.islands
        return {name: (island.count, island.population) for name, island in islands.items()}

    plain = sizes()
    assert sizes("scale=3") == {name: (3 * count, 3 * members) for name, (count, members) in plain.items()}
    assert sizes("scale={islands: 2}") == {name: (2 * count, members) for name, (count, members) in plain.items()}
    assert sizes("scale={demes: 2}") == {name: (count, 2 * members) for name, (count, members) in plain.items()}
    assert load_experiment(JOB, ["scale=3"]).experiment.scale is None


@pytest.mark.parametrize("scale", ["0", "1.5", "true", "{island: 2}", "-1"])
def test_a_scale_that_is_none_is_refused(scale: str) -> None:
    with pytest.raises(InputError, match="scale"):
        load_experiment(JOB, [f"scale={scale}"])


def test_what_every_channel_brings_is_of_use(tmp_path: Path) -> None:
    shorter = [argument for one in ("backend=inline", "epochs=4", "forms.best=1") for argument in ("--set", one)]
    result = CliRunner().invoke(main, ["run", str(JOB), "--runs-dir", str(tmp_path), *shorter])
    assert result.exit_code == 0, result.output
    assert f"report {tmp_path / 'archipelago'}" in result.stdout
    folder = open_run(str(tmp_path / "archipelago"))
    rows = ask(folder.log, query_of_page()).rows
    experiment = load_experiment(JOB).experiment
    assert {(kind, channel) for kind, channel, *_ in rows} == {(one.kind, one.name) for one in experiment.channels}
    for kind, channel, accepted, uses in rows:
        assert accepted > 0, channel
        assert uses > 0, (kind, channel)
