"""Maps a step over shards: in this process, on a local Dask cluster, or on a Dask scheduler that the user names.

Knows nothing of the work. A step gets one shard's job and returns its result; the caller keeps the results as they
come. SLURM, Kubernetes and SSH clusters are started with Dask's own launchers; what they yield is an address.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from itertools import islice
from typing import Any, TypeVar

from pipeline.errors import ContentError, SfgenError, UsageError

J = TypeVar("J")
R = TypeVar("R")

THREADS = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS")
RETRIES = 2  # of a step that raised something that is not ours: a network disk that hiccups
DEATHS = 3  # of a worker at one shard, before that shard is blamed
IN_FLIGHT = 2  # shards per worker: one at work, one waiting
PATIENCE = "20s"  # with a scheduler that does not answer
QUIET = 30.0  # seconds between two lines of progress where there is no terminal


def map_shards(
    step: Callable[[J], R],
    shards: Iterable[tuple[int, J]],
    *,
    digest: str = "",
    workers: int = 1,
    scheduler: str | None = None,
    memory: str = "4GiB",
) -> Iterator[tuple[int, R]]:
    """Yield (shard, result) as shards complete, in any order. `shards` are (number, job) pairs, drawn as they are needed.

    `workers` <= 1 without `scheduler` runs here, one after the other. Otherwise `step` and the jobs are pickled: keep
    them small, pass seeds and paths. `memory` limits each local worker. `digest` names the work, so that a scheduler
    that others use too never confuses two runs. Every mode computes with one thread per worker: two torch threads on
    two busy cores are slower, and sums must not depend on the number of workers.
    Raises what the step raises (SfgenError at once, others after retries), ContentError for a shard that kills its
    workers, UsageError for a scheduler that does not answer. Closing the iterator stops all work.
    """
    if scheduler is None and workers <= 1:
        single_thread()
        for number, job in shards:
            yield number, step(job)
        return
    with _client(workers, scheduler, memory) as client:
        count = workers if scheduler is None else max(1, len(client.scheduler_info()["workers"]))
        yield from _consume(client, step, iter(shards), digest, IN_FLIGHT * count)


def _consume(client: Any, step: Callable[[J], R], shards: Iterator[tuple[int, J]], digest: str, window: int) -> Iterator[tuple[int, R]]:
    """Keep `window` shards in flight; take each result and let go of it, so that no dead worker makes it be recomputed."""
    from distributed import as_completed
    from distributed.scheduler import KilledWorker

    numbers: dict[str, int] = {}

    def submit(number: int, job: J) -> Any:
        future = client.submit(_guarded, step, job, key=f"shard-{digest[:16]}-{number}", retries=RETRIES, pure=True)
        numbers[future.key] = number
        return future

    completed = as_completed([submit(*pair) for pair in islice(shards, window)], loop=client.loop)
    for future in completed:
        number = numbers.pop(future.key)
        try:
            answer = future.result()
        except KilledWorker as error:
            remedy = "give it more memory (fewer --workers), or look at the log of its workers"
            raise ContentError(f"shard {number} killed its worker {DEATHS + 1} times", remedy) from error
        future.release()
        if isinstance(answer, SfgenError):
            raise answer
        for pair in islice(shards, 1):
            completed.add(submit(*pair))
        yield number, answer


def _guarded(step: Callable[[J], R], job: J) -> R | SfgenError:
    """Run the step. Our own errors are answers: the same input fails again, so Dask shall not retry it."""
    single_thread()
    try:
        return step(job)
    except SfgenError as error:
        return error


def single_thread() -> None:
    """Make numeric libraries of this process use one thread, those that are loaded already and those that come."""
    for name in THREADS:
        os.environ[name] = "1"
    torch = sys.modules.get("torch")
    if torch is not None and torch.get_num_threads() != 1:
        torch.set_num_threads(1)


@contextmanager
def _client(workers: int, scheduler: str | None, memory: str) -> Iterator[Any]:
    """Give a Dask client: of the scheduler at that address or in that file, or of a local cluster of processes."""
    import dask
    from distributed import Client, LocalCluster

    quiet = {
        "distributed.scheduler.allowed-failures": DEATHS,
        "distributed.worker.daemon": True,
        "distributed.admin.log-format": "%(name)s: %(message)s",
        "distributed.comm.timeouts.connect": PATIENCE,
    }
    with dask.config.set(quiet):
        if scheduler is not None:
            where: dict[str, Any] = {"address": scheduler} if "://" in scheduler else {"scheduler_file": scheduler}
            if "scheduler_file" in where and not os.path.isfile(scheduler):  # noqa: PTH113 - a plain test of the user's text
                raise UsageError(
                    f"the scheduler {scheduler!r} is neither an address nor a file", "give tcp://host:port or a scheduler file"
                )
            try:
                client = Client(**where, timeout=PATIENCE, set_as_default=False)
            except (OSError, ValueError, TimeoutError) as error:
                raise UsageError(f"no Dask scheduler answers at {scheduler}", "start one, or leave --scheduler out") from error
            with client:
                _require_workers(client, scheduler)
                yield client
            return
        with (
            LocalCluster(
                n_workers=workers,
                threads_per_worker=1,
                processes=True,
                memory_limit=memory,
                dashboard_address=None,
                # Dask serves HTTP even so: on any free port, of this machine only
                scheduler_kwargs={"dashboard_address": "127.0.0.1:0"},
                worker_dashboard_address="127.0.0.1:0",
                silence_logs="ERROR",
            ) as cluster,
            Client(cluster, set_as_default=False) as client,
        ):
            client.register_worker_callbacks(_deafen)
            yield client


def _require_workers(client: Any, scheduler: str) -> None:
    try:
        client.wait_for_workers(1, timeout=60)
    except (TimeoutError, OSError) as error:
        raise UsageError(f"the Dask scheduler at {scheduler} has no workers", "start some with `dask worker`") from error


def _deafen(dask_worker: Any) -> None:  # noqa: ARG001 - Dask passes its worker
    """Leave Ctrl-C to the main process: the terminal sends it to the workers too, which would die noisily."""
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGINT, signal.SIG_IGN)


def track(items: Iterable[J], total: int, label: str, *, unit: str = "home", size: Callable[[J], int] = lambda _item: 1) -> Iterator[J]:
    """Pass `items` on, showing on stderr how many of `total` units are done and the time left.

    A bar on a terminal, a plain line every half minute elsewhere (DVC's log, CI).
    """
    if sys.stderr.isatty():
        from tqdm import tqdm

        with tqdm(total=total, desc=label, unit=unit, file=sys.stderr, dynamic_ncols=True, smoothing=0.1) as bar:
            for item in items:
                bar.update(size(item))
                yield item
        return
    start = last = time.monotonic()
    done = 0
    for item in items:
        done += size(item)
        now = time.monotonic()
        if now - last >= QUIET and done:
            last = now
            left = (now - start) / done * (total - done)
            sys.stderr.write(f"{label}: {done} of {total} {unit}s, {_clock(now - start)} gone, {_clock(left)} left\n")
            sys.stderr.flush()
        yield item


def _clock(seconds: float) -> str:
    return f"{int(seconds) // 60}:{int(seconds) % 60:02d}"
