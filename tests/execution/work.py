"""Steps for the tests of pipeline/execution.py: importable by Dask's workers, and a program to interrupt."""

import atexit
import functools
import json
import os
import signal
import sys
import time
from pathlib import Path

from pipeline.errors import ContentError
from pipeline.execution import tell


def square(job):
    return job * job


def threads(_job):
    import torch

    return os.getpid(), os.environ["OMP_NUM_THREADS"], torch.get_num_threads()


def refuse_third(job):
    if job == 3:
        raise ContentError("the third shard is bad", "leave it out")
    return job


def count_and_raise(folder, job):
    with (Path(folder) / f"{job}-{time.monotonic_ns()}").open("x"):
        pass
    raise OSError("the network disk hiccups")


def die_once(folder, job):
    mark = Path(folder) / f"died-{job}"
    if job == 2 and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return job


def die_always(_job):
    os.kill(os.getpid(), signal.SIGKILL)


def die_of_seven(mark, jobs):
    """Several numbers in one job; 7 takes the worker with it."""
    with (Path(mark) / "begun").open("a") as begun:
        begun.write(f"{list(jobs)}\n")
    if 7 in jobs:
        os.kill(os.getpid(), signal.SIGKILL)
    return sum(jobs)


def be_told_twice_to_leave(job):
    atexit.register(os.kill, os.getpid(), signal.SIGTERM)
    return job


def hang_at_two(job):
    if job == 2:
        time.sleep(600)
    return job


def whisper(job):
    for part in range(4):
        tell("part", job, part)
    return job


class StubbornError(Exception):
    """Cannot be made from its own arguments: does not survive pickling."""

    def __init__(self, code, text):
        super().__init__(f"{code} {text}")


def raise_stubborn(_job):
    raise StubbornError(5, "does not travel")


def where(job):
    return job, os.getpid()


def doze(job):
    time.sleep(0.3)
    return job, os.getpid()


def ports():
    """The sockets of this process and its descendants that wait for somebody."""
    lines = [line.split() for name in ("tcp", "tcp6") for line in Path(f"/proc/net/{name}").read_text().splitlines()[1:]]
    waiting = {f"socket:[{f[9]}]": f[1] for f in lines if f[3] == "0A"}
    parents = {int(p.parent.name): int(told.rpartition(")")[2].split()[1]) for p in Path("/proc").glob("[0-9]*/stat") if (told := _read(p))}
    ours = {os.getpid()}
    while more := {pid for pid, parent in parents.items() if parent in ours} - ours:
        ours |= more
    held = [_link(link) for pid in ours for link in Path(f"/proc/{pid}/fd").glob("*")]
    return sorted(waiting[name] for name in held if name in waiting)


def _read(path):
    try:
        return path.read_text()
    except OSError:  # the process has ended
        return ""


def _link(path):
    try:
        return str(path.readlink())
    except OSError:
        return ""


def tell_ports():
    """Tell which ports are open before a run, during it, and when one is opened; and whether others did the work."""
    import socket

    from pipeline.execution import map_jobs

    before = ports()
    run = map_jobs(where, range(40), workers=2)
    pids = {pid for _, (_, pid) in (next(run) for _ in range(30))}
    during = ports()
    run.close()
    with socket.create_server(("127.0.0.1", 0)):
        sys.stdout.write(json.dumps([before, during, len(ports()), os.getpid() in pids]))


def litter(_job):
    import tempfile

    Path(tempfile.mkdtemp()).joinpath("half").touch()
    return tempfile.gettempdir()


def nap(folder, job):
    (Path(folder) / f"pid-{os.getpid()}").touch()
    time.sleep(300)
    return job


if __name__ == "__main__":
    from pipeline.execution import map_jobs

    signal.signal(signal.SIGINT, signal.default_int_handler)  # what a shell runs in the background inherits that it is ignored
    try:
        list(map_jobs(functools.partial(nap, sys.argv[1]), range(4), workers=2))
    except KeyboardInterrupt:
        sys.exit(130)
