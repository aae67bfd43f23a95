"""The pictures of the experiments' pages, made anew from their runs.

``python -m benchmarks.pictures [NAME ...]`` runs the experiments named, or all (half an hour), and writes
``docs/img/NAME.png``: the best form, several side by side, a contact sheet, or a chart where there is no form.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from click.testing import CliRunner
from PIL import Image

from orchestrator.cli import main as atoll

ROOT: Final = Path(__file__).parents[1]
IMAGES: Final = ROOT / "docs" / "img"
CHARTS: Final = {"partners": "fitness", "arms_race": "fitness"}
SHEETS: Final = {"archipelago": ("house", "tower", "cloth", "walls", "meadow")}
SEVERAL: Final = {"symmetry": 6}
WIDTH: Final = 1000


def called(*arguments: object) -> None:
    """Call a command; its messages are shown where it fails."""
    result = CliRunner().invoke(atoll, [str(argument) for argument in arguments])
    assert result.exit_code == 0, result.output


def drawn(name: str, folder: Path) -> None:
    """Run an experiment, and draw its page's picture."""
    called("run", ROOT / "experiments" / f"{name}.yaml", "--runs-dir", folder, "--name", name)
    run, path = folder / name, folder / f"{name}.png"
    if name in CHARTS:
        called("chart", run, "--score", CHARTS[name], "-o", path)
    elif name in SHEETS:
        called("sheet", run, *(word for island in SHEETS[name] for word in ("--island", island)), "-o", path)
    else:
        count = SEVERAL.get(name, 1)
        called("export", run, "--best", count, "--format", "png", "-o", folder / "forms")
        side_by_side(sorted((folder / "forms").glob("*.png"), key=lambda one: one.stat().st_mtime)).save(path)
    image = Image.open(path).convert("RGB")
    image.thumbnail((WIDTH, 3 * WIDTH))
    image.quantize(256).save(IMAGES / f"{name}.png", optimize=True)


def side_by_side(paths: Sequence[Path]) -> Image.Image:
    """Put pictures into rows of three."""
    images = [Image.open(path) for path in paths]
    wide, tall = max(one.width for one in images), max(one.height for one in images)
    columns = min(3, len(images))
    whole = Image.new("RGB", (columns * wide, -(-len(images) // columns) * tall), "#ffffff")
    for place, one in enumerate(images):
        whole.paste(one, (place % columns * wide, place // columns * tall))
    return whole


def main(names: Sequence[str]) -> None:
    """Draw all, or those named."""
    known = sorted(path.stem for path in (ROOT / "experiments").glob("*.yaml") if not path.name.endswith(".env.yaml"))
    for name in names or known:
        with tempfile.TemporaryDirectory(prefix="atoll-") as here:
            drawn(name, Path(here))
        print(f"docs/img/{name}.png")


if __name__ == "__main__":
    main(sys.argv[1:])
