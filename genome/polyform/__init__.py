"""Genotypes of rooms, zones and houses: sequences of conjoinings (Rosenman 1997, section 3.2.1)."""

from genome.polyform.encoding import decode_any, decode_assembly, decode_room, encode
from genome.polyform.genotypes import Assembly, Attachment, Conjoining, Part, Room
from genome.polyform.variation import crossover

__all__ = [
    "Assembly",
    "Attachment",
    "Conjoining",
    "Part",
    "Room",
    "crossover",
    "decode_any",
    "decode_assembly",
    "decode_room",
    "encode",
]
