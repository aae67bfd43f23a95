"""What safety costs: log and checkpoints as a share of CPU time, and how soon a run is at work again."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import psutil

from benchmarks.runs import ROOT

SHARE, RESUME_S, HOST_S = 0.05, 3.0, 5.0

SHARE_OF = """
import json, resource, sys, time
import islands.stores.disk as disk
from islands.host import Host
from islands.log import LogWriter

spent = 0.0
def timed(owner, name):
    found = getattr(owner, name)
    def call(*arguments, **named):
        global spent
        began = time.process_time()
        try:
            return found(*arguments, **named)
        finally:
            spent += time.process_time() - began
    setattr(owner, name, call)

timed(Host, "_settle")      # which writes the log
timed(Host, "checkpoint")   # which writes the rest of it, and a part
timed(LogWriter, "add")
from orchestrator.drive import Drive
timed(Drive, "_seal")
from orchestrator.cli import main
try:
    main(sys.argv[1:])
except SystemExit as ended:
    assert not ended.code, ended.code
print(json.dumps([spent, time.process_time()]))
"""
"""A run in one process, with the clock of its CPU read around whatever writes."""

EXPERIMENT = ROOT / "experiments" / "drape.yaml"


def share_of_cpu(folder: Path) -> float:
    """Run the drape inline; give the share of its CPU time that log and checkpoints took."""
    words = ["run", str(EXPERIMENT), "--runs-dir", str(folder / "share"), "--json"]
    words += ["--set", "backend=inline", "--set", "generations=60"]
    command = [sys.executable, "-c", SHARE_OF, *words]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    spent, whole = json.loads(done.stdout.splitlines()[-1])
    return float(spent / whole)


def start(*words: str) -> subprocess.Popen[str]:
    """Start the command line."""
    command = [sys.executable, "-m", "orchestrator.cli", *words, "--json"]
    return subprocess.Popen(
        command, cwd=ROOT, env=os.environ.copy(), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
    )


def until(process: subprocess.Popen[str], beginning: str) -> float:
    """Read what a run tells until a line begins so; give the time then."""
    assert process.stderr is not None
    for line in process.stderr:
        if line.startswith(beginning):
            return time.perf_counter()
    raise RuntimeError(f"the run ended ({process.wait()}) without a line that begins with '{beginning}'")


def hosts_of(process: subprocess.Popen[str]) -> list[psutil.Process]:
    """Give the processes of a run's hosts."""
    children = psutil.Process(process.pid).children(recursive=True)
    return [child for child in children if child.name().startswith("ray::Host")]


def recoveries(folder: Path) -> tuple[float, float]:
    """Kill a host, then the driver; give the seconds until the run came a generation further each time.

    The first: from the kill to the first generation that all islands have finished again. The second: from "going on",
    when Ray is up, to the same. Demes are small, so that it is not the generation itself that takes the time.
    """
    words = ("--set", "epoch=1", "--set", "islands.drape.population=8", "--set", "generations=20000")
    words += ("--set", "hosts=2", "--set", "checkpoint.every=1")
    run = start("run", str(EXPERIMENT), "--runs-dir", str(folder), *words)
    until(run, "epoch 2/")
    time.sleep(8.0)  # longer than checkpoints are apart
    hosts_of(run)[0].kill()
    killed = time.perf_counter()
    until(run, "host ")
    host_s = until(run, "epoch ") - killed
    run.kill()
    run.communicate()
    resumed = start("resume", str(folder / "drape"))
    ready = until(resumed, "going on after epoch")
    resume_s = until(resumed, "epoch ") - ready
    resumed.terminate()
    resumed.communicate()
    return host_s, resume_s


def main() -> bool:
    """Print the figures; tell whether they are within their limits."""
    with tempfile.TemporaryDirectory() as folder:
        share = share_of_cpu(Path(folder))
        host_s, resume_s = recoveries(Path(folder))
    print(f"recovery: log and checkpoints {share:.1%} of a run's CPU time (under {SHARE:.0%})")
    print(f"recovery: a killed host back at work, a generation done, after {host_s:.1f} s (under {HOST_S:g} s)")
    print(f"recovery: resume to the first new generation, Ray being up, {resume_s:.1f} s (under {RESUME_S:g} s)")
    return share < SHARE and host_s < HOST_S and resume_s < RESUME_S


if __name__ == "__main__":
    raise SystemExit(not main())
