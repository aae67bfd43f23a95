"""How fast genomes become text: Atoll's compiled mapper against a plain Python one and against alogos.

Run it as ``python benchmarks/bnf_mapping.py``; it prints ratios of rates that were measured in turns in one run.

Two grammars: short programs, which all three map in the same way (alogos reads no gene for a single production, and the
grammar has none), their texts compared before anything is timed; and Genr8's, whose repetitions, labels and repair
alogos does not know, against the plain mapper only. The plain mapper is the tests' reference: recursion over the parsed
grammar, without anything compiled.
"""

from __future__ import annotations

import statistics
import sys
import time
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "support")]

import alogos  # noqa: E402
import numpy as np  # noqa: E402
from reference_mapper import OutOfGenesError, ReferenceMapper  # noqa: E402

from genome.bnf import parse_bnf  # noqa: E402
from genome.genr8 import Genr8Mapper, load_grammar  # noqa: E402
from genome.grammar import Grammar, Item, NonTerminal, Terminal  # noqa: E402
from genome.integers import Genes, random_genes  # noqa: E402
from genome.mapping import Mapper, Unmapped  # noqa: E402
from genome.program import Labels  # noqa: E402

PROGRAM = """
<program>   ::= <statement> <statement> <statement> <statement> <statement>
              | <statement> <statement> <statement> <statement> <statement> <statement> <statement>
<statement> ::= <v> = <e> ; | if ( <e> ) <v> = <e> ;
<e>  ::= <v> | <c> | <v> | ( <e> <op> <e> ) | <f> ( <e> )
<op> ::= + | - | * | /
<f>  ::= sin | cos | exp | log
<v>  ::= x | y | z
<c>  ::= <d> | <d> . <d>
<d>  ::= 0 | 1 | 2 | 3 | 4 | 5 | 6 | 7 | 8 | 9
"""
WRAPS, GENOMES, ROUNDS = 3, 300, 7

Map = Callable[[Genes], str | None]


def main() -> None:
    """Measure and print."""
    rng = np.random.default_rng(1)
    genomes = [random_genes(rng, 200, 256) for _ in range(GENOMES)]
    print("bnf_mapping: genomes of 200 genes to text, median of", ROUNDS, "rounds of", GENOMES)
    grammar = parse_bnf(PROGRAM, "program")
    peers = {"plain Python": _plain(ReferenceMapper(grammar, wraps=WRAPS)), "alogos": _alogos(grammar)}
    _report("programs", genomes, _atoll(Mapper(grammar, wraps=WRAPS, separator="")), peers)
    genr8 = load_grammar("genr8", ROOT)
    plain = ReferenceMapper(genr8, Labels(), 8, WRAPS, 2000)
    _report("genr8, with repair", genomes, _atoll(Genr8Mapper(genr8)), {"plain Python": _plain_with_repair(plain)})


def _atoll(mapper: Mapper | Genr8Mapper) -> Map:
    def mapped(genes: Genes) -> str | None:
        found = mapper.map(genes)
        if isinstance(found, Unmapped):
            return None
        return found if isinstance(found, str) else found.text

    return mapped


def _plain(mapper: ReferenceMapper) -> Map:
    def mapped(genes: Genes) -> str | None:
        try:
            mapper.map(genes)
        except OutOfGenesError:
            return None
        return "".join(mapper.out)

    return mapped


def _plain_with_repair(mapper: ReferenceMapper) -> Map:
    def mapped(genes: Genes) -> str | None:
        try:
            return mapper.map_with_repair(genes, "Successor", 2)[0]
        except OutOfGenesError:
            return None

    return mapped


def _alogos(grammar: Grammar) -> Map:
    # alogos takes blanks between symbols as part of the text, so the grammar is written without them
    text = "\n".join(
        f"<{name}> ::= {' | '.join(''.join(map(_symbol, sequence)) for sequence in found)}"
        for name, found in grammar.rules.items()
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # it warns of <v>, which stands twice on purpose: it is likelier
        alogos_grammar = alogos.Grammar(bnf_text=text)
    forward = alogos.systems.ge.mapping.forward
    parameters = {"max_wraps": WRAPS}

    def mapped(genes: Genes) -> str | None:
        try:
            return str(forward(alogos_grammar, list(genes), parameters))
        except alogos.exceptions.MappingError:
            return None

    return mapped


def _symbol(item: Item) -> str:
    if isinstance(item, NonTerminal):
        return f"<{item.name}>"
    if isinstance(item, Terminal):
        return item.text
    raise TypeError(item)


def _report(name: str, genomes: Sequence[Genes], ours: Map, others: dict[str, Map]) -> None:
    texts = [ours(genes) for genes in genomes]
    for other, mapped in others.items():
        differing = sum(mapped(genes) != text for genes, text in zip(genomes, texts, strict=True))
        if differing:
            sys.exit(f"{name}: {other} maps {differing} genomes to other texts")
    times: dict[str, list[float]] = {other: [] for other in ["atoll", *others]}
    for _ in range(ROUNDS):
        for other, mapped in {"atoll": ours, **others}.items():
            start = time.perf_counter()
            for genes in genomes:
                mapped(genes)
            times[other].append(time.perf_counter() - start)
    valid = sum(text is not None for text in texts)
    length = statistics.mean(len(text) for text in texts if text is not None)
    own = statistics.median(times["atoll"])
    print(f"{name}: {valid} of {len(genomes)} genomes map, {length:.0f} characters on average; same texts from all")
    print(f"  atoll {own / len(genomes) * 1e6:.1f} us a genome")
    for other in others:
        ratio = statistics.median(theirs / mine for theirs, mine in zip(times[other], times["atoll"], strict=True))
        print(f"  {other}: {ratio:.1f} times atoll's time (at least 3 is wanted)")


if __name__ == "__main__":
    main()
