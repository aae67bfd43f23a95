"""One run that faults are done to: the command line in processes of its own, its traps, its log, its digest."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import psutil
from traps import PLACE, Trap

from experiments import bits, write
from islands.store import Store
from orchestrator.digest import digest
from orchestrator.query import ask

ROOT = Path(__file__).resolve().parents[2]
DEADLINE_S = 120.0
RAY = ("--set", "backend=ray", "--set", "hosts=2")


def tortured(**changes: Any) -> dict[str, Any]:
    """The experiment: short epochs, a log and checkpoints that are written all the time."""
    data = bits(
        epochs=12, epoch=2, log={"flush_generations": 4}, checkpoint={"every": 3, "keep": 2, "spacing": 0},
        deadlines={"silence": 20},
    )  # fmt: skip
    data["defaults"]["kind"] = "traps:TrappedKind"
    return {**data, **changes}


def slowed(ms: float = 3.0, **changes: Any) -> dict[str, Any]:
    """As :func:`tortured`, with time to strike from outside: a hundred evaluations or so an epoch, each of these ms."""
    data = tortured(**changes)
    data["defaults"]["growth"] = {"delay_ms": ms}
    return data


def undisturbed(data: dict[str, Any]) -> tuple[str, int]:
    """Give the digest of the experiment when nothing happens to it."""
    settled = {key: value for key, value in data.items() if key not in ("hosts", "backend", "deadlines", "checkpoint")}
    return _undisturbed(json.dumps(settled))


@cache
def _undisturbed(text: str) -> tuple[str, int]:
    with TemporaryDirectory() as folder:
        calm = Ordeal(Path(folder), {**json.loads(text), "backend": "inline"})
        calm.ended(calm.run(), 0)
        return calm.digest()


@dataclass(frozen=True)
class Ended:
    code: int
    out: str
    err: str

    @property
    def told(self) -> dict[str, Any]:
        """The JSON object that is all of stdout."""
        (line,) = self.out.splitlines()
        found = json.loads(line)
        assert isinstance(found, dict)
        return found

    @property
    def complaint(self) -> str:
        """The last line of stderr, which says what is wrong; no traceback stands before it."""
        assert "Traceback" not in self.err, self.err
        last = self.err.strip().splitlines()[-1]
        assert last.startswith("atoll: "), self.err
        return last


class Ordeal:
    """See the module's docstring.

    Parameters
    ----------
    folder
        Empty; the experiment, the marks of traps and the runs go here.
    data
        The experiment.
    traps
        What is laid for its first run; later commands meet those that have not struck.
    runs
        Where runs stand, if not here.
    """

    def __init__(
        self,
        folder: Path,
        data: dict[str, Any],
        *traps: Trap,
        runs: str = "runs",
        environment: Mapping[str, str] | None = None,
    ) -> None:
        self.folder, self.data, self.runs = folder, data, runs
        self.more = dict(environment or {})
        self.started = 0.0
        write(folder, data)
        self.lay(*traps)

    # -- commands ----------------------------------------------------------------------------------------------------

    @property
    def place(self) -> str:
        """The run's folder, as a command takes it."""
        return f"{self.runs}/bits"

    @property
    def path(self) -> Path:
        return self.folder / self.runs / "bits"

    @property
    def store(self) -> Store:
        return Store.open(self.place if "://" in self.runs else self.path)

    def start(self, *words: str) -> subprocess.Popen[str]:
        """Start a command in a process group of its own."""
        kept = {key: value for key, value in os.environ.items() if not key.startswith("RAY_")}
        paths = os.pathsep.join([str(ROOT), str(ROOT / "tests" / "support")])
        self.started = time.time()
        return subprocess.Popen(
            [sys.executable, "-m", "orchestrator.cli", *words],
            cwd=self.folder,
            env={**kept, "PYTHONPATH": paths, "ATOLL_TEST": str(self.folder), PLACE: str(self.folder), **self.more},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )

    def run(self, *words: str) -> subprocess.Popen[str]:
        return self.start("run", "bits.yaml", "--runs-dir", self.runs, "--json", *words)

    def resume(self, *words: str) -> subprocess.Popen[str]:
        return self.start("resume", self.place, "--json", *words)

    def steer(self, *words: str) -> Ended:
        return self.ended(self.start("steer", self.place, *words, "--json"), None)

    def ended(self, process: subprocess.Popen[str], code: int | None, seconds: float = DEADLINE_S) -> Ended:
        """Wait for the end, which may not be long in coming."""
        try:
            out, err = process.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.communicate()
            raise
        if code is not None:
            assert process.returncode == code, (process.returncode, out, err)
        return Ended(process.returncode, out, err)

    # -- traps -------------------------------------------------------------------------------------------------------

    def lay(self, *traps: Trap) -> None:
        """Lay traps, in place of those before."""
        (self.folder / "traps.json").write_text(json.dumps([asdict(trap) for trap in traps]), encoding="utf-8")

    def marks(self, kind: str = "struck") -> list[dict[str, Any]]:
        """Give what traps (or processes that are back at work) left, by time."""
        found = [json.loads(path.read_text(encoding="utf-8")) for path in self.folder.glob(f"{kind}-*.json")]
        return sorted(found, key=lambda mark: mark["time"])

    def strike(self) -> dict[str, Any]:
        """Leave a mark as a trap does: a signal from outside follows."""
        mark = {"time": time.time(), "name": "from outside"}
        path = self.folder / f"struck-outside-{len(self.marks())}.json"
        draft = path.with_suffix(".draft")
        draft.write_text(json.dumps(mark), encoding="utf-8")
        draft.replace(path)
        return mark

    def recovered_s(self, since: float | None = None) -> float:
        """Give the seconds from the last strike (or another moment) until all hosts were back at work."""
        since = self.marks()[-1]["time"] if since is None else since
        back = [mark["time"] - since for mark in self.marks("back")]
        assert back, "nobody came back"
        return round(max(back), 2)

    # -- what can be seen of it --------------------------------------------------------------------------------------

    def until(self, true: Callable[[], Any], process: subprocess.Popen[str], seconds: float = 60.0) -> Any:
        """Wait until something is so, while the process goes on."""
        ends = time.monotonic() + seconds
        while True:
            found = true()
            if found:
                return found
            assert process.poll() is None, process.communicate()
            assert time.monotonic() < ends, "it did not come to this"
            time.sleep(0.02)

    def hosts(self, process: subprocess.Popen[str]) -> list[psutil.Process]:
        """Give the hosts of a driver on a local Ray."""
        return [child for child in psutil.Process(process.pid).children(recursive=True) if is_host(child)]

    def checkpoints(self) -> list[int]:
        """Give the epochs of whole checkpoints, ascending."""
        return sorted(int(path.stem[1:]) for path in self.path.glob("checkpoints/e*.json"))

    def manifest(self) -> dict[str, Any]:
        found = json.loads(self.store.read("manifest.json"))
        assert isinstance(found, dict)
        return found

    def events(self, *kinds: str) -> list[tuple[str, dict[str, Any]]]:
        """Give the events of the whole run of some kinds, in order."""
        rows = ask(self.store.at("log"), "select kind, detail from events where island is null order by time").rows
        return [(str(kind), json.loads(detail)) for kind, detail in rows if kind in kinds or not kinds]

    def digest(self) -> tuple[str, int]:
        return digest(self.store.at("log"))

    def same(self) -> bool:
        """Tell whether the log is that of the undisturbed experiment, and nothing is left of any draft."""
        drafts = [path for path in self.path.rglob("*") if path.name.endswith(".tmp") or ".tmp" in path.parts]
        assert [path for path in drafts if path.is_file()] == []
        return self.digest() == undisturbed(self.data)


def is_host(process: psutil.Process) -> bool:
    try:
        words = process.cmdline()
    except psutil.Error:
        return False
    return bool(words) and words[0].startswith("ray::Host")


def noise(err: str) -> list[str]:
    """Give the lines that are none of Atoll's progress."""
    return [line for line in err.splitlines() if not line.startswith(("run bits", "epoch ", "host ", "note"))]


def belongs(process: psutil.Process, folder: Path) -> bool:
    try:
        return process.environ().get("ATOLL_TEST", "").startswith(str(folder))
    except psutil.Error:
        return False
