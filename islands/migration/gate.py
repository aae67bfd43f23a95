"""The gate where migrants stand: who is let in, and in whose place.

Residents are those who were there before the epoch began: a packet of k takes k places. A free place is taken before
anyone is replaced. One who moved here and is turned away has left its own deme already: it lives on in the log alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final, Generic, TypeVar, final

from genome.mishaps import let_pass, one_line, told
from islands.algorithms.breeding import Birth
from islands.individual import Individual, beats
from islands.migration.channel import Edge, Migrant, Packet
from islands.migration.replacement import BY_GENOTYPE, REPLACERS
from islands.records import Crossing
from islands.registrar import Registrar
from islands.selection import ranked
from islands.steered import UNSTEERED, Steered
from islands.streams import EpochStreams

G = TypeVar("G")
Translate = Callable[[str], str]
Adapters = Mapping[tuple[str, int], Translate]
"""Built adapters by their name and the source island's number."""


@final
class Gate(Generic[G]):
    """Lets migrants into one deme at the start of one epoch.

    Parameters
    ----------
    deme
        The members.
    population
        How many there is room for.
    registrar
        Scores, names and records.
    streams
        REPLACEMENT, by channel, draws.
    adapters
        Of the edges that have one.
    steered
        Says which members are promoted, and beaten by nobody, or locked, and replaced by nobody.
    """

    __slots__ = ("_adapters", "_free", "_ids", "_kept", "_promoted", "_registrar", "_residents", "_settled", "_streams")

    def __init__(
        self,
        deme: Sequence[Individual[G]],
        population: int,
        registrar: Registrar[G],
        streams: EpochStreams,
        adapters: Adapters,
        steered: Steered = UNSTEERED,
    ) -> None:
        order = ranked(deme, steered.promoted)
        self._residents: Final = [one for one in order if one.id not in steered.locked]
        self._kept: Final = [one for one in order if one.id in steered.locked]
        self._promoted: Final = steered.promoted
        self._settled: Final[list[Individual[G]]] = []
        self._ids: Final = {one.id for one in deme}
        self._free = population - len(deme)
        self._registrar: Final = registrar
        self._streams: Final = streams
        self._adapters: Final = adapters

    def deme(self) -> tuple[Individual[G], ...]:
        """Give the deme as it is by now: the locked and the residents left, best first, then those who came."""
        return (*self._kept, *self._residents, *self._settled)

    def enter(self, edge: Edge, packet: Packet) -> None:
        """Let the migrants of a packet stand at the gate, one after the other; each is one row."""
        channel = edge.channel
        for migrant in packet.migrants:
            reason = self._admit(edge, packet, migrant)
            self._registrar.crossings.append(
                Crossing(
                    self._registrar.epoch, channel.name, channel.kind, edge.source_name, edge.target_name,
                    migrant.id, migrant.fitness, not reason, reason,
                )
            )  # fmt: skip

    def _admit(self, edge: Edge, packet: Packet, migrant: Migrant) -> str:
        """Let one migrant in, or give the reason why not."""
        channel = edge.channel
        if migrant.id in self._ids and not edge.adapter:
            return "already in deme"
        if not self._free and not self._residents:
            return "no place left"
        newcomer: Individual[G] | None = None
        # Its genotype is read only where that is needed: most of those who come again and again are turned away.
        if edge.adapter or not self._registrar.scores_as(packet.scoring) or channel.replace in BY_GENOTYPE:
            read = self._read(edge, packet, migrant)
            if isinstance(read, str):
                return read
            newcomer = read
        place = -1
        if not self._free:
            biology, genotype = self._registrar.context.biology, None if newcomer is None else newcomer.genotype
            place = REPLACERS[channel.replace](self._residents, genotype, biology, channel, self._streams)
            resident = self._residents[place]
            wins = resident.id not in self._promoted and beats(newcomer or migrant, resident)
            if channel.accept == "better" and not wins:
                return "not better"
        if newcomer is None:
            read = self._read(edge, packet, migrant)
            if isinstance(read, str):
                return read
            newcomer = read
        self._settle(newcomer, place)
        return ""

    def _settle(self, newcomer: Individual[G], place: int) -> None:
        if self._free:
            self._free -= 1
        else:
            self._ids.discard(self._residents.pop(place).id)
        self._settled.append(newcomer)
        self._ids.add(newcomer.id)

    def _read(self, edge: Edge, packet: Packet, migrant: Migrant) -> Individual[G] | str:
        """Make a member of a migrant, or give the reason why that cannot be.

        It is scored again where this island scores otherwise than its source, and where fitness is shared. One that
        comes through an adapter is an individual of this island, born here.
        """
        registrar, text = self._registrar, migrant.text
        what = "adapter" if edge.adapter else "genotype"
        try:
            if edge.adapter:
                text = self._adapters[edge.adapter, edge.source](text)
            genotype: Any = registrar.context.biology.decode(text)
        except BaseException as error:  # noqa: BLE001 - whatever a plug-in raises, or another island sent
            let_pass(error)
            return one_line(f"{what}: {told(error)}")
        if edge.adapter:
            return registrar.bear(Birth(genotype, (migrant.id,), "adaptation"))
        if not registrar.scores_as(packet.scoring):
            return registrar.score_again(migrant.id, genotype, "migrant", registrar.generation)
        return Individual(migrant.id, genotype, migrant.fitness, migrant.scores, migrant.error, registrar.generation)
