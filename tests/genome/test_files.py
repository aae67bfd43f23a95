"""Files are written whole or not at all."""

import os
import threading
from pathlib import Path

import pytest

from genome.errors import InputError
from genome.files import write_whole


def test_a_file_is_replaced_and_nothing_is_left_beside_it(tmp_path: Path) -> None:
    for content in (b"first", b"second"):
        write_whole(tmp_path / "a.txt", content)
        assert [(path.name, path.read_bytes()) for path in tmp_path.iterdir()] == [("a.txt", content)]


def test_a_write_that_fails_half_way_leaves_the_file_as_it_was(tmp_path: Path, monkeypatch) -> None:
    def half(path: Path, content: bytes) -> None:
        with path.open("wb") as stream:
            stream.write(content[:2])
        raise OSError(28, "No space left on device")

    write_whole(tmp_path / "a.txt", b"first")
    monkeypatch.setattr(Path, "write_bytes", half)
    with pytest.raises(InputError, match=r"a\.txt: expected a file that can be written, got no space left on device"):
        write_whole(tmp_path / "a.txt", b"second")
    assert [(path.name, path.read_bytes()) for path in tmp_path.iterdir()] == [("a.txt", b"first")]


def test_a_folder_that_is_none_is_bad_input(tmp_path: Path) -> None:
    write_whole(tmp_path / "a.txt", b"first")
    for place, reason in (("a.txt/b.txt", "not a directory"), ("none/b.txt", "no such file or directory")):
        with pytest.raises(InputError, match=f"got {reason}; check the folder"):
            write_whole(tmp_path / place, b"")


def test_a_pipe_is_written_to_and_stays_one(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    read: list[bytes] = []
    reader = threading.Thread(target=lambda: read.append(pipe.read_bytes()))
    reader.start()
    write_whole(pipe, b"through")
    reader.join(20)
    assert read == [b"through"]
    assert pipe.is_fifo()
