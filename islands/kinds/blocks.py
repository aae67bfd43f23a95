"""The island kind of block bodies: L-systems that grow blocks, scored under their own load (Senatore 2009)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Final, final

import numpy as np

from genome.errors import InputError
from genome.files import write_whole
from genome.lsystem import LSystem, LSystemGenome, encode, format_blocks
from genome.settings import Settings
from growth.blocks import BlockGrowth, grow, stand
from growth.blocks.body import Body
from growth.blocks.lattice import Floats
from growth.protocol import Clock, Failure
from islands.individual import Evaluation
from islands.kinds.bodies import (
    BODIES,
    BlockLoad,
    Cell,
    body_text,
    check_start,
    is_stable,
    moved,
    outside_of,
    read_body_text,
    structure_of,
)
from islands.kinds.lsystems import LSystemBiology
from islands.kinds.measures import Scoring
from islands.kinds.meshes import MESH, mesh_text
from islands.kinds.pairs import PAIR, paired
from islands.kinds.protocol import Facts, Keep
from islands.migration.channel import ChannelKind, Migrant
from islands.spec import IslandSpec

if TYPE_CHECKING:
    from PIL.Image import Image

MESHES: Final = ("glb", "obj", "stl", "npz")
FORMATS: Final = (*MESHES, "png", "blocks")
USUAL: Final = ("glb", "blocks")
GRACE: Final = 30.0
"""Seconds that the analysis of a body may take beside its growth."""


class BlockIslandGrowth(BlockGrowth):
    """Settings of growth on an island: those of the engine, the load on bodies, and where they start.

    ``start`` is the cell in which a body's growth begins: where bodies of several islands grow in one space, as
    partners do, each has its place.
    """

    load: BlockLoad = BlockLoad()
    start: Cell = (0, 0, 0)


@final
class BlocksBiology(LSystemBiology):
    """Breeds and scores block bodies; see :class:`islands.kinds.protocol.Biology`.

    Parameters
    ----------
    genome, growth
        The island's settings.
    goals
        By criterion, as an experiment has them.
    where
        Gives the place of a key of the island, for messages.
    clock
        For the ``*_ms`` columns and the safety net behind the growth's budget.
    """

    def __init__(
        self,
        genome: LSystemGenome,
        growth: BlockIslandGrowth,
        goals: Mapping[str, Mapping[str, Any]],
        where: Callable[..., str],
        clock: Clock,
    ) -> None:
        check_start(growth.start, growth, where("growth", "start"))
        super().__init__(genome)
        self._growth: Final = growth
        self._clock: Final = clock
        self._scoring: Final = Scoring(goals, BODIES, PAIR, where, clock)
        self.scoring: Final = self._scoring.key("blocks", growth.model_dump(mode="json"))
        self.seconds: Final = growth.max_seconds + GRACE

    def evaluate(self, genotype: LSystem) -> Evaluation:
        """Grow, load and score a body: whole and alone, it stands if it is valid, and meets nobody."""
        started = self._clock()
        body = self.grown(genotype)
        if isinstance(body, Failure):
            return self._scoring.failed(body, started)
        grown = self._clock()
        load = self._growth.load
        structure = structure_of(body, self._growth, load)
        stands = float(load.required or is_stable(body, self._growth, load))
        return self._scoring.of(structure, dict(zip(PAIR, (stands, 0.0, 0.0, 0.0), strict=True)), started, grown)

    def evaluate_with(self, genotype: LSystem, partners: tuple[Migrant, ...]) -> Evaluation:
        """Score a body together with its partners' bodies beside it, merged where they meet, as one.

        Of the criteria of pairs the first part is its own body, the second are all partners together.
        """
        started = self._clock()
        body = self.grown(genotype)
        if isinstance(body, Failure):
            return self._scoring.failed(body, started)
        others = np.concatenate([read_body_text(one.text, self._growth.lattice) for one in partners])
        whole, pair = paired(body.internal, others, self._growth, self._growth.load)
        grown = self._clock()
        return self._scoring.of(structure_of(whole, self._growth, self._growth.load), pair, started, grown)

    def offer(self, genotype: LSystem, kind: ChannelKind) -> str:
        """Give the skeleton to partners, the outer faces above ground to surroundings, the L-system to others.

        Raises
        ------
        InputError
            For a genotype that grows to no body.
        """
        if kind not in ("partners", "surroundings"):
            return encode(genotype)
        body = self.grown(genotype)
        if isinstance(body, Failure):
            raise InputError("offer", "a genotype that grows to a body", str(body))
        return body_text(body) if kind == "partners" else mesh_text(*outside_of(body))

    def write_forms(self, genotype: LSystem, stem: Path, formats: Sequence[str], facts: Facts) -> list[Path]:
        """Write a body as mesh (glb, obj, stl), voxel grid (npz), picture (png), and its L-system (blocks)."""
        check_formats(formats)
        body = self.grown(genotype)
        if isinstance(body, Failure):
            return []
        files = []
        for suffix in formats or USUAL:
            path = stem.with_name(f"{stem.name}.{suffix}")
            if suffix == "blocks":
                write_whole(path, format_blocks(genotype).encode())
            else:
                write_body(body, self._growth, self._growth.load, path, facts)
            files.append(path)
        return files

    def picture(self, genotype: LSystem, partners: tuple[Migrant, ...], size: tuple[int, int]) -> Image | None:
        """Draw a body alone, coloured by its joints' forces; see :class:`islands.kinds.protocol.Pictured`."""
        from growth.blocks.pictures import body_picture

        del partners  # each body is shown by itself
        body = self.grown(genotype)
        return (
            None
            if isinstance(body, Failure)
            else body_picture(body, _forces(body, self._growth, self._growth.load), size)
        )

    def grown(self, genotype: LSystem) -> Body | Failure:
        """Grow a body where it starts."""
        body = grow(genotype, self._growth, self._clock)
        if isinstance(body, Failure) or not any(self._growth.start):
            return body
        return stand(moved(body.internal, self._growth.start), self._growth)


def check_formats(formats: Sequence[str]) -> None:
    """Refuse formats that block bodies are not written in.

    Raises
    ------
    InputError
        For the first of them.
    """
    for suffix in formats:
        if suffix not in FORMATS:
            raise InputError("--format", f"one of {', '.join(FORMATS)}", f"'{suffix}'")


def write_body(body: Body, growth: BlockGrowth, load: BlockLoad, path: Path, facts: Facts) -> None:
    """Write a body, coloured by its joints' forces where the format has colours and the body could be loaded."""
    forces = _forces(body, growth, load)
    if path.suffix == ".png":
        from growth.blocks.pictures import body_picture
        from growth.pictures import write_png

        write_png(body_picture(body, forces), path)
        return
    from growth.blocks.forms import write_form

    write_form(body, path, path.stem, facts, forces)


def _forces(body: Body, growth: BlockGrowth, load: BlockLoad) -> Floats | None:
    """Give what each cell's joints carry, (n,) float64; ``None`` where the body could not be loaded."""
    structure = structure_of(body, growth, load)
    return None if isinstance(structure, Failure) else structure.load.by_cell(body)


@final
class BlocksKind:
    """The kind ``blocks``."""

    name: ClassVar[str] = "blocks"
    genome: ClassVar[type[Settings]] = LSystemGenome
    growth: ClassVar[type[Settings]] = BlockIslandGrowth
    variation: ClassVar[frozenset[str]] = frozenset({"crossover", "mutations"})

    def gives(self, spec: IslandSpec) -> Mapping[ChannelKind, str]:
        """Give skeletons to partners on the same lattice, and outer faces to surroundings."""
        return {"partners": f"blocks, {spec.growth['lattice']}", "surroundings": MESH}

    def takes(self, spec: IslandSpec) -> Mapping[ChannelKind, tuple[str, ...]]:
        """Take skeletons on the same lattice as partners."""
        return {"partners": (f"blocks, {spec.growth['lattice']}",)}

    def compile_kernels(self) -> None:
        """Compile the growth's, the loads' and the criteria's."""
        from evaluators.blocks.warm import compile_kernels as compile_loads
        from growth.blocks.warm import compile_kernels as compile_growth

        compile_growth()
        compile_loads()

    def build(self, spec: IslandSpec, clock: Clock) -> BlocksBiology:
        """Find the criteria."""
        genome = LSystemGenome.model_validate(dict(spec.genome))
        growth = BlockIslandGrowth.model_validate(dict(spec.growth))
        return BlocksBiology(genome, growth, spec.fitness, spec.where, clock)

    def keep_files(self, spec: IslandSpec, keep: Keep) -> tuple[Mapping[str, Any], Mapping[str, Any]]:
        """Keep none: the settings name no files."""
        del keep
        return spec.genome, spec.growth
