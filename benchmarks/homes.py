"""What a home costs, part by part, with the trained model of this checkout: many in one process, and the first of a new one.

    python benchmarks/homes.py [homes]

Needs what `make run` leaves: data/ and models/.
"""

import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PROMPT = "a two-bedroom apartment with an open kitchen"


def homes(count: int) -> None:
    """Make homes from the prior, in batches as `sfgen shard` does, and print CPU seconds by part."""
    from pipeline.homes.factory import open_factory
    from pipeline.homes.life import Outcome
    from pipeline.homes.request import Request

    factory = open_factory(ROOT, 17)
    factory.make([Request(10_000)])  # compiles, and reads the first assets
    factory.seconds.clear()
    start = time.perf_counter()
    successes = []
    for first in range(0, count, factory.chunk):
        outcomes = factory.make([Request(i) for i in range(first, min(first + factory.chunk, count))])
        successes += [outcome for outcome in outcomes if isinstance(outcome, Outcome)]
    wall = time.perf_counter() - start
    total = sum(factory.seconds.values())
    print(f"{count} homes, one process, {wall:.1f} s; CPU seconds per home:")
    for part, seconds in factory.seconds.items():
        print(f"  {part:10s} {seconds / count:8.3f}")
    print(f"  {'all':10s} {total / count:8.3f}")
    print(f"memory, at most: {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MiB")
    rooms = sum(len(o.rows["rooms"]) for o in successes)
    tries = sum(row["attempts"] for o in successes for row in o.rows["scenes"])
    size = sum(len(data) for o in successes for data in o.files.values()) / 1e6
    print(f"{rooms / total:.2f} rooms per CPU second, {tries / count:.1f} tries of rooms per home, {size / count:.2f} MB of files per home")


def first_home() -> None:
    """Print what `sfgen generate` costs, from the start of the process; kernels are compiled already.

    So is the bytecode of all modules, which installers write: a first run puts it into a folder of its own, for environments that lack it.
    """
    with tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "PYTHONPYCACHEPREFIX": f"{folder}/bytecode"}
        environment.pop("PYTHONDONTWRITEBYTECODE", None)
        for home in ("first", "second"):
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            subprocess.run(
                [sys.executable, "-m", "sfgen.cli", "generate", PROMPT, "--out", f"{folder}/{home}"],
                check=True,
                cwd=ROOT,
                env=environment,
                stdout=subprocess.DEVNULL,
            )
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"sfgen generate, from a cold start: {after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime:.2f} CPU s")


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    if not (ROOT / "models" / "denoiser.safetensors").is_file():
        sys.exit("sfgen: there are no trained weights; type `make run` first")
    homes(int(sys.argv[1]) if len(sys.argv) > 1 else 8)
    first_home()
