"""Each experiment loads, and has a page with a picture, its settings, and what to change first that can be changed."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

from orchestrator.loading import load_experiment

ROOT = Path(__file__).resolve().parents[2]
PAGES = ROOT / "docs" / "experiments"
EXPERIMENTS = sorted(path for path in (ROOT / "experiments").glob("*.yaml") if not path.name.endswith(".env.yaml"))


@pytest.mark.parametrize("path", EXPERIMENTS, ids=lambda path: path.stem)
def test_an_experiment_has_a_page(path: Path) -> None:
    page = (PAGES / f"{path.stem}.md").read_text(encoding="utf-8")
    assert page.startswith(f"# {path.stem}")
    assert f"experiments/{path.name}" in page
    for picture in re.findall(r"!\[[^\]]+\]\(([^)]+)\)", page) or ["none"]:
        assert (PAGES / picture).is_file(), picture
    assert "change first" in page.lower()
    for changes in re.findall(r"`((?:--set [^`]+?)+)`", page.replace("\n", " ")):
        words = shlex.split(changes)
        loaded = load_experiment(path, words[1::2])
        assert loaded.experiment != load_experiment(path).experiment, changes
        assert not [note for note in loaded.notes if note not in load_experiment(path).notes], changes
    assert load_experiment(path).experiment.name == path.stem
