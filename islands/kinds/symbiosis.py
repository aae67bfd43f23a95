"""What the species that evolve by each other share: walls, the space between them, routes through it.

Each is cells that an L-system grows, in one space with its partners' (Coates, Broughton and Jackson 1999, as Senatore
2009 has it, 'coevolutionary approach to architecture').
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final, final

import numpy as np
from pydantic import Field

from evaluators.symbiosis import LOGGED, ROLES, Role, Symbiosis, SymbiosisSettings, resolve, score
from genome.errors import InputError
from genome.files import write_whole
from genome.lsystem import LSystem, LSystemGenome, encode, format_blocks
from growth.blocks import CellGrowth, grow_cells
from growth.blocks.cohabitants import Cohabitants, body_of, write_cohabitants
from growth.blocks.lattice import Ints
from growth.blocks.site import OutlineSettings, Site, site_of
from growth.environment import Environment
from growth.environment.boundaries.mesh import PlacedSettings
from growth.protocol import Clock, Failure
from islands.individual import Evaluation
from islands.kinds.blocks import GRACE, USUAL, check_formats
from islands.kinds.bodies import outside_of
from islands.kinds.cells import cells_text, read_cells_text
from islands.kinds.environments import GivenEnvironment, environment_around, environment_of
from islands.kinds.lsystems import LSystemBiology
from islands.kinds.measures import Criteria, Scoring
from islands.kinds.meshes import mesh_text
from islands.kinds.protocol import Facts
from islands.migration.channel import ChannelKind, Migrant
from islands.spec import IslandSpec

if TYPE_CHECKING:
    from PIL.Image import Image

REMEMBERED: Final = 256
"""Partners whose cells are kept as they were read."""

SYMBIOSIS: Final = Criteria(tuple(LOGGED), resolve, score)
"""How species that share a space are measured."""


class SiteSettings(OutlineSettings):
    """Where the cells of an island may be placed.

    ``environment`` is a file's name, relative to the experiment, or the environment itself: its hard boundaries take
    the cells whose centre lies in them; soft ones and forces are for surfaces, and do nothing here.
    """

    environment: GivenEnvironment = None


class SpeciesGrowth(CellGrowth, SymbiosisSettings):
    """Settings of growth on an island of cells, and of how they are measured with their partners'.

    Attributes
    ----------
    least
        The fewest cells of a valid individual; with fewer it is ``small``.
    site
        Where cells may be placed.
    surroundings
        How each form that channels of surroundings bring, a closed mesh, stands in it: it takes or leaves cells as a
        boundary of the site's environment does.
    """

    least: Annotated[int, Field(ge=1)] = 1
    site: SiteSettings = SiteSettings()
    surroundings: PlacedSettings = PlacedSettings()


@final
class SymbiosisBiology(LSystemBiology):
    """Breeds and scores one of the species; see :class:`islands.kinds.protocol.Biology`.

    Parameters
    ----------
    role
        Which one.
    spec
        The island.
    growth
        Its settings of growth.
    clock
        For the ``*_ms`` columns and the safety net behind the growth's budget.
    environment
        Of the site, among what surrounds it; without it what the settings say.
    """

    def __init__(
        self, role: Role, spec: IslandSpec, growth: SpeciesGrowth, clock: Clock, environment: Environment | None = None
    ) -> None:
        super().__init__(LSystemGenome.model_validate(dict(spec.genome)))
        self._role: Final = role
        self._spec: Final = spec
        self._growth: Final = growth
        self._clock: Final = clock
        self._site: Final = _site(spec, growth, environment)
        self._scoring: Final = Scoring(spec.fitness, SYMBIOSIS, (), spec.where, clock)
        settings = growth.model_dump(mode="json", exclude={"site": {"environment"}, "surroundings": True})
        self.scoring: Final = self._scoring.key(role, {**settings, "environment": self._site.environment.digest})
        self.seconds: Final = growth.max_seconds + GRACE
        self._read: Final = lru_cache(maxsize=REMEMBERED)(self._read_partner)

    def surrounded(self, forms: tuple[Migrant, ...]) -> SymbiosisBiology:
        """Give the biology in the site among these forms."""
        around = environment_around(_environment(self._spec, self._growth), forms, self._growth.surroundings)
        return SymbiosisBiology(self._role, self._spec, self._growth, self._clock, around)

    def evaluate(self, genotype: LSystem) -> Evaluation:
        """Grow cells and score them alone: whatever takes a partner is 0."""
        return self._scored(genotype, ())

    def evaluate_with(self, genotype: LSystem, partners: tuple[Migrant, ...]) -> Evaluation:
        """Grow cells and score them together with their partners'; several partners of one species are one."""
        return self._scored(genotype, partners)

    def offer(self, genotype: LSystem, kind: ChannelKind) -> str:
        """Give the cells to partners, the outer skin to surroundings, the L-system to others.

        What the cells enclose lies within the outer skin.

        Raises
        ------
        InputError
            For a genotype that grows to nothing.
        """
        if kind not in ("partners", "surroundings"):
            return encode(genotype)
        cells = self.grown(genotype)
        if isinstance(cells, Failure):
            raise InputError("offer", "a genotype that grows to cells", str(cells))
        if kind == "partners":
            return cells_text(self._role, self._growth.cells, cells)
        around = self._seen(self._together(cells, ())).surroundings
        within = np.flatnonzero(around.walls | around.dry)
        whole = np.stack(np.unravel_index(within, around.grid.shape), axis=1) + around.grid.low
        return mesh_text(*outside_of(body_of(whole, self._growth.cells)))

    def picture(self, genotype: LSystem, partners: tuple[Migrant, ...], size: tuple[int, int]) -> Image | None:
        """Draw an individual among its partners, walls cut open; see :class:`islands.kinds.protocol.Pictured`."""
        from growth.blocks.cutaway import cutaway

        cells = self.grown(genotype)
        return None if isinstance(cells, Failure) else cutaway(self._company(cells, partners), size)

    def _company(self, cells: Ints, partners: tuple[Migrant, ...]) -> Cohabitants:
        together = self._together(cells, partners)
        return Cohabitants(self._growth.cells, *(together[role] for role in ROLES))

    def write_forms(self, genotype: LSystem, stem: Path, formats: Sequence[str], facts: Facts) -> list[Path]:
        """Write an individual's own cells as mesh (glb, obj, stl), grid (npz), picture (png), L-system (blocks)."""
        return self.write_forms_with(genotype, (), stem, formats, facts)

    def write_forms_with(
        self, genotype: LSystem, partners: tuple[Migrant, ...], stem: Path, formats: Sequence[str], facts: Facts
    ) -> list[Path]:
        """Write an individual together with its partners; see :class:`islands.kinds.protocol.Accompanied`."""
        check_formats(formats)
        cells = self.grown(genotype)
        if isinstance(cells, Failure):
            return []
        company = self._company(cells, partners)
        files = []
        for suffix in formats or USUAL:
            path = stem.with_name(f"{stem.name}.{suffix}")
            _write(genotype, company, path, facts)
            files.append(path)
        return files

    def grown(self, genotype: LSystem) -> Ints | Failure:
        """Grow cells in the site: ``small`` where they are too few."""
        cells = grow_cells(genotype, self._growth, self._clock, free=self._site.holds)
        if not isinstance(cells, Failure) and len(cells) < self._growth.least:
            return Failure("small", f"{len(cells)} of the {self._growth.least} cells that it has at least")
        return cells

    def _scored(self, genotype: LSystem, partners: tuple[Migrant, ...]) -> Evaluation:
        started = self._clock()
        cells = self.grown(genotype)
        if isinstance(cells, Failure):
            return self._scoring.failed(cells, started)
        grown = self._clock()
        together = self._together(cells, partners)
        return self._scoring.of(self._seen(together), {}, started, grown)

    def _seen(self, together: Mapping[Role, Ints]) -> Symbiosis:
        lattice, growth = self._growth.cells, self._growth
        return Symbiosis(lattice, together["enclosure"], together["space"], together["route"], growth)

    def _together(self, cells: Ints, partners: tuple[Migrant, ...]) -> Mapping[Role, Ints]:
        """Give the cells of every species, (n, 3): one's own, and all partners' of one species joined."""
        others: dict[Role, list[Ints]] = {role: [] for role in ROLES}
        for one in partners:
            role, found = self._read(one.text)
            others[role].append(found)
        return {role: cells if role == self._role else _joined(found) for role, found in others.items()}

    def _read_partner(self, text: str) -> tuple[Role, Ints]:
        role, cells = read_cells_text(text, self._growth.cells)
        if role == self._role:
            raise InputError("partner", f"one of another species than '{role}'", f"'{role}'")
        return role, cells


def _environment(spec: IslandSpec, growth: SpeciesGrowth) -> Environment:
    return environment_of(spec, growth.site.environment, "growth", "site", "environment")


def _site(spec: IslandSpec, growth: SpeciesGrowth, environment: Environment | None) -> Site:
    """Make an island's site.

    Raises
    ------
    InputError
        When it has no cell, or by itself does not hold the cell in which growth begins.
    """
    if growth.least > growth.max_blocks:
        got = f"{growth.least}, more than the {growth.max_blocks} of max_blocks"
        raise InputError(spec.where("growth", "least"), "a number of cells that max_blocks allows", got)
    level = growth.start[2]
    site = site_of(growth.site, level, _environment(spec, growth) if environment is None else environment)
    if environment is not None:
        return site
    room = site.capacity(growth.cells)
    if room == 0:
        where = spec.where("growth", "site", "outline")
        raise InputError(where, "an outline that holds a cell", "one that holds none", "one cell is one unit wide")
    if room is not None and room < growth.least:
        where = spec.where("growth", "site")
        remedy = "enlarge the outline, add floors, or lower least"
        raise InputError(
            where, f"a site that holds the {growth.least} cells of 'least'", f"one of {room} cells", remedy
        )
    if not site.holds(np.array([growth.start], dtype=np.int64)).all():
        got = f"{list(growth.start)}, where none may be placed"
        raise InputError(spec.where("growth", "start"), "a cell of the site", got, "growth begins there: move either")
    return site


def _joined(found: Sequence[Ints]) -> Ints:
    """Join the cells of several partners, each cell once, in order."""
    if not found:
        return np.empty((0, 3), dtype=np.int64)
    if len(found) == 1:
        return found[0]
    cells = np.concatenate(found)
    _, places = np.unique(cells, axis=0, return_index=True)
    return np.ascontiguousarray(cells[np.sort(places)])


def _write(genotype: LSystem, company: Cohabitants, path: Path, facts: Facts) -> None:
    if path.suffix == ".blocks":
        write_whole(path, format_blocks(genotype).encode())
    elif path.suffix == ".png":
        from growth.blocks.cutaway import cutaway
        from growth.pictures import write_png

        write_png(cutaway(company), path)
    else:
        write_cohabitants(company, path, path.stem, facts)
