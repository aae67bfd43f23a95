"""``atoll query``."""

from __future__ import annotations

import tempfile
from pathlib import Path

import click

from genome.errors import InputError
from genome.files import write_whole
from orchestrator.commands._options import emit, example, json_option


@click.command(
    "query",
    epilog=example(
        'atoll query runs/drape "select island, max(fitness) from individuals group by island order by island"'
    ),
)
@click.argument("run")
@click.argument("sql")
@click.option(
    "--format", "form", type=click.Choice(["table", "csv", "json", "parquet"]), default="table", show_default=True
)
@click.option("-o", "output", type=click.Path(path_type=Path, dir_okay=False), help="A file in place of stdout.")
@json_option
def command(run: str, sql: str, form: str, output: Path | None, as_json: bool) -> None:
    """Put an SQL query to RUN's log.

    The views are individuals, evaluations, generations, migrations and events; the log of a run that still goes on
    can be read too. One query that only reads, in DuckDB's SQL; columns of one name are numbered (a, a_1).
    """
    from orchestrator import query
    from orchestrator.folder import open_remains

    log = open_remains(run).log
    if output is not None and not output.parent.is_dir():
        raise InputError("-o", "a file in a folder that exists", str(output))
    if form == "parquet" and not as_json:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "answer.parquet"
            query.write_parquet(log, sql, path)
            _put(path.read_bytes(), output)
        return
    answer = query.ask(log, sql)
    if as_json:
        emit({"rows": query.as_rows(answer)})
        return
    if form == "json":
        import json

        text = json.dumps({"rows": query.as_rows(answer)}, allow_nan=False) + "\n"
    else:
        text = query.as_csv(answer) if form == "csv" else query.as_table(answer) + "\n"
    _put(text.encode(), output)


def _put(content: bytes, output: Path | None) -> None:
    if output is None:
        click.echo(content, nl=False)
    else:
        write_whole(output, content)
