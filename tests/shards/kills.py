"""Power cuts and kills: nothing is lost, and nothing is wrong and not noticed.

    python tests/shards/kills.py [power cuts] [kills]

Replays what power cuts may leave of a small dataset (powercut.py), checks and recovers each distinct state; then kills
commands with SIGKILL at random moments of their work, alone and in pairs on one dataset, and starts them again until it is whole, again
and again. By default 100,000 and 1,000: about an hour of one core.
"""

import os
import random
import shutil
import signal
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import pyarrow as pa

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT)]
import crashes  # noqa: E402 - the tests' own checks, over more states
import made  # noqa: E402

HEADER = replace(made.HEADER, count=12)


def command(folder: Path) -> int:
    """Start a command that makes what is missing of the dataset; returns its process. Forked: imports would be most of its life."""
    if pid := os.fork():
        return pid
    try:
        made.fill(folder, HEADER)
    except BaseException as error:  # noqa: BLE001 - told by the exit code, and to who looks
        print(f"a command failed: {error!r}", file=sys.stderr, flush=True)
        os._exit(1)
    os._exit(0)


def kill(times: int, scratch: Path) -> tuple[int, int, int]:
    """Kill commands so many times; returns the datasets that came to their end meanwhile, those with other bytes, and commands that failed."""
    began = time.monotonic()
    os.waitpid(command(scratch / "whole"), 0)
    span = time.monotonic() - began  # of an undisturbed command
    whole, folder = made.snapshot(scratch / "whole"), scratch / "set"
    rng, kills, ended, wrong, failed = random.Random(0), 0, 0, 0, 0
    while kills < times or folder.exists():
        running = [command(folder) for _ in range(rng.choice((1, 2)))]
        if kills < times:
            time.sleep(rng.uniform(0.0, span * len(running)))
            os.kill(running[0], signal.SIGKILL)
        codes = [os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) for pid in running]
        kills += codes.count(-signal.SIGKILL)
        failed += codes.count(1)
        if 0 in codes:
            ended += 1
            if -signal.SIGKILL in codes:  # it may have outlived the other, whose end did not clean up for it
                failed += os.waitstatus_to_exitcode(os.waitpid(command(folder), 0)[1]) != 0
            wrong += made.snapshot(folder) != whole
            shutil.rmtree(folder)
            if ended % 50 == 0:
                print(f"{kills} kills over {ended} datasets: {wrong} with other bytes, {failed} commands that failed", flush=True)
    return ended, wrong, failed


def main(cuts: int, kills: int) -> int:
    """Do both; report."""
    pa.set_cpu_count(1)
    with tempfile.TemporaryDirectory() as place:
        ended, wrong, failed = kill(kills, Path(place))
    print(f"{kills} kills over {ended} datasets: {wrong} with other bytes, {failed} commands that failed", flush=True)
    if not cuts:
        return bool(wrong or failed)
    start = time.process_time()
    distinct, reported, faults = crashes.run(cuts, say=print_progress)
    print(f"{cuts} power cuts, {distinct} distinct states: {len(faults)} faults, reported instead of recovered: {reported or 0}")
    print(f"{(time.process_time() - start) / max(1, distinct) * 1e3:.0f} ms of CPU a state")
    for fault in faults[:10]:
        print(f"  {fault}")
    return bool(faults or wrong or failed)


def print_progress(number: int, distinct: int, faults: list[str]) -> None:
    """Say how far it is, now and then."""
    if distinct % 1000 == 0:
        print(f"{number + 1} power cuts, {distinct} distinct states, {len(faults)} faults", flush=True)


if __name__ == "__main__":
    given = [int(a) for a in sys.argv[1:3]]
    sys.exit(main(*given, *(100_000, 1_000)[len(given) :]))
