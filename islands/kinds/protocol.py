"""What an island kind offers: its settings, and the biology that an island breeds by."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Protocol, TypeVar, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from genome.settings import Settings
from growth.protocol import Clock
from islands.individual import Evaluation
from islands.migration.channel import ChannelKind, Migrant
from islands.spec import IslandSpec

if TYPE_CHECKING:
    from PIL.Image import Image

G = TypeVar("G")
G_contra = TypeVar("G_contra", contravariant=True)

Facts = Mapping[str, str | float | bool]

Keep = Callable[[str, str, bytes], str]
"""Keeps a file with the run: takes a folder's name, a file's name and its content, gives the path to write in its
stead, relative to the run's folder."""


@runtime_checkable
class Biology(Protocol[G]):
    """How one island makes, varies, scores and writes down its individuals.

    A genotype is an immutable value. All randomness comes from the generator that is passed.

    Attributes
    ----------
    scoring
        Equal for two islands exactly when they score alike: growth, environment, criteria and goals.
    seconds
        An upper estimate of one evaluation's time, from which deadlines are made.
    """

    @property
    def scoring(self) -> str:
        """See above."""
        ...

    @property
    def seconds(self) -> float:
        """See above."""
        ...

    def random(self, rng: np.random.Generator) -> G:
        """Make a genotype of the first population."""
        ...

    def crossover(self, first: G, second: G, rng: np.random.Generator) -> tuple[G, G]:
        """Make two genotypes from two; the parents stay as they are."""
        ...

    def mutate(self, genotype: G, rng: np.random.Generator) -> G:
        """Make a changed genotype; the parent stays as it is."""
        ...

    def encode(self, genotype: G) -> str:
        """Write a genotype in its language-neutral encoding."""
        ...

    def decode(self, text: str) -> G:
        """Read what :meth:`encode` wrote."""
        ...

    def evaluate(self, genotype: G) -> Evaluation:
        """Grow and score a genotype; failure is a value."""
        ...

    def diversity(self, genotypes: Sequence[G]) -> float | None:
        """Say how different genotypes are, from 0 to 1; ``None`` for fewer than two."""
        ...

    def write_forms(self, genotype: G, stem: Path, formats: Sequence[str], facts: Facts) -> list[Path]:
        """Grow a genotype and write its form.

        Parameters
        ----------
        genotype
            What to grow.
        stem
            The files' path without suffix; its folder exists.
        formats
            Suffixes without the dot; empty for the kind's usual ones.
        facts
            What the form is, written into files of formats that have a place for it.

        Returns
        -------
        The files written; none when the genotype grows to no form.

        Raises
        ------
        InputError
            For a format that the kind does not write, or a form that cannot be written in it.
        """
        ...


@runtime_checkable
class Symbiotic(Protocol[G_contra]):
    """A biology whose individuals are scored together with partners.

    ``evaluate`` scores one alone, as long as no partner has come.
    """

    def evaluate_with(self, genotype: G_contra, partners: tuple[Migrant, ...]) -> Evaluation:
        """Score one pairing: a genotype with one partner from each incoming ``partners`` channel, in their order."""
        ...


@runtime_checkable
class Accompanied(Protocol[G_contra]):
    """A symbiotic biology that writes individuals' forms together with their partners'."""

    def write_forms_with(
        self, genotype: G_contra, partners: tuple[Migrant, ...], stem: Path, formats: Sequence[str], facts: Facts
    ) -> list[Path]:
        """Grow a genotype and write its form among its partners'; as :meth:`Biology.write_forms` otherwise.

        Parameters
        ----------
        genotype, stem, formats, facts
            As of :meth:`Biology.write_forms`.
        partners
            Of one pairing, as of :meth:`Symbiotic.evaluate_with`; none where nobody has come.
        """
        ...


@runtime_checkable
class Pictured(Protocol[G_contra]):
    """A biology whose individuals can be shown."""

    def picture(self, genotype: G_contra, partners: tuple[Migrant, ...], size: tuple[int, int]) -> Image | None:
        """Draw an individual's form.

        Parameters
        ----------
        genotype
            What to grow.
        partners
            Of one pairing, for kinds that are shown among their partners; none where nobody has come.
        size
            Width and height in pixels; what has a shape of its own is drawn within.

        Returns
        -------
        An RGB image; ``None`` when the genotype grows to no form.

        Raises
        ------
        InputError
            When the form cannot be drawn.
        """
        ...


@runtime_checkable
class Assembling(Protocol[G]):
    """A biology whose genotypes are assembled from parts that ``components`` channels bring.

    A genotype carries its parts whole, so that it can be regrown by itself.
    """

    def supplied(self, parts: tuple[Migrant, ...]) -> Biology[G]:
        """Give the biology whose ``random``, ``crossover`` and ``mutate`` may use these parts, and only these anew."""
        ...

    def components(self, genotype: G) -> tuple[int, ...]:
        """Give the ids of the parts that a genotype is assembled from."""
        ...


@runtime_checkable
class Waiting(Protocol):
    """A biology that may lack something to draw genotypes from, as one that assembles parts does.

    Attributes
    ----------
    ready
        Whether it has all that it needs; until then its island waits, without members.
    """

    @property
    def ready(self) -> bool:
        """See above."""
        ...


def is_ready(biology: object) -> bool:
    """Tell whether a biology can draw genotypes; one that never waits can."""
    return biology.ready if isinstance(biology, Waiting) else True


@runtime_checkable
class Apart(Protocol[G_contra]):
    """A biology that gives all distances at once, faster than by the ``diversity`` of each two."""

    def distances(self, genotypes: Sequence[G_contra]) -> NDArray[np.float64]:
        """Give (n, n) float64, what ``diversity`` gives of each two, 0 on the diagonal."""
        ...


@runtime_checkable
class Situated(Protocol[G]):
    """A biology whose environment takes in forms that ``surroundings`` channels bring."""

    def surrounded(self, forms: tuple[Migrant, ...]) -> Biology[G]:
        """Give the biology in the environment that holds these forms; its ``scoring`` tells them apart."""
        ...


@runtime_checkable
class Offering(Protocol[G_contra]):
    """A biology that gives something other than its genotypes' encoding to some channels, such as a form."""

    def offer(self, genotype: G_contra, kind: ChannelKind) -> str:
        """Give what travels on channels of this kind: text that a kind which takes it can read."""
        ...


@runtime_checkable
class Kind(Protocol):
    """An island kind: the models of its settings, and the maker of its biology.

    A kind may have more attributes (see :mod:`islands.kinds.trade`). Some say what channels of other kinds than
    ``migrants`` may join it: ``gives`` and ``takes``, from a channel's kind to names of what travels, ``needs``, the
    channels that it cannot do without, and ``needed``, what has to come on them; each may be a method that gives it for
    an island. ``variation`` names the keys of ``genome`` that may differ within
    a species. A kind that is :class:`Compiled` is asked to compile before its first island is made.

    Attributes
    ----------
    name
        The kind's name, a part of its species' default name.
    genome, growth
        Models of the island's ``genome:`` and ``growth:`` sections.
    """

    name: ClassVar[str]
    genome: ClassVar[type[Settings]]
    growth: ClassVar[type[Settings]]

    def build(self, spec: IslandSpec, clock: Clock) -> Biology[Any]:
        """Make the biology of one island.

        Raises
        ------
        InputError
            When the settings do not hold together: an unknown criterion, a file that is missing or malformed.
        """
        ...

    def keep_files(self, spec: IslandSpec, keep: Keep) -> tuple[Mapping[str, Any], Mapping[str, Any]]:
        """Keep with the run every file that the settings name.

        Returns
        -------
        The genome and growth settings, with the kept files in place of the named ones.
        """
        ...


@runtime_checkable
class Compiled(Protocol):
    """A kind that has kernels to compile."""

    def compile_kernels(self) -> None:
        """Compile them, or read them from where they are kept."""
        ...
