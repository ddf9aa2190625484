"""Power cuts and kills: nothing is lost, and nothing is wrong and not noticed.

    python benchmarks/crashes.py [power cuts] [kills]

Replays what power cuts may leave of a small dataset (tests/shards/powercut.py), checks and recovers each distinct state; then kills
a run with SIGKILL at random moments and starts it again, until it is done, again and again. By default 100,000 and 1,000: some hours.
"""

import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests" / "shards"))
import crashes  # noqa: E402 - the tests' own checks, over more states
import made  # noqa: E402

HEADER = replace(made.HEADER, count=24, licence="CC0-1.0", digests={})  # what made.py makes


def kill(times: int, scratch: Path) -> tuple[int, int]:
    """Kill runs so many times; returns the datasets that came to their end meanwhile, and those that were not what they should be."""
    made.fill(scratch / "whole", HEADER)
    whole, folder = made.snapshot(scratch / "whole"), scratch / "set"
    rng, kills, ended, wrong = random.Random(0), 0, 0, 0
    command = [sys.executable, str(ROOT / "tests" / "shards" / "made.py"), str(folder), "0.02"]
    while kills < times:
        run = subprocess.Popen(command, env={**os.environ, "PYTHONPATH": str(ROOT)})
        time.sleep(rng.uniform(0.3, 4.0))
        if run.poll() is None:
            kills += 1
            run.send_signal(signal.SIGKILL)
        run.wait()
        if run.returncode == 0:
            ended += 1
            wrong += made.snapshot(folder) != whole
            shutil.rmtree(folder)
    made.fill(folder, HEADER)
    return ended + 1, wrong + (made.snapshot(folder) != whole)


def main(cuts: int, kills: int) -> int:
    """Do both; report."""
    start = time.process_time()
    distinct, reported, faults = crashes.run(cuts)
    print(f"{cuts} power cuts, {distinct} distinct states: {len(faults)} faults, reported instead of recovered: {reported or 0}")
    print(f"{(time.process_time() - start) / max(1, distinct) * 1e3:.0f} ms of CPU a state")
    for fault in faults[:10]:
        print(f"  {fault}")
    with tempfile.TemporaryDirectory() as place:
        ended, wrong = kill(kills, Path(place))
    print(f"{kills} kills over {ended} datasets: {wrong} with other bytes")
    return bool(faults or wrong)


if __name__ == "__main__":
    given = [int(a) for a in sys.argv[1:3]]
    sys.exit(main(*given, *(100_000, 1_000)[len(given) :]))
