"""Jobs that wait for workers, and what becomes of those that take their workers with them."""

from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Generic, TypeVar

J = TypeVar("J")
Split = Callable[[J], list[J]]

STRIKES = 3  # workers that one job may take with it before it is given up


@dataclass(frozen=True, slots=True)
class Lost:
    """Stands for the result of a job that was given up: `times` workers died at it, or kept silent (`how`)."""

    how: str
    times: int


@dataclass(frozen=True, slots=True)
class Task(Generic[J]):
    """A job, and how many workers it has cost."""

    job: J
    strikes: int = 0


class Queue(Generic[J]):
    """Jobs in their order, drawn as they are needed; those that a worker died of come back first, in pieces where they can be split."""

    def __init__(self, jobs: Iterable[J], split: Split[J] | None) -> None:
        self._jobs, self._split = iter(jobs), split
        self._again: deque[Task[J]] = deque()

    def next(self) -> Task[J] | None:
        """Return what is to be done next, None when there is nothing (what is at work may still come back)."""
        if self._again:
            return self._again.popleft()
        return next((Task(job) for job in self._jobs), None)

    def put_back(self, task: Task[J]) -> None:
        """Give a task back that was not begun."""
        self._again.appendleft(task)

    @property
    def suspects(self) -> bool:
        """Whether something waits that a worker died of."""
        return any(task.strikes for task in self._again)

    def strike(self, task: Task[J], how: str) -> Lost | None:
        """Take back a task that cost a worker: in pieces, once more, or (returned) not again."""
        strikes = task.strikes + 1
        pieces = self._split(task.job) if self._split else []
        if len(pieces) > 1:
            self._again.extend(Task(piece, min(strikes, STRIKES - 1)) for piece in pieces)
        elif strikes < STRIKES:
            self._again.append(Task(task.job, strikes))
        else:
            return Lost(how, strikes)
        return None
