"""The island kind of HEMLS surfaces: genomes that a grammar maps to rules, grown and scored (Hemberg 2006)."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Final, final

import numpy as np

from evaluators.fitness import Goal, total
from evaluators.registry import CRITERIA, resolve
from evaluators.score import score
from genome.errors import InputError
from genome.files import write_whole
from genome.genr8 import Genr8Genome, Mapped
from genome.integers import Genes, decode, encode, random_genes
from genome.settings import Settings
from genome.variation import crossover, mutate
from growth.environment import Environment
from growth.environment.boundaries.mesh import PlacedSettings
from growth.hemls import SurfaceGrowth, grow, parse_system
from growth.protocol import Clock, Failure
from growth.surface import Surface
from islands.diversity import hamming_diversity
from islands.individual import Evaluation
from islands.kinds.environments import GivenEnvironment, environment_around, environment_of, kept_environment
from islands.kinds.meshes import MESH
from islands.kinds.protocol import Facts, Keep
from islands.migration.channel import ChannelKind, Migrant
from islands.spec import IslandSpec

if TYPE_CHECKING:
    from PIL.Image import Image

MESHES: Final = ("glb", "obj", "ply", "stl")
FORMATS: Final = (*MESHES, "png", "hemls")
USUAL: Final = ("glb", "hemls")
REMEMBERED: Final = 4096


class SurfaceIslandGrowth(SurfaceGrowth):
    """Settings of growth on an island: those of the engine, and where the surfaces grow.

    Attributes
    ----------
    environment
        A file's name, relative to the experiment, or the environment itself; empty space without.
    surroundings
        How each form that channels of surroundings bring stands in it.
    """

    environment: GivenEnvironment = None
    surroundings: PlacedSettings = PlacedSettings()


@final
class SurfaceBiology:
    """Breeds and scores surfaces; see :class:`islands.kinds.protocol.Biology`.

    Parameters
    ----------
    spec
        The island's settings.
    clock
        For the ``*_ms`` columns and the safety net behind the growth's budget.
    environment
        Where they grow; without it what the settings say.
    """

    def __init__(self, spec: IslandSpec, clock: Clock, environment: Environment | None = None) -> None:
        self._spec: Final = spec
        self._genome: Final = Genr8Genome.model_validate(dict(spec.genome))
        self._growth: Final = SurfaceIslandGrowth.model_validate(dict(spec.growth))
        self._clock: Final = clock
        self._mapper: Final = _located(spec, "genome", "grammar", lambda: self._genome.mapper(Path(spec.base)))
        self._environment: Final = _grown_in(spec) if environment is None else environment
        self._goals: Final = {name: Goal.model_validate(dict(goal)) for name, goal in spec.fitness.items()}
        names = dict.fromkeys([*CRITERIA, *self._goals])
        self._criteria: Final = {name: resolve(name, spec.where("fitness", name)) for name in names}
        self._reads: Final = lru_cache(maxsize=REMEMBERED)(self._genes_read)
        self.scoring: Final = self._scoring_key()
        self.seconds: Final = self._growth.max_seconds

    def random(self, rng: np.random.Generator) -> Genes:
        """Draw a genome."""
        return random_genes(rng, self._genome.length, self._genome.gene_ceiling)

    def crossover(self, first: Genes, second: Genes, rng: np.random.Generator) -> tuple[Genes, Genes]:
        """Cross two genomes at a gene that both mappings read."""
        read = [count for count in (self._reads(first), self._reads(second)) if count is not None]
        return crossover(first, second, rng, self._genome.crossover, within=min(read, default=None))

    def mutate(self, genotype: Genes, rng: np.random.Generator) -> Genes:
        """Mutate a genome; one gene at least that the mapping read comes out different."""
        rate, ceiling = self._genome.gene_mutation, self._genome.gene_ceiling
        return mutate(genotype, rng, rate, ceiling, within=self._reads(genotype))

    def encode(self, genotype: Genes) -> str:
        """Write a genome as a JSON list."""
        return encode(genotype)

    def decode(self, text: str) -> Genes:
        """Read a genome."""
        return decode(text)

    def diversity(self, genotypes: Sequence[Genes]) -> float | None:
        """Give the mean pairwise Hamming distance."""
        return hamming_diversity(genotypes)

    def surrounded(self, forms: tuple[Migrant, ...]) -> SurfaceBiology:
        """Give the biology among these forms, closed meshes that growth may not pass (or as the settings say)."""
        environment = environment_around(_grown_in(self._spec), forms, self._growth.surroundings)
        return SurfaceBiology(self._spec, self._clock, environment)

    def evaluate(self, genotype: Genes) -> Evaluation:
        """Map, grow and score a genome by all of Genr8's criteria, goals or not."""
        started = self._clock()
        text, repaired, surface = self._grown(genotype)
        del text
        grown = self._clock()
        notes: list[tuple[str, dict[str, object]]] = []
        if repaired:
            notes.append(("repair", {"labels": list(repaired)}))
        if isinstance(surface, Failure):
            if surface.reason == "clock":
                notes.append(("clock", {"detail": surface.detail}))
            return Evaluation(None, (), str(surface), (grown - started) * 1e3, 0.0, tuple(notes))
        scores = score(surface, self._environment, self._criteria)
        growth_ms, evaluation_ms = (grown - started) * 1e3, (self._clock() - grown) * 1e3
        if isinstance(scores, Failure):
            return Evaluation(None, (), str(scores), growth_ms, evaluation_ms, tuple(notes))
        fitness = total(scores, self._goals)
        return Evaluation(fitness, tuple(sorted(scores.items())), "", growth_ms, evaluation_ms, tuple(notes))

    def write_forms(self, genotype: Genes, stem: Path, formats: Sequence[str], facts: Facts) -> list[Path]:
        """Write a form as mesh (glb, obj, ply, stl), picture (png), and rules (hemls)."""
        for suffix in formats:
            if suffix not in FORMATS:
                raise InputError("--format", f"one of {', '.join(FORMATS)}", f"'{suffix}'")
        text, _, surface = self._grown(genotype)
        if text is None or isinstance(surface, Failure):
            return []
        files = []
        for suffix in formats or USUAL:
            path = stem.with_name(f"{stem.name}.{suffix}")
            self._write(text, surface, path, suffix, facts)
            files.append(path)
        return files

    def picture(self, genotype: Genes, partners: tuple[Migrant, ...], size: tuple[int, int]) -> Image | None:
        """Draw a surface in its environment; see :class:`islands.kinds.protocol.Pictured`."""
        from growth.pictures import render

        del partners  # surfaces have none
        surface = self._grown(genotype)[2]
        return None if isinstance(surface, Failure) else render(surface, self._environment, size)

    def _write(self, text: str, surface: Surface, path: Path, suffix: str, facts: Facts) -> None:
        if suffix == "hemls":
            write_whole(path, text.encode())
        elif suffix == "png":
            from growth.pictures import render, write_png

            write_png(render(surface, self._environment), path)
        else:
            from growth.forms import write_form

            write_form(surface, path, title=path.stem, extras=facts)

    def _grown(self, genotype: Genes) -> tuple[str | None, tuple[int, ...], Surface | Failure]:
        """Give the rules, the labels whose rules were repaired, and the surface or why there is none."""
        mapped = self._mapper.map(genotype)
        if not isinstance(mapped, Mapped):
            return None, (), Failure("mapping", mapped.reason)
        try:
            system = parse_system(mapped.text, "genotype")
        except InputError as error:
            return mapped.text, mapped.repaired, Failure("rules", str(error))
        surface = grow(system, self._growth, self._environment, self._clock)
        return mapped.text, mapped.repaired, surface

    def _genes_read(self, genotype: Genes) -> int | None:
        mapped = self._mapper.map(genotype)
        return mapped.genes_read if isinstance(mapped, Mapped) else None

    def _scoring_key(self) -> str:
        """Hash all that a fitness depends on besides the genotype."""
        growth = self._growth.model_dump(mode="json", exclude={"environment", "surroundings"})
        goals = {name: goal.model_dump(mode="json") for name, goal in sorted(self._goals.items())}
        # The grammar maps the genotype, so it is a part of how an island scores, though one species has one.
        mapping = self._genome.model_dump(mode="json", exclude={"length", "crossover", "gene_mutation"})
        meaning = [growth, self._environment.digest, goals, sorted(self._criteria), mapping]
        return hashlib.sha256(json.dumps(meaning, sort_keys=True, allow_nan=False).encode()).hexdigest()


def _grown_in(spec: IslandSpec) -> Environment:
    """Make the environment that the island's settings name or hold."""
    return environment_of(spec, spec.growth.get("environment"), "growth", "environment")


@final
class SurfaceKind:
    """The kind ``surface``."""

    name: ClassVar[str] = "surface"
    genome: ClassVar[type[Settings]] = Genr8Genome
    growth: ClassVar[type[Settings]] = SurfaceIslandGrowth
    variation: ClassVar[frozenset[str]] = frozenset({"crossover", "gene_mutation"})
    takes: ClassVar[Mapping[ChannelKind, tuple[str, ...]]] = {"surroundings": (MESH,)}

    def compile_kernels(self) -> None:
        """Compile the mapping's, the environment's and the growth's."""
        from growth.warm import compile_surfaces

        compile_surfaces()

    def build(self, spec: IslandSpec, clock: Clock) -> SurfaceBiology:
        """Load the grammar, the environment and the criteria."""
        return SurfaceBiology(spec, clock)

    def keep_files(self, spec: IslandSpec, keep: Keep) -> tuple[Mapping[str, Any], Mapping[str, Any]]:
        """Keep the grammar's file, the environment's, and the meshes that it names."""
        genome, growth = dict(spec.genome), dict(spec.growth)
        grammar = str(genome["grammar"])
        if "/" in grammar or grammar.endswith(".bnf"):
            path = Path(spec.base) / grammar
            genome["grammar"] = keep("grammars", path.name, path.read_bytes())
        if growth.get("environment") is not None:
            growth["environment"] = kept_environment(spec, growth["environment"], keep, "growth", "environment")
        return genome, growth


def _located(spec: IslandSpec, section: str, key: str, make: Any) -> Any:  # noqa: ANN401 - whatever is made
    """Make something, and name the experiment's key in an error that names none."""
    try:
        return make()
    except InputError as error:
        if error.where != key:
            raise
        raise InputError(spec.where(section, key), error.expected, error.got, error.remedy) from None
