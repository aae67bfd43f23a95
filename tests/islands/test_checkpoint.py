"""A host's part of a checkpoint: the same bits back, and the same history after it."""

from __future__ import annotations

import hashlib
import json
from types import SimpleNamespace

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import species
from archipelagos import edge, island, spec
from bits import BitsKind
from hypothesis import given, settings
from hypothesis import strategies as st
from passages import CHAMPIONS, bits_of, packets, states
from stepping import Stepping
from traders import HouseKind, judging, trading

from experiments import write
from genome.errors import InputError
from islands.checkpoint import Kept, Part, check_part, read_parts, write_part
from islands.holdings import NOTHING
from islands.individual import Individual
from islands.kinds.bits import BitsKind as OwnBitsKind
from islands.kinds.composite import CompositeBiology
from islands.kinds.surface import SurfaceKind
from islands.migration.channel import Channel, Migrant, Packet
from islands.state import State
from islands.store import Store
from islands.tally import Tally
from orchestrator.loading import load_experiment

EPOCH = 3


class PairKind(BitsKind):
    def build(self, made, clock):
        parts = [BitsKind().build(made, clock) for _ in range(2)]
        return CompositeBiology(parts, lambda genotype: None, "pair", 0.01)


SURFACE = {
    "genome": SurfaceKind.genome(length=40).model_dump(mode="json"),
    "growth": SurfaceKind.growth(steps=2).model_dump(mode="json"),
    "fitness": {"size": {"goal": "maximise"}},
}
OWN = {"genome": {"length": 12}, "fitness": {"ones": {"goal": "maximise"}}}
KINDS = {
    "tests' bits": (BitsKind, {}),
    "bits": (OwnBitsKind, OWN),
    "surface": (SurfaceKind, SURFACE),
    "composite": (PairKind, {}),
    "house": (HouseKind, {}),
    "house of texts": (species.HouseKind, {}),
}


def drawn(isle) -> st.SearchStrategy:
    """Genotypes as the kind makes them."""
    biology = isle.biology
    if isinstance(biology, species.HouseBiology):
        biology = biology.supplied((Migrant(1 << 60, "é\u2028\0", 1.0, (), ""), Migrant(5, "", None, (), "no")))
    return st.integers(0, 2**32).map(lambda seed: biology.random(np.random.default_rng(seed)))


@pytest.fixture
def store(tmp_path) -> Store:
    return Store.open(tmp_path)


@pytest.mark.parametrize("name", KINDS)
def test_what_is_read_is_to_the_bit_what_was_written(name, tmp_path_factory) -> None:
    kind, changes = KINDS[name]
    isles = [island(number, kind=kind, **changes) for number in (7, 2, 4)]
    store = Store.open(tmp_path_factory.mktemp("run"))

    @settings(max_examples=15, deadline=None)
    @given(st.data())
    def holds(data) -> None:
        kept = [
            Kept(
                isle,
                data.draw(states(EPOCH, drawn(isle))),
                data.draw(packets(EPOCH, isle.spec.number)),
                data.draw(CHAMPIONS),
            )
            for isle in isles
        ]
        part = write_part(store, EPOCH, 1, kept)
        assert part.islands == (2, 4, 7)
        found = read_parts(store, [part], isles)
        assert list(found) == [7, 2, 4]
        for isle, state, pending, champion in kept:
            there = found[isle.spec.number]
            assert bits_of(there) == ("Restored", [bits_of(one) for one in (state, pending, champion)])
            assert (there.state.held is NOTHING) == (state.held == NOTHING)

    holds()


def kept(number: int, count: int = 2, pending=()) -> Kept:
    isle = island(number)
    words = [tuple(int(bit) for bit in f"{number * count + place:024b}") for place in range(count)]
    deme = tuple(Individual(place, word, 1.0, (("ones", 1.0),), "", 1) for place, word in enumerate(words))
    return Kept(isle, State(deme, EPOCH, 9, 20, 1.0, 2, NOTHING, "key"), pending, (1.0, 3))


def test_a_part_is_one_file_whose_name_and_bytes_hang_on_its_content_alone(store) -> None:
    part = write_part(store, EPOCH, 12, [kept(1), kept(0)])
    assert part.file == "checkpoints/e000003/host-00012.parquet"
    content = store.read(part.file)
    assert (part.bytes, part.sha256) == (len(content), hashlib.sha256(content).hexdigest())
    assert store.names("checkpoints/e000003") == ["host-00012.parquet"]
    again = write_part(store, EPOCH, 12, [kept(0), kept(1)])
    assert (again, store.read(again.file)) == (part, content)
    assert pq.read_table(store.local / part.file).column("island").to_pylist() == [0, 1]


def test_an_island_is_read_from_whichever_part_holds_it_and_no_other_part_is_touched(store) -> None:
    parts = [write_part(store, EPOCH, host, [kept(2 * host), kept(2 * host + 1)]) for host in range(3)]
    store.remove(parts[1].file)
    wanted = [kept(5), kept(0)]
    found = read_parts(store, parts, [one.island for one in wanted])
    assert {number: one.state for number, one in found.items()} == {one.island.spec.number: one.state for one in wanted}
    with pytest.raises(InputError) as caught:
        read_parts(store, parts, [island(3)])
    assert str(caught.value) == f"{parts[1].file}: expected a part of a checkpoint, {parts[1].bytes} bytes, got no file"
    with pytest.raises(InputError, match="expected a part that holds the island isle-6, got none"):
        read_parts(store, parts, [island(6)])


def test_a_broadcast_is_written_once_whoever_reads_it(store) -> None:
    migrants = (Migrant(9, "".join(chr(48 + (7 * n * n) % 73) for n in range(3000)), 1.0, (), ""),)
    whole = [kept(n, pending=[Packet(0, 50, n, 3, "key", migrants)]) for n in range(40)]
    alone = write_part(store, EPOCH, 0, whole[:1])
    part = write_part(store, EPOCH, 1, whole)
    rows = pq.read_table(store.local / part.file).column("pending").to_pylist()
    assert sum(len(row) for row in rows) < len(pq.read_table(store.local / alone.file)["pending"][0].as_py()) + 300
    found = read_parts(store, [part], [one.island for one in whole[30:]])
    assert {n: one.pending for n, one in found.items()} == {n: tuple(whole[n].pending) for n in range(30, 40)}


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda raw: raw[:-1], "expected a part of a checkpoint, {size} bytes, got {less} bytes"),
        (lambda raw: b"", "expected a part of a checkpoint, {size} bytes, got 0 bytes"),
        (lambda raw: raw[:99] + bytes([raw[99] ^ 1]) + raw[100:], "expected the sha256 {hash}..., got "),
    ],
)
def test_a_part_that_is_not_what_was_written_is_refused(store, spoil, said) -> None:
    part = write_part(store, EPOCH, 0, [kept(0)])
    assert check_part(store, part) == store.read(part.file)
    store.write(part.file, spoil(store.read(part.file)))
    with pytest.raises(InputError) as caught:
        read_parts(store, [part], [island(0)])
    told = said.format(size=part.bytes, less=part.bytes - 1, hash=part.sha256[:12])
    assert str(caught.value).startswith(f"{part.file}: {told}")


def test_an_island_that_is_another_by_now_is_refused(store) -> None:
    part = write_part(store, EPOCH, 0, [kept(0)])
    with pytest.raises(InputError) as caught:
        read_parts(store, [part], [island(0, name="moon")])
    got = "got 'isle-0' under its number 0; the experiment was changed"
    assert str(caught.value) == f"{part.file}: expected the state of the island moon, {got}"
    changed = island(0)
    changed.biology.decode = lambda text: 1 / 0
    with pytest.raises(InputError) as caught:
        read_parts(store, [part], [changed])
    expected = "expected genotypes of the island isle-0 that its kind reads"
    said = f"{expected}, got ZeroDivisionError: division by zero; the kind was changed since"
    assert str(caught.value) == f"{part.file}: {said}"


@pytest.mark.parametrize("pending", [[Packet(0, 1, 1, EPOCH, "key")], [Packet(0, 1, 0, EPOCH + 1, "key")], None])
def test_what_is_of_another_island_or_epoch_is_not_written(store, pending) -> None:
    one = kept(0, pending=pending or ())
    with pytest.raises(ValueError, match="isle-0"):
        write_part(store, EPOCH + (pending is None), 0, [one])
    assert store.folders("checkpoints") == []


def test_a_tally_goes_on_from_the_champions_of_its_checkpoint() -> None:
    isle = island(0, (edge(Channel(0, "c"), 0, 1),))
    first = isle.begin()
    whole = Tally([spec()])
    whole.add(0, first)
    champion = whole.champions(0)[0]
    assert champion == min(((row.fitness, row.id) for row in first.records.born), key=lambda one: (-one[0], one[1]))
    again = Tally([spec()])
    again.restore({0: champion})
    after = isle.advance(first.state, 1, ())
    worse = SimpleNamespace(state=after.state, records=after.records.__class__(generations=after.records.generations))
    again.add(0, worse)
    assert again.champions(1) == {0: champion}
    blank = Tally([spec()])
    blank.restore({0: None})
    blank.add(0, worse)
    assert blank.champions(1) == {0: None}


LOSING = {"topology": "ring", "among": "model", "mode": "move", "count": 3}
EXPERIMENTS = {
    "every kind of channel": trading(epochs=7),
    "an archive of partners": judging({"pairing": "archive", "pairings": 3, "archive": 2}),
    "redrawn edges": judging({"pairing": "random"}, seed=4)
    | {"channels": [*judging({})["channels"], {"topology": {"name": "random", "degree": 1}, "among": "odd"}, LOSING]},
}


@pytest.mark.parametrize("name", EXPERIMENTS)
@pytest.mark.parametrize("at", [0, 3, 4])
def test_islands_that_go_on_from_parts_have_the_records_of_an_undisturbed_run(name, at, store, tmp_path) -> None:
    loaded = load_experiment(write(tmp_path, EXPERIMENTS[name]))
    whole = Stepping.of(loaded).on(at + 1)
    numbers = [one.spec.number for one in whole.islands]
    parts = [write_part(store, at, host, whole.kept(numbers[host::2])) for host in range(2)]
    whole.records.clear()
    whole.on(3)
    again = Stepping.of(loaded)
    found: dict = {}
    for third in (numbers[:2], numbers[2:3], numbers[3:]):
        found |= read_parts(store, parts, [again.islands[one] for one in third])
    again.restore(found).on(3)
    assert len(again.records) == 3 * len(numbers)
    assert again.records == whole.records
    assert bits_of(tuple(again.states.values())) == bits_of(tuple(whole.states.values()))
    assert again.pending == whole.pending
    assert again.tally.champions(at + 3) == whole.tally.champions(at + 3)
    if at:
        held = [one.state.held for one in found.values()]
        assert any(one.partners for one in held)
        assert any(one.surroundings for one in held)


def test_a_part_of_version_1_is_read_still(store) -> None:
    """It has no outcomes and nothing of what is watched."""
    whole = kept(3)
    write_part(store, EPOCH, 0, [whole])
    path = store.local / "checkpoints/e000003/host-00000.parquet"
    table = pq.read_table(path).drop_columns(["outcomes"])
    told = json.loads(table.column("state")[0].as_py())
    del told["watched"]
    place = table.schema.get_field_index("state")
    table = table.set_column(place, table.schema.field(place), pa.array([json.dumps(told)]))
    for version, is_read in (("1", True), ("3", False)):
        pq.write_table(table.replace_schema_metadata({"atoll.checkpoint": version}), path)
        content = path.read_bytes()
        part = Part("checkpoints/e000003/host-00000.parquet", len(content), hashlib.sha256(content).hexdigest(), (3,))
        if is_read:
            assert read_parts(store, [part], [whole.island])[3].state == whole.state
        else:
            with pytest.raises(InputError, match="expected a part of a checkpoint, version 2, got version 3"):
                read_parts(store, [part], [whole.island])
