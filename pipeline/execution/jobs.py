"""map_jobs: one interface to this process, to local processes and to a Dask cluster; what becomes of jobs that take their workers with them."""

from collections.abc import Callable, Generator, Iterable, Iterator
from typing import TypeVar

from pipeline.errors import ContentError
from pipeline.execution.machine import single_thread
from pipeline.execution.progress import Note, listen
from pipeline.execution.queue import Lost, Queue, Split

J = TypeVar("J")
R = TypeVar("R")
SILENCE = 600.0  # seconds without a word or a result after which a worker counts as stuck


def map_jobs(
    step: Callable[[J], R],
    jobs: Iterable[J],
    *,
    workers: int = 1,
    scheduler: str | None = None,
    note: Callable[[Note], object] | None = None,
) -> Generator[tuple[J, R]]:
    """Yield (job, result) as jobs complete, in any order; jobs are drawn as they are needed.

    `workers` <= 1 without `scheduler` runs here, one after the other, and starts no other process. Otherwise `step` and the
    jobs are pickled: keep them small, pass seeds and paths. Every mode computes with one thread per worker: two torch
    threads on two busy cores are slower, and sums must not depend on the number of workers. `note` hears what the step tells.

    Raises what the step raises; ContentError for a job that takes STRIKES workers with it; UsageError for a scheduler that does not
    answer. Closing the iterator stops all work.
    """
    for job, result in map_divisible(step, jobs, None, workers=workers, scheduler=scheduler, note=note):
        if isinstance(result, Lost):
            raise ContentError(
                f"a job {'killed' if result.how == 'died' else 'kept silent and cost'} {result.times} workers ({str(job)[:100]})",
                "give it more memory (fewer --workers), or look at the log of its workers",
            )
        yield job, result


def map_divisible(
    step: Callable[[J], R],
    jobs: Iterable[J],
    split: Split[J] | None,
    *,
    workers: int = 1,
    scheduler: str | None = None,
    note: Callable[[Note], object] | None = None,
    silence: float = SILENCE,
) -> Generator[tuple[J, R | Lost]]:
    """Yield (job, result) as `map_jobs` does, of jobs that are `split` where they take their worker with them.

    Such a job, or one that keeps its worker silent for `silence` seconds, comes again in pieces; what has cost STRIKES workers and
    cannot be split yields a Lost.
    """
    queue = Queue(jobs, split)
    if scheduler is not None:
        from pipeline.execution.cluster import run_on_cluster

        yield from run_on_cluster(step, queue, scheduler)
    elif workers > 1:
        from pipeline.execution.pool import run_on_processes

        yield from run_on_processes(step, queue, workers, note, silence)
    else:
        yield from _run_here(step, queue, note)


def _run_here(step: Callable[[J], R], queue: Queue[J], note: Callable[[Note], object] | None) -> Iterator[tuple[J, R]]:
    single_thread()
    listen(note)
    try:
        while task := queue.next():
            yield task.job, step(task.job)
    finally:
        listen(None)
