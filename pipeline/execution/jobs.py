"""map_jobs: one interface to this process, to local processes and to a Dask cluster; what becomes of jobs that take their workers with them."""

from collections.abc import Callable, Generator, Iterable, Iterator
from typing import TypeVar, overload

from pipeline.errors import ContentError
from pipeline.execution.machine import single_thread
from pipeline.execution.messages import Note, listen
from pipeline.execution.queue import Lost, Queue, Split

J = TypeVar("J")
R = TypeVar("R")
SILENCE = 600.0  # seconds without a word or a result after which a worker counts as stuck


@overload
def map_jobs(
    step: Callable[[J], R],
    jobs: Iterable[J],
    *,
    workers: int = ...,
    scheduler: str | None = ...,
    note: Callable[[Note], object] | None = ...,
) -> Generator[tuple[J, R]]: ...
@overload
def map_jobs(
    step: Callable[[J], R],
    jobs: Iterable[J],
    *,
    workers: int = ...,
    scheduler: str | None = ...,
    split: Split[J],
    note: Callable[[Note], object] | None = ...,
    silence: float = ...,
) -> Generator[tuple[J, R | Lost]]: ...
def map_jobs(
    step: Callable[[J], R],
    jobs: Iterable[J],
    *,
    workers: int = 1,
    scheduler: str | None = None,
    split: Split[J] | None = None,
    note: Callable[[Note], object] | None = None,
    silence: float = SILENCE,
) -> Generator[tuple[J, R | Lost]]:
    """Yield (job, result) as jobs complete, in any order; jobs are drawn as they are needed.

    `workers` <= 1 without `scheduler` runs here, one after the other, and starts no other process. Otherwise `step` and the
    jobs are pickled: keep them small, pass seeds and paths. Every mode computes with one thread per worker: two torch
    threads on two busy cores are slower, and sums must not depend on the number of workers. `note` hears what the step tells.

    A job that takes its worker with it (or keeps it silent for `silence` seconds) comes again, in the pieces that `split`
    makes of it; what has cost STRIKES workers and cannot be split yields a Lost, or raises ContentError where there is no `split`.
    Raises what the step raises; UsageError for a scheduler that does not answer. Closing the iterator stops all work.
    """
    queue = Queue(jobs, split)
    if scheduler is not None:
        from pipeline.execution.cluster import run_on_cluster

        done = run_on_cluster(step, queue, scheduler)
    elif workers > 1:
        from pipeline.execution.pool import run_on_processes

        done = run_on_processes(step, queue, workers, note, silence)
    else:
        done = _run_here(step, queue, note)
    for job, result in done:
        if isinstance(result, Lost) and split is None:
            raise ContentError(
                f"a job {'killed' if result.how == 'died' else 'kept silent and cost'} {result.times} workers ({str(job)[:100]})",
                "give it more memory (fewer --workers), or look at the log of its workers",
            )
        yield job, result


def _run_here(step: Callable[[J], R], queue: Queue[J], note: Callable[[Note], object] | None) -> Iterator[tuple[J, R]]:
    single_thread()
    listen(note)
    try:
        while task := queue.next():
            yield task.job, step(task.job)
    finally:
        listen(None)
