"""The island kind of timed forms: timed L-systems that unfold, judged by form, development and motion (McCormack)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar, Final, final

import numpy as np
from numpy.typing import NDArray

from evaluators.timed import TIMED_CRITERIA, TimedForm, Unfolding, resolve, score, unfold
from genome.errors import InputError
from genome.files import write_whole
from genome.settings import Settings
from genome.timed import format_tl
from genome.timed.genotype import TimedGenotype, decode_genotype, encode_genotype
from genome.timed.variation import TimedGenome, distances, diversity, load_breeder, system_text
from growth.protocol import Clock, Failure
from growth.timed.drawing import Drawing
from islands.individual import Evaluation
from islands.kinds.measures import Criteria, Scoring
from islands.kinds.meshes import MESH, mesh_text
from islands.kinds.protocol import Facts, Keep
from islands.migration.channel import ChannelKind
from islands.spec import IslandSpec

COSTLY: Final = ("smoothness", "surface", "symmetry")
"""Criteria that take longer than all others together, and are measured where they have a goal."""

UNFOLDINGS: Final = Criteria(tuple(name for name in TIMED_CRITERIA if name not in COSTLY), resolve, score)
"""How unfolding forms are measured."""

FORMATS: Final = ("glb", "obj", "ply", "stl", "png", "gif", "tl")
USUAL: Final = ("glb", "tl")
GRACE: Final = 30.0
"""Seconds that the drawing and the criteria may take beside the growth."""


@final
class TimedBiology:
    """Breeds and scores timed forms; see :class:`islands.kinds.protocol.Biology`.

    Parameters
    ----------
    spec
        The island's settings.
    clock
        For the ``*_ms`` columns and the safety net behind the growth's budget.
    """

    def __init__(self, spec: IslandSpec, clock: Clock) -> None:
        genome = TimedGenome.model_validate(dict(spec.genome))
        self._growth: Final = TimedForm.model_validate(dict(spec.growth))
        self._clock: Final = clock
        self._breeder: Final = load_breeder(genome, Path(spec.base), spec.where)
        self._scoring: Final = Scoring(spec.fitness, UNFOLDINGS, (), spec.where, clock)
        self.scoring: Final = self._scoring.key("timed", self._growth.model_dump(mode="json"))
        self.seconds: Final = self._growth.max_seconds + GRACE

    def random(self, rng: np.random.Generator) -> TimedGenotype:
        """Draw numbers, and write some successors anew."""
        return self._breeder.random(rng)

    def crossover(
        self, first: TimedGenotype, second: TimedGenotype, rng: np.random.Generator
    ) -> tuple[TimedGenotype, TimedGenotype]:
        """Exchange productions and defines, or parts of words."""
        return self._breeder.crossover(first, second, rng)

    def mutate(self, genotype: TimedGenotype, rng: np.random.Generator) -> TimedGenotype:
        """Change a production, or numbers, or both."""
        return self._breeder.mutate(genotype, rng)

    def encode(self, genotype: TimedGenotype) -> str:
        """Write a system and its seed as JSON."""
        return encode_genotype(genotype)

    def decode(self, text: str) -> TimedGenotype:
        """Read a system and its seed."""
        return decode_genotype(text)

    def diversity(self, genotypes: Sequence[TimedGenotype]) -> float | None:
        """Give the mean share of productions and numbers that two of them do not have in common."""
        return diversity(genotypes)

    def distances(self, genotypes: Sequence[TimedGenotype]) -> NDArray[np.float64]:
        """Give that share for each two."""
        return distances(genotypes)

    def evaluate(self, genotype: TimedGenotype) -> Evaluation:
        """Unfold a form over the island's span of time, and score it."""
        started = self._clock()
        found = self._unfolded(genotype)
        if isinstance(found, Failure):
            return self._scoring.failed(found, started)
        return self._scoring.of(found, {}, started, self._clock())

    def offer(self, genotype: TimedGenotype, kind: ChannelKind) -> str:
        """Give the closed parts of the form to surroundings, the genotype to other channels.

        Raises
        ------
        InputError
            For a genotype that grows to no closed part.
        """
        if kind != "surroundings":
            return encode_genotype(genotype)
        found = self._unfolded(genotype)
        if isinstance(found, Failure):
            raise InputError("offer", "a genotype that grows to a form", str(found))
        vertices, triangles = closed_parts(found.form)
        if not len(triangles):
            raise InputError("offer", "a form with a closed part", "none")
        return mesh_text(vertices, triangles)

    def write_forms(self, genotype: TimedGenotype, stem: Path, formats: Sequence[str], facts: Facts) -> list[Path]:
        """Write the form as it unfolds (glb, gif), or at the time at which it is judged; the system as tl.

        Meshes of that time are obj, ply and stl, its picture is png.
        """
        for suffix in formats:
            if suffix not in FORMATS:
                raise InputError("--format", f"one of {', '.join(FORMATS)}", f"'{suffix}'")
        found = self._unfolded(genotype)
        if isinstance(found, Failure):
            return []
        files = []
        for suffix in formats or USUAL:
            path = stem.with_name(f"{stem.name}.{suffix}")
            _write(genotype, found, path, facts)
            files.append(path)
        return files

    def _unfolded(self, genotype: TimedGenotype) -> Unfolding | Failure:
        return unfold(genotype.system, self._growth, genotype.seed, self._clock)


def closed_parts(drawing: Drawing) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Give the parts of a drawing that bound volumes, as one mesh.

    Returns
    -------
    tuple
        Vertices (v, 3) float64 and triangles (t, 3) int32; none where no part does.
    """
    corners, triangles = [np.empty((0, 3))], [np.empty((0, 3), dtype=np.int32)]
    count = 0
    for part, which in enumerate(drawing.which.tolist()):
        shape = drawing.shapes[which]
        if shape.closed and np.linalg.det(drawing.frames[part, :3, :3]) > 0.0:
            corners.append(drawing.corners(part))
            triangles.append((shape.triangles + count).astype(np.int32))
            count += len(corners[-1])
    return np.concatenate(corners), np.concatenate(triangles)


def _write(genotype: TimedGenotype, unfolding: Unfolding, path: Path, facts: Facts) -> None:
    if path.suffix == ".tl":
        write_whole(path, format_tl(genotype.system).encode())
    elif path.suffix == ".glb":
        from growth.timed.animation import animated_glb

        write_whole(path, animated_glb(unfolding.drawings, {"title": path.stem, **facts}))
    else:
        from growth.timed.animation import write_drawings

        drawings = unfolding.drawings if path.suffix == ".gif" else (unfolding.form,)
        write_drawings(drawings, path, path.stem)


@final
class TimedKind:
    """The kind ``timed``."""

    name: ClassVar[str] = "timed"
    genome: ClassVar[type[Settings]] = TimedGenome
    growth: ClassVar[type[Settings]] = TimedForm
    variation: ClassVar[frozenset[str]] = frozenset(
        {"rewritten", "production_mutation", "number_mutation", "number_step", "reseed", "mutations", "crossover",
         "genes", "grammar_depth"}
    )  # fmt: skip
    gives: ClassVar[Mapping[ChannelKind, str]] = {"surroundings": MESH}

    def compile_kernels(self) -> None:
        """Compile the mapping's and the growth's."""
        from genome.genr8 import compile_kernels as compile_mapping
        from growth.timed.warm import compile_kernels as compile_growth

        compile_mapping()
        compile_growth()

    def build(self, spec: IslandSpec, clock: Clock) -> TimedBiology:
        """Read the system and the grammar, and find the criteria."""
        return TimedBiology(spec, clock)

    def keep_files(self, spec: IslandSpec, keep: Keep) -> tuple[Mapping[str, Any], Mapping[str, Any]]:
        """Keep the system's file, and the grammar's; a system's own grammar is kept, too, as one that is named."""
        base = Path(spec.base)
        name, text = system_text(str(spec.genome["system"]), base, spec.where)
        genome = {**spec.genome, "system": keep("systems", name, text.encode())}
        named = spec.genome.get("grammar")
        if named is not None:
            genome["grammar"] = keep("grammars", Path(str(named)).name, (base / str(named)).read_bytes())
            return genome, spec.growth
        own = load_breeder(TimedGenome.model_validate(dict(spec.genome)), base, spec.where).grammar
        if own:
            genome["grammar"] = keep("grammars", f"{Path(name).stem}.bnf", own.encode())
        return genome, spec.growth
