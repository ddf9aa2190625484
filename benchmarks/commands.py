"""Several `sfgen shard` commands that join one dataset at random times, against one command that makes it alone.

    python -m benchmarks.commands [homes] [commands]

Checks that every home is made once and that both datasets are equal byte for byte; says how many cores were busy.
"""

from __future__ import annotations

import json
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
SPREAD = 20.0  # within which the commands start [s]


def start(folder: Path, homes: int) -> subprocess.Popen[str]:
    """Start a command of one worker, which tells what it came to as JSON."""
    asked = ["--count", str(homes), "--seed", "11", "--workers", "1", "--out", str(folder), "--json"]
    return subprocess.Popen([sys.executable, "-m", "sfgen.cli", "shard", *asked], cwd=ROOT, stdout=subprocess.PIPE, text=True)


def wait_for_homes(command: subprocess.Popen[str]) -> int:
    """Wait for a command; return the number of homes that it made."""
    stdout, _ = command.communicate()
    if command.returncode:
        sys.exit(f"sfgen: a command ended with exit code {command.returncode}")
    return int(json.loads(stdout.splitlines()[-1])["made"])


def content(folder: Path) -> dict[str, bytes]:
    """Return every file's bytes."""
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def main(homes: int, commands: int) -> int:
    """Run both, compare, report."""
    rng = np.random.default_rng()
    with tempfile.TemporaryDirectory() as place:
        alone, shared = Path(place) / "alone", Path(place) / "shared"
        wait_for_homes(start(alone, homes))
        before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
        joined = []
        for wait in np.diff([0.0, *np.sort(rng.uniform(0, SPREAD, commands - 1))]):
            joined.append(start(shared, homes))
            time.sleep(wait)
        joined.append(start(shared, homes))
        counts = [wait_for_homes(command) for command in joined]
        wall, after = time.perf_counter() - began, resource.getrusage(resource.RUSAGE_CHILDREN)
        cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        equal = content(alone) == content(shared)
    print(f"{homes} homes by {commands} commands that joined within {SPREAD:.0f} s: {wall:.0f} s, {cpu / wall:.2f} cores busy")
    print(f"homes that each made: {counts}, {sum(counts)} in all; same bytes as one command's: {equal}")
    return 0 if equal and sum(counts) == homes else 1


if __name__ == "__main__":
    sys.exit(main(*map(int, (sys.argv[1:] + ["64", "8"][len(sys.argv) - 1 :])[:2])))
