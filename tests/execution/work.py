"""Steps for the tests of pipeline/execution.py: importable by Dask's workers, and a program to interrupt."""

import functools
import os
import signal
import sys
import time
from pathlib import Path

from pipeline.errors import ContentError


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


def nap(folder, job):
    (Path(folder) / f"pid-{os.getpid()}").touch()
    time.sleep(300)
    return job


if __name__ == "__main__":
    from pipeline.execution import map_shards

    signal.signal(signal.SIGINT, signal.default_int_handler)  # what a shell runs in the background inherits that it is ignored
    try:
        list(map_shards(functools.partial(nap, sys.argv[1]), enumerate(range(4)), workers=2))
    except KeyboardInterrupt:
        sys.exit(130)
