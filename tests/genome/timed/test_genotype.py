"""Genotypes of timed forms: their encoding goes round exactly, and refuses everything else."""

from __future__ import annotations

import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from timed_strategies import written_systems

from genome.errors import InputError
from genome.timed import parse_tl
from genome.timed.genotype import TimedGenotype, decode_genotype, encode_genotype

SMALL = parse_tl("axiom A(1)\nA(x) -> A(x/2)\n")


@settings(max_examples=20)
@given(written_systems(), st.integers(0, 2**63 - 1))
def test_an_encoding_goes_round_exactly_and_is_plain_json(system, seed) -> None:
    genotype = TimedGenotype(system, seed)
    text = encode_genotype(genotype)
    assert decode_genotype(text) == genotype
    assert encode_genotype(decode_genotype(text)) == text
    assert sorted(json.loads(text)) == ["format", "seed", "system"]


WRONG = [
    ("", "genotype: expected a timed genotype as a JSON object, got ''"),
    ("[1]", "genotype: expected a timed genotype as a JSON object, got '.1.'"),
    ("[" * 100_000, "genotype: expected a timed genotype as a JSON object"),
    ('{"format":2,"seed":0,"system":{}}', "genotype: format: expected 1, the version of this encoding, got 2"),
    ('{"format":1.0,"seed":0,"system":{}}', "genotype: format: expected 1"),
    ('{"format":1,"seed":-1,"system":{}}', "genotype: seed: expected a whole number from 0 to 2\\*\\*63 - 1, got -1"),
    ('{"format":1,"seed":true,"system":{}}', "genotype: seed: expected a whole number"),
    ('{"format":1,"seed":9223372036854775808,"system":{}}', "genotype: seed: expected a whole number"),
    ('{"format":1,"seed":' + "9" * 5000 + ',"system":{}}', "genotype: expected a timed genotype as a JSON object"),
    ('{"format":1,"seed":0}', "genotype: expected a JSON object of format 1, got None"),
    ('{"format":1,"seed":0,"system":{"format":1}}', "genotype: axiom: expected one statement as text, got None"),
    ('{"format":1,"seed":0,"sistem":{}}', "genotype: sistem: expected a known key, .*did you mean 'system'"),
    ('{"format":1,"seed":0,"system":{"format":1,"axiom":"A(b)"}}', "expected a parameter or a define, got 'b'"),
    ('{"format":1,"seed":0,"system":{"format":1,"axiom":"A","productions":["A -> ["]}}', "']' for this"),
]


@pytest.mark.parametrize(("text", "message"), WRONG)
def test_anything_else_is_refused_in_one_message(text, message) -> None:
    with pytest.raises(InputError, match=message):
        decode_genotype(text)


@given(st.data())
def test_a_spoilt_encoding_is_refused_or_is_another_genotype(data) -> None:
    text = encode_genotype(TimedGenotype(SMALL, 7))
    at = data.draw(st.integers(0, len(text) - 1))
    spoilt = text[:at] + data.draw(st.text(max_size=3)) + text[at + data.draw(st.integers(1, 4)) :]
    try:
        found = decode_genotype(spoilt)
    except InputError:
        return
    assert decode_genotype(encode_genotype(found)) == found
