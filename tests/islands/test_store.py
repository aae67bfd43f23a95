"""Every store keeps the same promises: on a disk, and in a bucket of a real S3 server."""

from __future__ import annotations

import errno
import os
import socket
from operator import methodcaller
from pathlib import Path

import pytest
from buckets import KEYS, reaching, serving

from genome.errors import InputError
from islands.store import Store, StoreError

CALLS = (methodcaller("check"), methodcaller("names"), methodcaller("read", "x"), methodcaller("write", "x", b"."))


@pytest.fixture(scope="module")
def endpoint():
    with serving() as url, reaching(url):
        yield url


@pytest.fixture(params=["disk", "file", "s3"])
def store(request, tmp_path: Path) -> Store:
    if request.param == "s3":
        request.getfixturevalue("endpoint")
        return Store.open(f"s3://bucket/{tmp_path.name}/a run")
    return Store.open(tmp_path / "a run" if request.param == "disk" else f"{tmp_path.as_uri()}/a%20run")


def test_what_is_written_is_read(store: Store) -> None:
    for content in (b"first", b"", bytes(range(256)) * 40_000):  # the last takes several requests of S3
        store.write("log/events/e 1.parquet", content)
        assert store.read("log/events/e 1.parquet") == content
        assert store.size("log/events/e 1.parquet") == len(content)
        assert store.exists("log/events/e 1.parquet")
        assert store.at("log", "events").read("e 1.parquet") == content


def test_what_is_not_there(store: Store) -> None:
    for name in ("none", "below/none"):
        assert not store.exists(name)
        with pytest.raises(FileNotFoundError) as caught:
            store.read(name)
        assert str(caught.value.filename).endswith(name)
        with pytest.raises(FileNotFoundError):
            store.size(name)
        store.remove(name)
        store.remove_tree(name)
        assert store.names(name) == store.folders(name) == []
    assert store.names() == store.folders() == []


def test_names_and_folders_are_sorted_and_hide_what_is_hidden(store: Store) -> None:
    for name in ("b", "a", ".hidden", "log/x", "forms/y", ".tmp/z", "log/deeper/w"):
        store.write(name, b".")
    assert (store.names(), store.folders()) == (["a", "b"], ["forms", "log"])
    assert (store.names("log"), store.folders("log")) == (["x"], ["deeper"])
    assert store.at("log").names() == ["x"]
    store.write("log/.y", b"")
    store.write("log/v", b"...")
    assert list(store.sizes("log").items()) == [("v", 3), ("x", 1)]
    assert store.sizes("none") == {}
    assert not store.exists("log")
    with pytest.raises(FileNotFoundError):
        store.read("log")


def test_removing_takes_what_was_named_and_no_more(store: Store) -> None:
    for name in ("log/x", "log/deeper/w", "logs", "a"):
        store.write(name, b".")
    store.remove("a")
    assert store.names() == ["logs"]
    store.remove_tree("log")
    assert (store.names(), store.names("log/deeper"), store.folders("log")) == (["logs"], [], [])
    store.remove_tree()
    assert store.names() == store.folders() == []


def test_its_place_opens_it_again(store: Store) -> None:
    below = store.at("log", "events")
    below.write("x", b"here")
    again = Store.open(below.place)
    assert again.read("x") == b"here"
    assert (again.place, again.name, again.local) == (below.place, "events", below.local)
    assert store.name == "a run"
    assert [str(again.at("..").at())] == [str(Store.open(again.at("..").place))]
    files, root = below.arrow()
    with files.open_input_file(f"{root}/x") as stream:
        assert stream.read() == b"here"
    below.check()


def test_a_place_is_absolute_and_holds_what_the_environment_says_but_no_keys(
    endpoint: str, monkeypatch, tmp_path
) -> None:
    store = Store.open("s3://bucket/runs").at("drape")
    assert str(store) == "s3://bucket/runs/drape"
    address = endpoint.removeprefix("http://")
    assert store.place == f"s3://bucket/runs/drape?endpoint_override={address}&region=us-east-1&scheme=http"
    monkeypatch.delenv("AWS_ENDPOINT_URL")
    monkeypatch.setenv("AWS_REGION", "eu-west-9")
    asked = f"s3://bucket/runs?endpoint_override={address}&scheme=http"
    assert str(Store.open(asked).at("drape")) == f"s3://bucket/runs/drape?endpoint_override={address}&scheme=http"
    assert "region=eu-west-9" in Store.open(asked).place
    assert not [value for value in KEYS.values() if value in store.place]
    monkeypatch.chdir(tmp_path)
    assert (Store.open("runs").place, Store.open("runs").local) == (str(tmp_path / "runs"), tmp_path / "runs")


@pytest.mark.parametrize(
    ("place", "message"),
    [
        (
            "s3://key:hush@bucket/runs",
            r"s3://bucket/runs: expected a place without keys or passwords, got one with some",
        ),
        ("s3://key@bucket/runs", r"one with something before '@'; leave keys to the environment"),
        ("abfs://user:hush@host/runs", r"got one with something before '@'; leave keys"),
        ("s3://bucket/runs?secret_key=hush", r"got the option 'secret_key'; leave keys to the environment"),
        ("s3://bucket?endpoint_override=http://me:hush@host", r"got the option 'endpoint_override'"),
        ("s3:///runs", r"expected a place such as s3://bucket/runs, got no bucket"),
        ("s3://bucket/runs?scheme=http&scheme=https", r"expected each option once, got 'scheme=http&scheme=https'"),
        ("s3://bucket/runs?regoin=x", r"s3://bucket/runs: expected options .*, got 'regoin'; did you mean 'region'\?"),
        ("s3://bucket/runs?endpoint_override=ftp://host", r"endpoint_override: expected an address such as http://l"),
        ("ftp://host/runs", r"ftp://host/runs: expected a place that Arrow can open: a path, or s3://, gs://"),
        ("file://elsewhere/runs", r"expected file:///, then an absolute path, got 'elsewhere' after file://"),
        ("s3://[bucket", r"the place of runs: expected a URI such as s3://bucket/runs"),
    ],
)
def test_a_place_that_is_none_is_bad_input_and_secrets_are_not_repeated(place: str, message: str) -> None:
    with pytest.raises(InputError, match=message) as caught:
        Store.open(place)
    assert "hush" not in str(caught.value)


def test_a_server_that_is_not_there_and_a_bucket_that_is_not(endpoint: str, monkeypatch) -> None:
    for act in (methodcaller("check"), methodcaller("write", "x", b".")):
        with pytest.raises(
            StoreError, match=r"s3://none/runs.*: expected a bucket that is there, got none by that name"
        ):
            act(Store.open("s3://none/runs"))
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        monkeypatch.setenv("AWS_ENDPOINT_URL", f"http://127.0.0.1:{free.getsockname()[1]}")
        down = Store.open("s3://bucket/runs")
        for act in (CALLS[0], CALLS[2], methodcaller("remove", "x")):
            with pytest.raises(
                StoreError, match=r"got no connection \(Failed to connect .*; check the network and the"
            ):
                act(down)


def test_keys_that_are_wrong_are_told_of_and_not_told() -> None:
    with serving(closed=True) as url, reaching(url):
        store = Store.open("s3://bucket/runs")
        for act in CALLS:
            with pytest.raises(StoreError, match="check AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY") as caught:
                act(store)
            assert not [value for value in KEYS.values() if value in str(caught.value)]


@pytest.mark.parametrize("staging", ["", ".tmp"])
def test_a_full_disk_leaves_what_was_there_and_nothing_half_written(tmp_path: Path, monkeypatch, staging: str) -> None:
    store = Store.open(tmp_path)
    store.write("log/x", b"first", staging)

    def full(number: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(
        StoreError, match=r"log/x: expected a file that can be written, got no space left on device; make"
    ):
        store.write("log/x", b"second", staging)
    left = [path for path in tmp_path.rglob("*") if path.is_file()]
    assert [(path, path.read_bytes()) for path in left] == [(tmp_path / "log" / "x", b"first")]


def test_a_draft_stands_where_it_was_told_to_until_the_disk_has_it(tmp_path: Path, monkeypatch) -> None:
    seen = []
    monkeypatch.setattr(os, "fsync", lambda number: seen.extend(sorted(tmp_path.rglob("*"))))
    Store.open(tmp_path).write("events/x.parquet", b"whole", ".tmp")
    draft = tmp_path / ".tmp" / "events-x.parquet"
    assert seen == [tmp_path / ".tmp", draft, tmp_path / "events"]
    assert not draft.exists()


def test_a_folder_where_a_file_is_and_a_file_where_a_folder_is(tmp_path: Path) -> None:
    store = Store.open(tmp_path)
    store.write("a", b".")
    with pytest.raises(
        StoreError, match=r"a/b: expected a file that can be written, got file exists; check the folder"
    ):
        store.write("a/b", b".")
    (tmp_path / "folder").mkdir()
    with pytest.raises(StoreError, match=r"folder: expected a file that can be written, got is a directory"):
        store.write("folder", b".")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a", "folder"]
    with pytest.raises(FileNotFoundError):
        store.read("a/b")
