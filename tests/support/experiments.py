"""Experiments for tests: of bit strings, small and quick."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from orchestrator.loading import load_experiment
from orchestrator.run import Outcome, make_backend, run_experiment


def bits(**changes: Any) -> dict[str, Any]:
    """Four islands, three alike and one that scores otherwise, on a ring and one more channel."""
    data: dict[str, Any] = {
        "name": "bits",
        "seed": 7,
        "epochs": 4,
        "epoch": 3,
        "backend": "inline",
        "defaults": {"kind": "bits:BitsKind", "population": 12, "fitness": {"ones": {"goal": "maximise"}}},
        "islands": {
            "north": {"count": 3, "growth": {"fail_ending": "1111"}},
            "south": {"population": 9, "growth": {"invert": True}},
        },
        "channels": [
            {"kind": "migrants", "topology": "ring", "count": 2},
            {"from": "south", "to": "north-1", "every": 2, "select": "random", "replace": "random", "accept": "better"},
        ],
        "log": {"flush_generations": 5},
    }
    return {**data, **changes}


def write(folder: Path, data: dict[str, Any], name: str = "bits.yaml") -> Path:
    """JSON is YAML."""
    path = folder / name
    path.write_text(json.dumps(data, indent=1), encoding="utf-8")
    return path


class Silent:
    def begin(self, plan: Any, experiment: Any, folder: Path) -> None:
        pass

    def epoch(self, epoch: int, rows: Any) -> None:
        pass

    def note(self, text: str) -> None:
        pass

    def close(self) -> None:
        pass


def run(folder: Path, data: dict[str, Any] | None = None, *overrides: str, name: str | None = None) -> Outcome:
    loaded = load_experiment(write(folder, bits() if data is None else data), overrides)
    return run_experiment(loaded, make_backend(loaded, None), folder / "runs", name, Silent())
