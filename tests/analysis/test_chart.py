"""Charts of scores over generations."""

from __future__ import annotations

import io

import pytest
from click.testing import CliRunner

from analysis.chart import lines_of, write_chart
from experiments import bits, run
from genome.errors import InputError
from orchestrator.cli import main
from orchestrator.folder import RunFolder, open_run
from orchestrator.query import ask


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> RunFolder:
    return open_run(str(run(tmp_path_factory.mktemp("chart"), bits()).folder))


def test_a_line_holds_the_best_and_the_mean_of_who_was_scored(folder: RunFolder) -> None:
    (line, *others) = lines_of(folder, "fitness")
    sql = f"""select generation, max(fitness), avg(fitness) from
              (select generation, fitness, island from individuals
               union all select generation, fitness, island from evaluations)
              where island = '{line.name}' or island like '{line.name}-%' group by all order by all"""
    rows = ask(folder.log, sql).rows
    for column, values in zip(line[1:], zip(*rows, strict=True), strict=True):
        assert column == pytest.approx(values)
    assert line.name not in {other.name for other in others}


@pytest.mark.parametrize("suffix", ["png", "svg"])
def test_the_same_log_gives_the_same_picture(folder: RunFolder, tmp_path, suffix: str) -> None:
    paths = [tmp_path / f"{name}.{suffix}" for name in ("one", "other")]
    for path in paths:
        write_chart(folder, "ones", path)
    first, second = (path.read_bytes() for path in paths)
    assert first == second
    if suffix == "png":
        from PIL import Image

        picture = Image.open(io.BytesIO(first))
        assert picture.size == (960, 540)
        assert len(picture.convert("RGB").getcolors(2**20)) > 10
    else:
        assert b">ones<" in first


def test_what_cannot_be_drawn_is_told(folder: RunFolder, tmp_path) -> None:
    with pytest.raises(InputError, match="did you mean 'ones'"):
        write_chart(folder, "onse", tmp_path / "x.png")
    with pytest.raises(InputError, match=r"ends with \.png or \.svg"):
        write_chart(folder, "ones", tmp_path / "x.pdf")
    assert list(tmp_path.iterdir()) == []


def test_the_command_names_its_file(folder: RunFolder, tmp_path) -> None:
    path = tmp_path / "score.svg"
    done = CliRunner().invoke(main, ["chart", str(folder.path), "--score", "ones", "-o", str(path)])
    assert (done.exit_code, done.output) == (0, f"{path}\n")
    assert path.is_file()
