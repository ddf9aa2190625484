"""Reading whole sources: one task per model, object or house, spread over processes, results in the sources' order.

Each task has a budget. What a file costs that exceeds it is that file: its process goes on, or another takes its place.
"""

import functools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from pipeline.execution.pool import run_on_processes
from pipeline.execution.queue import Lost, Queue
from pipeline.sources.budget import Budget, OutOfTimeError, enforce
from pipeline.sources.reasons import SourceError

T = TypeVar("T")
R = TypeVar("R")
M = TypeVar("M")
SILENCE = 1800.0  # seconds without an answer: a file on a disk that hangs costs no processor time


@dataclass(frozen=True, slots=True)
class Batch(Generic[T, R, M]):
    """Things to be read one by one: `step(common, item)` of each, or `refused(item, reason, detail)` of what it could not read or may not cost.

    `common` is sent to each process once. `unit` is what a person calls an item.
    """

    unit: str
    step: Callable[[T, R], M]
    common: T
    items: Sequence[R]
    refused: Callable[[R, str, str], M]

    def read(self, item: R) -> M:
        """Read an item here and now, without a budget."""
        return self.result(item, _read(self.step, self.common, item))

    def result(self, item: R, outcome: Any) -> M:
        """Return what stands for an item of which that came."""
        return self.refused(item, outcome.reason, outcome.detail) if isinstance(outcome, _Refusal) else outcome


@dataclass(frozen=True, slots=True)
class _Refusal:
    """Stands for the result of an item that cannot be read, or that used up its budget."""

    reason: str
    detail: str


def _read(step: Callable[[T, R], M], common: T, item: R) -> M | _Refusal:
    try:
        return step(common, item)
    except SourceError as error:
        return _Refusal(error.code, f"{error.where}: {error.detail}")
    except MemoryError:
        raise  # the budget's business
    except Exception as error:  # noqa: BLE001 - one bad file of thousands must not end the run; the table tells
        return _Refusal("internal", f"{type(error).__name__}: {error}")


def _read_within(budget: Budget, step: Callable[[T, R], M], common: T, job: tuple[int, R]) -> M | _Refusal:
    """Read one item within a budget, in a worker."""
    try:
        with enforce(budget):
            return _read(step, common, job[1])
    except OutOfTimeError:
        return _Refusal("out_of_time", f"{budget.seconds:g} s of processor time")
    except MemoryError:
        return _Refusal("out_of_memory", f"{budget.mebibytes} MiB")


def each(batch: Batch[T, R, M], workers: int, budget: Budget) -> Iterator[M]:
    """Yield what comes of each item, in order. Everything is read in processes of its own, with one worker too."""
    early: dict[int, M] = {}
    step = functools.partial(_read_within, budget, batch.step, batch.common)
    jobs = Queue(enumerate(batch.items), None)
    count = max(1, min(workers, len(batch.items)))
    following = 0
    for (number, item), outcome in run_on_processes(step, jobs, count, None, SILENCE, preload="pipeline.sources.registry"):
        died = isinstance(outcome, Lost) and _Refusal("reader_died", f"{outcome.times} times, out of memory perhaps")
        early[number] = batch.result(item, died or outcome)
        while following in early:
            yield early.pop(following)
            following += 1
