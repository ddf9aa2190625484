"""`sfgen shard` killed with SIGKILL between its first and its last commit, started again, against an undisturbed run.

    python benchmarks/resume.py [homes] [workers]

Says how long both take, checks that they are equal byte for byte, and that no committed shard was touched.
"""

import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def start(folder: Path, homes: int, workers: int) -> subprocess.Popen[bytes]:
    """Start `sfgen shard` in a session of its own."""
    command = [
        sys.executable,
        "-m",
        "sfgen.cli",
        "shard",
        "--count",
        str(homes),
        "--seed",
        "11",
        "--workers",
        str(workers),
        "--out",
        str(folder),
    ]
    return subprocess.Popen(command, cwd=ROOT, start_new_session=True)


def stamps(folder: Path) -> dict[str, tuple[int, int]]:
    """Time and place of every file of the committed shards."""
    names = [c.stem for c in folder.glob("commits/shard-*.json")]
    files = [
        p
        for p in folder.rglob("*")
        if p.is_file() and not {".parts", ".claims", ".staging"} & {*p.parts} and any(n in p.relative_to(folder).as_posix() for n in names)
    ]
    return {p.relative_to(folder).as_posix(): (p.stat().st_mtime_ns, p.stat().st_ino) for p in files}


def content(folder: Path) -> dict[str, bytes]:
    """Every file's bytes."""
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def main(homes: int, workers: int) -> int:
    """Run both, compare, report."""
    with tempfile.TemporaryDirectory() as place:
        whole, cut = Path(place) / "whole", Path(place) / "cut"
        began = time.perf_counter()
        if start(whole, homes, workers).wait():
            return 1
        undisturbed = time.perf_counter() - began
        shards = len(list(whole.glob("commits/shard-*.json")))
        began = time.perf_counter()
        run = start(cut, homes, workers)
        while not list(cut.glob("commits/shard-*.json")) and run.poll() is None:
            time.sleep(0.05)
        os.killpg(run.pid, signal.SIGKILL)
        run.wait()
        before = stamps(cut)
        kept = len(list(cut.glob("commits/shard-*.json")))
        if not 0 < kept < shards:
            print(f"killed with {kept} of {shards} shards committed: give more homes")
            return 1
        if start(cut, homes, workers).wait():
            return 1
        resumed = time.perf_counter() - began
        equal = content(whole) == content(cut)
        after = stamps(cut)
        touched = [name for name, stamp in before.items() if after.get(name) != stamp]
        size = sum(map(len, content(whole).values())) / 1e6
        print(
            f"{homes} homes, {shards} shards, {size:.1f} MB, {workers} workers: {undisturbed:.1f} s undisturbed ({undisturbed / homes:.2f} s a home),"
        )
        print(f"{resumed:.1f} s killed after {kept} commits and resumed; same bytes: {equal}; committed files touched: {len(touched)}")
        return 0 if equal and not touched else 1


if __name__ == "__main__":
    sys.exit(main(*map(int, (sys.argv[1:] + ["200", "2"][len(sys.argv) - 1 :])[:2])))
