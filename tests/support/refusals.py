"""Experiments that cannot be meant, as people ask for them on the command line."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from click.testing import CliRunner

from experiments import write
from orchestrator.cli import main


def refused(folder: Path, data: dict[str, Any]) -> list[str]:
    """Check and run an experiment; give the one line that each says of it, which names the file. No run is made."""
    path = write(folder, data)
    lines = []
    for arguments in (["check", path], ["run", path, "--runs-dir", folder / "runs"]):
        result = CliRunner().invoke(main, [str(argument) for argument in arguments])
        assert result.exit_code == 2, result.output
        assert result.stdout == ""
        (line,) = result.stderr.strip().splitlines()
        assert line.startswith(f"atoll: {path}:")
        assert not (folder / "runs").exists()
        lines.append(line)
    return lines
