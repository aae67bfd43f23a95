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
        "atoll grow experiments/systems/house.plan -o house.dxf",
        "atoll grow experiments/systems/arch.blocks --set load.axial_strength=30 --forces -o arch.png",
        "atoll grow experiments/systems/piston.tl --time 1.04 --word --json",
        "atoll grow experiments/systems/flower.tl --time 0:16:0.1 -o flower.glb",
    ),
)
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--steps", type=int, help="Derivation steps, or iterations; the usual ones without.")
@click.option("--time", "until", metavar="T", help="For timed systems: the time to grow to, or FROM:TO:STEP.")
@click.option("--environment", type=click.Path(path_type=Path), help="An environment file; empty space without.")
@click.option("--set", "overrides", multiple=True, metavar="KEY=VALUE", help="A setting of growth, such as scale.")
@click.option("--seed", type=click.IntRange(min=0), help="For systems that draw at random, in place of their own.")
@click.option("--forces", is_flag=True, help="For block bodies: what each joint carries; the form is coloured by it.")
@click.option("--word", is_flag=True, help="For timed systems: the word, as symbols, parameters and ages.")
@click.option("-o", "output", type=click.Path(path_type=Path, dir_okay=False),
              help="The form's file: .glb or .png; .obj, .stl, .ply (surfaces, timed forms), .npz (block bodies), "
              ".svg, .dxf, .ifc, .json (plans), .gif, .sheet.png (timed forms).")  # fmt: skip
@json_option
def command(
    file: Path,
    steps: int | None,
    until: str | None,
    environment: Path | None,
    overrides: tuple[str, ...],
    seed: int | None,
    forces: bool,
    word: bool,
    output: Path | None,
    as_json: bool,
) -> None:
    """Grow one form from FILE, and measure it: rules, an L-system, a plan, or a body; the engine goes by its suffix."""
    from orchestrator.cli import Complaint
    from orchestrator.growing import Request, engine_for

    engine = engine_for(file)
    grown = engine(Request(file, steps, until, environment, overrides, seed, output, forces, word))
    if isinstance(grown, str):
        raise Complaint(grown, 1)
    if as_json:
        emit(grown)
        return
    for key, value in grown.items():
        if isinstance(value, list) and value and isinstance(value[0], dict):
            for place, row in enumerate(value):
                click.echo(f"{key}.{place}: {' '.join(f'{name}={row[name]}' for name in row)}")
            continue
        shown = f"{value:.6g}" if isinstance(value, float) else value
        click.echo(f"{key}: {shown}")
