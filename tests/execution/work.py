"""Steps for the tests of pipeline/execution.py: importable by Dask's workers, and a program to interrupt."""

import functools
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


def hang_at_two(job):
    if job == 2:
        time.sleep(600)
    return job


def whisper(job):
    for part in range(4):
        tell("part", job, part)
        time.sleep(0.7)
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
