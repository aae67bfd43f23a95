"""How long ``atoll --help`` takes, and how much memory a host of the drape holds at its most."""

from __future__ import annotations

import subprocess
import sys
import tempfile
import threading
from pathlib import Path

import psutil

from benchmarks.timing import best_of

ROOT = Path(__file__).parents[1]
ATOLL = Path(sys.executable).parent / "atoll"
HELP_S, HOST_MB = 0.5, 450.0


def ask_for_help() -> None:
    """Run ``atoll --help``."""
    subprocess.run([ATOLL, "--help"], check=True, capture_output=True)


def host_peak() -> float:
    """Run the drape for 30 generations and give the largest resident memory of a host process in MB."""
    with tempfile.TemporaryDirectory() as folder:
        command = [ATOLL, "run", ROOT / "experiments" / "drape.yaml", "--runs-dir", folder]
        run = subprocess.Popen([*command, "--set", "generations=30"], stdout=subprocess.DEVNULL, cwd=ROOT)
        peak, done = [0.0], threading.Event()
        watcher = threading.Thread(target=_watch, args=(run.pid, peak, done))
        watcher.start()
        run.wait()
        done.set()
        watcher.join()
    return peak[0]


def _watch(pid: int, peak: list[float], done: threading.Event) -> None:
    while not done.wait(0.2):
        try:
            for process in psutil.Process(pid).children(recursive=True):
                if "Host" in " ".join(process.cmdline()):
                    peak[0] = max(peak[0], process.memory_info().rss / 1e6)
        except psutil.Error:
            continue


def main() -> bool:
    """Print both figures; tell whether they are within their limits."""
    (help_s,) = best_of(ask_for_help, rounds=5)
    peak = host_peak()
    print(f"start: atoll --help {help_s:.2f} s (under {HELP_S:g} s)")
    print(f"start: largest host {peak:.0f} MB (under {HOST_MB:g} MB)")
    return help_s < HELP_S and 0 < peak < HOST_MB


if __name__ == "__main__":
    raise SystemExit(not main())
