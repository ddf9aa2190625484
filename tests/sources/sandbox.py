"""Read made folders in processes of their own, each with limits of time and memory, and say what it took.

Run as a program it is a server: a line of JSON in, one out. Each reading happens in a fork of it, so that none sees the
memory of another, and nothing has to be imported again.
"""

import json
import os
import resource
import select
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).parents[2]
MIB = 1 << 20
SECONDS, MEMORY = 2.0, 256 * MIB  # what a refusal may take beyond an idle process
HARD_SECONDS, HARD_MEMORY, PATIENCE = 10, 1024 * MIB, 60  # what ends it


class Sandbox:
    """The server as a child of the tests."""

    def __init__(self):
        env = {**os.environ, "OMP_NUM_THREADS": "1", "PYTHONDONTWRITEBYTECODE": "1"}
        self.process = subprocess.Popen(
            [sys.executable, "-m", "tests.sources.sandbox"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=env, cwd=ROOT, text=True
        )

    def read(self, root, **options):
        """Return {rejects, assets, scenes, objects, opened, cpu, memory}, or {died}."""
        self.process.stdin.write(json.dumps({"root": str(root), **options}) + "\n")
        self.process.stdin.flush()
        return json.loads(self.process.stdout.readline())

    def close(self):
        """End the server."""
        self.process.stdin.close()
        self.process.wait(20)


def memory(field):
    """Return a field of /proc/self/status [bytes]."""
    line = next(t for t in Path("/proc/self/status").read_text().splitlines() if t.startswith(field + ":"))
    return int(line.split()[1]) * 1024


def job(request):
    """Read one folder, in the fork."""
    from pipeline.sources.reasons import SourceError
    from tests.sources import reading

    root, opened = os.path.realpath(request["root"]), []

    def audit(event, args):
        if event in {"open", "os.listdir", "os.scandir"} and isinstance(args[0], (str, bytes, os.PathLike)):
            opened.append((os.fsdecode(args[0]), str(args[1]) if event == "open" else "r"))

    idle, size = memory("VmRSS"), memory("VmSize")
    resource.setrlimit(resource.RLIMIT_AS, (size + HARD_MEMORY, size + HARD_MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (HARD_SECONDS, HARD_SECONDS))
    sys.addaudithook(audit)
    start = time.process_time()
    try:
        made = reading.read(root, **{k: v for k, v in request.items() if k != "root"})
        found = {"rejects": made.rejects, "assets": len(made.assets), "scenes": len(made.scenes), "objects": len(made.objects)}
    except SourceError as error:
        found = {
            "rejects": [{"what": "source", "where": error.where, "reason": error.code, "detail": error.detail}],
            "assets": 0,
            "scenes": 0,
            "objects": 0,
        }
    return {**found, "cpu": time.process_time() - start, "memory": memory("VmHWM") - idle, "opened": sorted(set(opened))}


def fork(request):
    """Do a job in a fork; a fork that dies or hangs is an answer too."""
    receive, send = os.pipe()
    pid = os.fork()
    if pid == 0:
        os.close(receive)
        try:
            answer = json.dumps(job(request))
        except BaseException as error:  # noqa: BLE001 - whatever it is, the test shall see it
            answer = json.dumps({"died": f"{type(error).__name__}: {error}"})
        with os.fdopen(send, "w") as out:
            out.write(answer)
        os._exit(0)
    os.close(send)
    chunks, deadline = [], time.monotonic() + PATIENCE
    while time.monotonic() < deadline and select.select([receive], [], [], max(0.0, deadline - time.monotonic()))[0]:
        chunk = os.read(receive, 1 << 16)
        if not chunk:
            break
        chunks.append(chunk)
    else:
        os.kill(pid, 9)
    os.close(receive)
    status = os.waitpid(pid, 0)[1]
    return b"".join(chunks).decode() or json.dumps({"died": f"status {status}"})


def main():
    """Serve."""
    import tempfile

    import trimesh  # noqa: F401 - to load it is no part of what a file costs

    from tests.sources import making, reading

    with tempfile.TemporaryDirectory() as folder:  # the first reading loads tables that the idle process has as well
        making.write_library(Path(folder) / "front", (making.BED,))
        making.write_house(Path(folder) / "front", making.two_rooms())
        making.write_partnet(Path(folder) / "partnet")
        reading.read(folder)
    for line in sys.stdin:
        sys.stdout.write(fork(json.loads(line)).replace("\n", " ") + "\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
