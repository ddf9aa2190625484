"""Runs every benchmark in this folder, one after the other: `make bench`, or `python benchmarks/run.py rooms` for some."""

import os
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent


def main(wanted: list[str]) -> int:
    """Run the benchmarks that are named, or all; return how many failed."""
    scripts = {p.stem: p for p in sorted(HERE.glob("*.py")) if p.stem != "run"}
    if unknown := set(wanted) - scripts.keys():
        print(f"sfgen: no benchmark {', '.join(sorted(unknown))}; there are {', '.join(scripts)}", file=sys.stderr)
        return 2
    failed = []
    for name in wanted or scripts:
        print(f"== {name}", flush=True)
        start = time.perf_counter()
        environment = {**os.environ, "PYTHONPATH": str(HERE.parent)}
        if subprocess.run([sys.executable, str(scripts[name])], cwd=HERE.parent, env=environment, check=False).returncode:
            failed.append(name)
        print(f"-- {name}: {time.perf_counter() - start:.0f} s", flush=True)
    if failed:
        print(f"sfgen: {', '.join(failed)} failed; see above", file=sys.stderr)
    return min(1, len(failed))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
