"""Jobs on a Dask scheduler that the user names. SLURM, Kubernetes and SSH clusters are started with Dask's own launchers; what they yield is an address."""

import logging
import os
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

from distributed.diagnostics.plugin import Environ

from pipeline.errors import ContentError, SfgenError, UsageError
from pipeline.execution.machine import PINNED, single_thread
from pipeline.execution.queue import Lost, Queue, Task

J = TypeVar("J")
R = TypeVar("R")

RETRIES = 2  # of a step that raised something that is not ours: a network disk that hiccups
IN_FLIGHT = 2  # jobs per thread of the cluster: one at work, one waiting
PATIENCE = "20s"  # with a scheduler that does not answer
FIRST = 60.0  # seconds until a scheduler has its first worker


def run_on_cluster(step: Callable[[J], R], queue: Queue[J], scheduler: str) -> Iterator[tuple[J, R | Lost]]:
    """Run the queue's jobs; what is in flight follows the size of the cluster, so that workers who come late find work.

    Each result is taken and let go of, so that no dead worker makes it be computed again.
    """
    from distributed import as_completed
    from distributed.comm.core import CommClosedError
    from distributed.scheduler import KilledWorker

    with _client(scheduler) as client:
        tasks: dict[str, Task[J]] = {}
        completed = as_completed([], loop=client.loop)

        def refill() -> None:
            # a dead worker's waiting jobs are blamed with the one at work: while there are suspects, none waits at a worker
            each = 1 if queue.suspects or any(t.strikes for t in tasks.values()) else IN_FLIGHT
            window = each * max(1, sum(client.nthreads().values()))
            while len(tasks) < window and (task := queue.next()):
                future = client.submit(_try_step, step, task.job, retries=RETRIES, pure=False)
                tasks[future.key] = task
                completed.add(future)

        try:
            refill()
            for future in completed:
                task = tasks.pop(future.key)
                answers: list[Any] = []
                try:
                    answers.append(future.result())
                except KilledWorker:
                    answers += filter(None, [queue.strike(task, "died")])
                future.release()
                refill()
                for answer in answers:
                    if isinstance(answer, SfgenError):
                        raise answer
                    yield task.job, answer
        except (CancelledError, CommClosedError, TimeoutError) as error:
            raise ContentError(f"the Dask scheduler at {scheduler} is gone", "start it, then the same command again: it resumes") from error


class SameInstructions(Environ):  # type: ignore[misc]  # distributed has no types
    """Starts workers again that numeric libraries give other instructions than the command: NumPy is loaded before a worker's first job."""

    def __init__(self) -> None:
        super().__init__({name: os.environ[name] for name in PINNED if name in os.environ})

    async def setup(self, nanny: Any) -> None:
        """Take note of whether the worker has to be started again, and give it the command's settings. Called where a worker is, and where one joins."""
        there = {**os.environ, **nanny.pre_spawn_env}
        self.restart = any(there.get(name) != value for name, value in self.environ.items())
        nanny.pre_spawn_env.update(self.environ)


def _try_step(step: Callable[[J], R], job: J) -> R | SfgenError:
    """Run the step. Our own errors are answers: the same input fails again, so Dask shall not retry it."""
    single_thread()
    try:
        return step(job)
    except SfgenError as error:
        return error


@contextmanager
def _client(scheduler: str) -> Iterator[Any]:
    """Give a Dask client of the scheduler at that address or in that file."""
    import dask
    from distributed import Client

    where: dict[str, Any] = {"address": scheduler} if "://" in scheduler else {"scheduler_file": scheduler}
    if "scheduler_file" in where and not Path(scheduler).is_file():
        raise UsageError(f"the scheduler {scheduler!r} is neither an address nor a file", "give tcp://host:port or a scheduler file")
    for name in ("distributed", "tornado"):
        logging.getLogger(name).setLevel(logging.CRITICAL)  # what goes wrong is said in one line, by us
    with dask.config.set({"distributed.comm.timeouts.connect": PATIENCE}):
        try:
            client = Client(**where, timeout=PATIENCE, set_as_default=False)
        except (TypeError, RuntimeError) as error:  # tls:// without certificates; tcp:// where encryption is required
            raise UsageError(
                f"the Dask scheduler at {scheduler} cannot be spoken to as this machine is set up ({str(error).splitlines()[0][:200]})",
                "give the certificates in Dask's settings (distributed.comm.tls: ca-file, client.cert, client.key)",
            ) from error
        except (OSError, ValueError, TimeoutError) as error:
            raise UsageError(f"no Dask scheduler answers at {scheduler}", "start one, or leave --scheduler out") from error
        with client:
            try:
                client.wait_for_workers(1, timeout=FIRST)
                client.register_plugin(SameInstructions(), name="sfgen-instructions")
                client.wait_for_workers(1, timeout=FIRST)  # which it may have started again
            except (TimeoutError, OSError) as error:
                raise UsageError(f"the Dask scheduler at {scheduler} has no workers", "start some with `dask worker`") from error
            yield client
