"""``atoll grow``."""

from __future__ import annotations

from pathlib import Path

import click

from orchestrator.commands._options import emit, example, json_option


@click.command(
    "grow",
    epilog=example(
        "atoll grow experiments/systems/square.hemls --steps 4 -o square.glb",
        "atoll grow experiments/systems/triangle.hemls --environment site.env.yaml --set scale=1.3 --json",
    ),
)
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--steps", type=int, help="Derivation steps.")
@click.option("--time", "until", type=float, help="For timed systems: the time to grow to.")
@click.option("--environment", type=click.Path(path_type=Path), help="An environment file; empty space without.")
@click.option("--set", "overrides", multiple=True, metavar="KEY=VALUE", help="A setting of growth, such as scale.")
@click.option("--seed", type=click.IntRange(min=0), default=0, help="For systems that draw at random.")
@click.option("-o", "output", type=click.Path(path_type=Path, dir_okay=False),
              help="The form's file: .glb, .obj, .ply, .stl or .png.")  # fmt: skip
@json_option
def command(
    file: Path,
    steps: int | None,
    until: float | None,
    environment: Path | None,
    overrides: tuple[str, ...],
    seed: int,
    output: Path | None,
    as_json: bool,
) -> None:
    """Grow one form from FILE, a rule file; the engine goes by its suffix."""
    from orchestrator.cli import Complaint
    from orchestrator.growing import Request, engine_for

    engine = engine_for(file)
    grown = engine(Request(file, steps, until, environment, overrides, seed, output))
    if isinstance(grown, str):
        raise Complaint(grown, 1)
    if as_json:
        emit(grown)
        return
    for key, value in grown.items():
        shown = f"{value:.6g}" if isinstance(value, float) else value
        click.echo(f"{key}: {shown}")
