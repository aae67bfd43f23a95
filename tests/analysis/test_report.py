"""``atoll report``: what it shows is what its queries give, and what is missing is said."""

from __future__ import annotations

import html
import json
import re
import shutil
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from analysis.report.drawing import drawn
from analysis.report.parts import cell_text
from analysis.stages import evenly, group_of, stages
from orchestrator.cli import main
from orchestrator.folder import open_run
from orchestrator.query import ask

EXPERIMENT = """
name: small
seed: 4
epoch: 2
epochs: 2
backend: inline
islands:
  net:
    kind: surface
    count: 2
    population: 6
    genome: {grammar: genr8, length: 60}
    growth: {steps: 2, max_elements: 200}
    fitness: {size: {goal: maximise}}
  dots:
    kind: bits
    count: 2
    population: 6
    genome: {length: 12}
    fitness: {ones: {goal: maximise}}
channels:
  - {kind: migrants, topology: ring, among: net, every: 1, count: 1}
  - {kind: migrants, topology: ring, among: dots, every: 1, count: 2}
"""


def atoll(*arguments: object) -> Any:
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("reports")
    (folder / "small.yaml").write_text(EXPERIMENT, encoding="utf-8")
    result = atoll("run", folder / "small.yaml", "--runs-dir", folder, "--json")
    assert result.exit_code == 0, result.output
    return folder / "small"


@pytest.fixture
def copy(done: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(done, tmp_path / "small"))


@pytest.fixture(autouse=True)
def small_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("analysis.thumbnails.SIZE", (40, 30))


class Reader(HTMLParser):
    """Finds what a page refers to, its figures, and that its elements close."""

    VOID = frozenset({"meta", "link", "img", "br", "path", "use"})

    def __init__(self) -> None:
        super().__init__(convert_charrefs=True)
        self.open: list[str] = []
        self.links: list[str] = []
        self.ids: list[str] = []
        self.images: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        for name in ("src", "href", "xlink:href"):
            if given.get(name) is not None:
                self.links.append(given[name] or "")
        if "id" in given:
            self.ids.append(given["id"] or "")
        if tag == "img":
            self.images.append(given["src"] or "")
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        if tag not in self.VOID:
            assert self.open.pop() == tag

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.handle_starttag(tag, attrs)
        if tag not in self.VOID:
            self.open.pop()


def read(path: Path) -> tuple[Reader, str]:
    text = path.read_text(encoding="utf-8")
    reader = Reader()
    reader.feed(text)
    assert reader.open == []
    return reader, text


def reported(run: Path, output: Path) -> tuple[Reader, str]:
    result = atoll("report", run, "-o", output, "--json")
    assert result.exit_code == 0, result.output
    assert json.loads(result.stdout.splitlines()[-1]) == {"report": str(output)}
    return read(output)


def troubles(text: str) -> list[str]:
    return [html.unescape(found) for found in re.findall(r'<p class="trouble" role="note">(.*?)</p>', text, re.DOTALL)]


def test_a_report_asks_nothing_of_the_network_and_stands_in_the_run(done: Path) -> None:
    result = atoll("report", done)
    assert result.exit_code == 0, result.output
    assert result.stdout.strip() == str(done / "report.html")
    reader, text = read(done / "report.html")
    assert all(link.startswith(("#", "data:")) for link in reader.links)
    assert not re.search(r"@import|url\((?!#)|<script", text)
    assert len(reader.ids) == len(set(reader.ids))
    assert {link[1:] for link in reader.links if link.startswith("#")} <= set(reader.ids)
    assert len(reader.images) == 2 * 4  # two islands of surfaces at three epochs, and their best; bits have no pictures
    assert troubles(text) == [
        "dots-0: individuals of its kind have no picture, or grow to no form",
        "dots-1: individuals of its kind have no picture, or grow to no form",
    ]


def test_the_numbers_are_those_that_the_queries_give(done: Path, tmp_path: Path) -> None:
    _, text = reported(done, tmp_path / "report.html")
    figures = re.findall(r'<figure class="figure.*?</figure>', text, re.DOTALL)
    assert len(figures) >= 10
    for figure in figures:
        (sql,) = re.findall(r"<pre>(.*?)</pre>", figure, re.DOTALL)
        answer = ask(open_run(str(done)).log, html.unescape(sql))
        columns = [html.unescape(name) for name in re.findall(r'<th(?: class="number")?>(.*?)</th>', figure)]
        rows = [
            [html.unescape(cell) for cell in re.findall(r"<td[^>]*>(.*?)</td>", row, re.DOTALL)]
            for row in re.findall(r"<tr>(.*?)</tr>", figure.partition("<tbody>")[2], re.DOTALL)
        ]
        assert tuple(columns) == answer.columns
        assert rows == [[cell_text(cell) for cell in row] for row in answer.rows]


def test_the_same_run_gives_the_same_report(done: Path, tmp_path: Path) -> None:
    assert reported(done, tmp_path / "one.html")[1] == reported(done, tmp_path / "two.html")[1]


def test_a_killed_run_is_shown_and_said(copy: Path) -> None:
    manifest = json.loads((copy / "manifest.json").read_text())
    (copy / "manifest.json").write_text(json.dumps({**manifest, "status": "running", "ended": None}))
    _, text = reported(copy, copy / "report.html")
    assert "The run was killed: this is what its log has. It goes on with: atoll resume small" in text


def test_missing_rows_are_told(copy: Path) -> None:
    first, *_ = sorted((copy / "log" / "individuals").glob("*.parquet"))
    first.unlink()
    _, text = reported(copy, copy / "report.html")
    assert any("files are missing" in trouble for trouble in troubles(text))


def test_a_damaged_table_leaves_the_rest_to_be_seen(copy: Path) -> None:
    for path in (copy / "log" / "migrations").glob("*.parquet"):
        path.write_bytes(b"PAR1 no more")
    _, text = reported(copy, copy / "report.html")
    shown = text.partition('<section id="channels">')
    assert any("cannot be shown" in trouble for trouble in troubles(shown[2].partition("</section>")[0]))
    assert "net: fitness" in text
    assert "Ancestors of the champions" in shown[2]


def test_without_a_manifest_that_can_be_read_the_log_tells_of_the_islands(copy: Path) -> None:
    (copy / "manifest.json").write_text("{")
    reader, text = reported(copy, copy / "report.html")
    assert "manifest.json" in troubles(text)[0]
    assert len(reader.images) == 2 * 4
    assert "nobody is valid" not in text


def test_without_a_manifest_all_that_only_reads_goes_on(copy: Path, tmp_path: Path) -> None:
    (copy / "manifest.json").unlink()
    reader, text = reported(copy, tmp_path / "report.html")
    assert "manifest.json: expected a run's manifest" in troubles(text)[0]
    assert len(reader.images) == 2 * 4
    for arguments in (
        ("sheet", copy, "-o", tmp_path / "sheet.png"),
        ("chart", copy, "-o", tmp_path / "chart.png"),
        ("query", copy, "select count(*) from individuals"),
        ("digest", copy),
        ("export", copy, "--island", "net", "-o", tmp_path / "forms"),
    ):
        result = atoll(*arguments)
        assert result.exit_code == 0, result.output
    result = atoll("resume", copy)
    assert result.exit_code == 2
    assert "expected a run's folder, got one without manifest.json" in result.stderr
    shutil.rmtree(copy / "log")
    assert atoll("report", copy).exit_code == 2


def test_without_the_experiment_there_are_numbers_and_no_pictures(copy: Path) -> None:
    (copy / "experiment.yaml").unlink()
    reader, text = reported(copy, copy / "report.html")
    assert reader.images == []
    assert [trouble.partition("experiment.yaml: ")[2] for trouble in troubles(text)] == [
        "expected a YAML file, got no such file; check the path",
        "expected the experiment as it was resolved, got no such file",
    ]
    assert "net: fitness" in text


def test_a_run_of_which_nothing_is_logged_yet(copy: Path) -> None:
    shutil.rmtree(copy / "log")
    (copy / "log").mkdir()
    reader, text = reported(copy, copy / "report.html")
    assert reader.images == []
    assert "There is no file of the log at" in troubles(text)[0]
    assert "Nothing has travelled on a channel." in text
    assert "Nobody was bred." in text


def test_what_names_hold_is_written_as_text(copy: Path) -> None:
    experiment = (copy / "experiment.yaml").read_text(encoding="utf-8")
    (copy / "experiment.yaml").write_text(experiment + "# <script>alert(1)</script>\n", encoding="utf-8")
    _, text = reported(copy, copy / "report.html")
    assert "<script" not in text


def test_a_folder_that_is_not_there_is_refused(done: Path) -> None:
    result = atoll("report", done, "-o", done / "nowhere" / "report.html")
    assert (result.exit_code, result.stdout) == (2, "")
    assert "-o: expected a file in a folder that exists" in result.stderr


def test_stages_are_the_best_of_the_last_epoch_up_to_each(done: Path) -> None:
    plan = stages(open_run(str(done)), ["net-0", "net-1", "dots-0", "dots-1", "none"], count=3, most=3)
    assert plan.epochs == (0, 1, 2)
    assert [row.island for row in plan.rows] == ["net-0", "net-1", "dots-0"]
    assert (plan.left_out, plan.without) == (("dots-1",), ("none",))
    for row in plan.rows:
        for cell in row.cells[:-1]:
            assert cell is not None
            here = f"island = '{row.island}' and epoch = {cell.epoch}"
            sql = f"select id from individuals where {here} order by fitness desc, id"
            assert ask(open_run(str(done)).log, sql).rows[0] == (cell.id,)
            assert cell.epoch == cell.stage
        best = f"select id from individuals where island = '{row.island}' order by fitness desc, epoch, id"
        assert row.cells[-1] is not None
        assert ask(open_run(str(done)).log, best).rows[0] == (row.cells[-1].id,)


def test_stages_are_evenly_apart_and_groups_are_named_before_the_number() -> None:
    assert evenly(80, 5) == (0, 20, 40, 60, 80)
    assert evenly(2, 5) == (0, 1, 2)
    assert evenly(0, 5) == (0,)
    assert [group_of(name) for name in ("north-3", "north", "a-b", "a-b-10", "-1")] == [
        "north",
        "north",
        "a-b",
        "a-b",
        "",
    ]


def test_drawings_of_one_page_share_no_ids() -> None:
    one, other = (drawn(name, lambda axes: axes.plot([1, 2], [3, 4])) for name in ("one", "other"))
    ids = [re.findall(r'\bid="([^"]+)"', text) for text in (one, other)]
    assert not set(ids[0]) & set(ids[1])
    for text, own in zip((one, other), ids, strict=True):
        assert set(re.findall(r'(?:url\(|href=")#([^")]+)', text)) <= set(own)
    assert drawn("one", lambda axes: axes.plot([1, 2], [3, 4])) == one
