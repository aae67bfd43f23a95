"""The kind of structural pairs: two L-systems grow in two places of one space and are scored as one body.

One individual, two genotypes, one id (Senatore 2009, 'structural co-evolution', Figures 22 to 26).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Final, final

import numpy as np
from pydantic import BeforeValidator

from genome.errors import InputError
from genome.lsystem import LSystemGenome
from genome.settings import Settings, describe
from growth.blocks import BlockGrowth
from growth.blocks.body import Body
from growth.protocol import Clock, Failure
from islands.individual import Evaluation
from islands.kinds.blocks import GRACE, USUAL, BlockIslandGrowth, BlocksBiology, check_formats, write_body
from islands.kinds.bodies import BODIES, BlockLoad, Cell, Cells, check_start, outside_of, structure_of
from islands.kinds.composite import CompositeBiology, Parts
from islands.kinds.measures import Scoring
from islands.kinds.meshes import MESH, mesh_text
from islands.kinds.pairs import PAIR, paired
from islands.kinds.protocol import Facts, Keep
from islands.migration.channel import ChannelKind, Migrant
from islands.spec import IslandSpec

if TYPE_CHECKING:
    from PIL.Image import Image


class PairGenome(Settings):
    """How the two L-systems of a pair are drawn and varied, each for itself."""

    first: LSystemGenome = LSystemGenome()
    second: LSystemGenome = LSystemGenome()


def _as_starts(value: object) -> object:
    if isinstance(value, (list, tuple)) and len(value) == 2:
        return tuple(value)
    raise InputError("", "two cells: [[0, 0, 0], [6, 0, 0]]", describe(value))


class PairGrowth(BlockGrowth):
    """Settings of growth of a pair: those of the engine, the load on the whole, and where each part starts.

    A cell that both parts reach is one block of the whole; blocks of the two that touch are joined as any others.
    """

    load: BlockLoad = BlockLoad()
    starts: Annotated[tuple[Cell, Cell], BeforeValidator(_as_starts)] = ((0, 0, 0), (6, 0, 0))


@final
class PairBiology:
    """Breeds and scores pairs; see :class:`islands.kinds.protocol.Biology`."""

    def __init__(self, spec: IslandSpec, clock: Clock) -> None:
        genome = PairGenome.model_validate(dict(spec.genome))
        self._growth: Final = PairGrowth.model_validate(dict(spec.growth))
        self._clock: Final = clock
        for start in self._growth.starts:
            check_start(start, self._growth, spec.where("growth", "starts"))
        alone = self._growth.model_dump(exclude={"starts"})
        self._parts: Final = tuple(
            BlocksBiology(part, BlockIslandGrowth.model_validate({**alone, "start": start}), {}, spec.where, clock)
            for part, start in zip((genome.first, genome.second), self._growth.starts, strict=True)
        )
        self._scoring: Final = Scoring(spec.fitness, BODIES, PAIR, spec.where, clock)
        self.scoring: Final = self._scoring.key("block_pair", self._growth.model_dump(mode="json"))
        self.seconds: Final = 2 * self._growth.max_seconds + GRACE
        self._whole: Final = CompositeBiology(self._parts, self._scored, self.scoring, self.seconds)

    def random(self, rng: np.random.Generator) -> Parts:
        """Draw both L-systems."""
        return self._whole.random(rng)

    def crossover(self, first: Parts, second: Parts, rng: np.random.Generator) -> tuple[Parts, Parts]:
        """Cross first with first and second with second."""
        return self._whole.crossover(first, second, rng)

    def mutate(self, genotype: Parts, rng: np.random.Generator) -> Parts:
        """Mutate either, or both."""
        return self._whole.mutate(genotype, rng)

    def encode(self, genotype: Parts) -> str:
        """Write both encodings."""
        return self._whole.encode(genotype)

    def decode(self, text: str) -> Parts:
        """Read both."""
        return self._whole.decode(text)

    def diversity(self, genotypes: Sequence[Parts]) -> float | None:
        """Give the mean of both parts' diversities."""
        return self._whole.diversity(genotypes)

    def evaluate(self, genotype: Parts) -> Evaluation:
        """Score both as one body."""
        return self._whole.evaluate(genotype)

    def offer(self, genotype: Parts, kind: ChannelKind) -> str:
        """Give the outer faces of the whole to surroundings, both L-systems to others."""
        if kind != "surroundings":
            return self.encode(genotype)
        skeletons = self._grown(genotype)
        if isinstance(skeletons, Failure):
            raise InputError("offer", "a pair that grows to a body", str(skeletons))
        return mesh_text(*outside_of(self._joined(skeletons)[0]))

    def write_forms(self, genotype: Parts, stem: Path, formats: Sequence[str], facts: Facts) -> list[Path]:
        """Write the whole, and each part's L-system under its number."""
        check_formats(formats)
        skeletons = self._grown(genotype)
        if isinstance(skeletons, Failure):
            return []
        body, files = self._joined(skeletons)[0], []
        for suffix in formats or USUAL:
            path = stem.with_name(f"{stem.name}.{suffix}")
            if suffix == "blocks":
                files += self._whole.write_forms(genotype, stem, ("blocks",), facts)
                continue
            if suffix == "png":
                from growth.pictures import write_png

                write_png(_drawn(body, skeletons[0]), path)
            else:
                write_body(body, self._growth, self._growth.load, path, facts)
            files.append(path)
        return files

    def picture(self, genotype: Parts, partners: tuple[Migrant, ...], size: tuple[int, int]) -> Image | None:
        """Draw a pair, each part in a colour of its own; see :class:`islands.kinds.protocol.Pictured`."""
        del partners  # both parts are in the genotype
        skeletons = self._grown(genotype)
        return None if isinstance(skeletons, Failure) else _drawn(self._joined(skeletons)[0], skeletons[0], size)

    def _scored(self, genotype: Parts) -> Evaluation:
        started = self._clock()
        skeletons = self._grown(genotype)
        if isinstance(skeletons, Failure):
            return self._scoring.failed(skeletons, started)
        body, pair = self._joined(skeletons)
        grown = self._clock()
        return self._scoring.of(structure_of(body, self._growth, self._growth.load), pair, started, grown)

    def _grown(self, genotype: Parts) -> tuple[Cells, Cells] | Failure:
        """Grow both skeletons."""
        found = []
        for number, (part, one) in enumerate(zip(self._parts, genotype, strict=True), start=1):
            body = part.grown(one)
            if isinstance(body, Failure):
                return Failure(body.reason, f"part {number}: {body.detail}")
            found.append(body.internal)
        return found[0], found[1]

    def _joined(self, skeletons: tuple[Cells, Cells]) -> tuple[Body, dict[str, float]]:
        return paired(*skeletons, self._growth, self._growth.load)


def _drawn(body: Body, first: Cells, size: tuple[int, int] = (1000, 750)) -> Image:
    """Draw a pair, each part in a colour of its own; cells that both share are drawn as the first's."""
    from growth.blocks.skin import body_surface
    from growth.pictures import render

    internal, boundary = body.internal, body.boundary
    _, here = np.unique(np.concatenate([first, internal]), axis=0, return_inverse=True)
    own = np.isin(here[len(first) :], here[: len(first)])
    parts = [internal[own], internal[~own], boundary]
    shown = [Body(body.lattice, cells, np.zeros(len(cells), dtype=np.uint8)) for cells in parts if len(cells)]
    return render([body_surface(one) for one in shown], size=size, elevation=18.0)


@final
class BlockPairKind:
    """The kind ``block_pair``."""

    name: ClassVar[str] = "block_pair"
    genome: ClassVar[type[Settings]] = PairGenome
    growth: ClassVar[type[Settings]] = PairGrowth
    gives: ClassVar[Mapping[ChannelKind, str]] = {"surroundings": MESH}

    def compile_kernels(self) -> None:
        """Compile the growth's, the loads' and the criteria's."""
        from evaluators.blocks.warm import compile_kernels as compile_loads
        from growth.blocks.warm import compile_kernels as compile_growth

        compile_growth()
        compile_loads()

    def build(self, spec: IslandSpec, clock: Clock) -> PairBiology:
        """Find the criteria."""
        return PairBiology(spec, clock)

    def keep_files(self, spec: IslandSpec, keep: Keep) -> tuple[Mapping[str, Any], Mapping[str, Any]]:
        """Keep none: the settings name no files."""
        del keep
        return spec.genome, spec.growth
