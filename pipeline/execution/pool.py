"""Jobs on processes of this machine, over pipes: no port is opened, and a worker that dies or keeps silent is replaced."""

import functools
import multiprocessing
import os
import signal
import sys
import tempfile
import threading
import time
import traceback
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from multiprocessing.reduction import ForkingPickler
from typing import Any, NoReturn, TypeVar

from pipeline.errors import ContentError
from pipeline.execution.machine import single_thread
from pipeline.execution.progress import Note, listen
from pipeline.execution.queue import STRIKES, Lost, Queue, Task

J = TypeVar("J")
R = TypeVar("R")

READY, NOTE, DONE, FAILED = "ready", "note", "done", "failed"
START = 120.0  # seconds that a worker may take to import what it needs
GOODBYE = 5.0  # seconds in which a worker that is told to stop may tidy up


@dataclass
class _Worker:
    """A process and what it is at; `heard` is when it last said something (monotonic seconds)."""

    process: Any
    pipe: Connection
    task: Task[Any] | None = None
    heard: float = 0.0
    ready: bool = False

    def give(self, task: Task[Any]) -> bool:
        """Send a task; False when the process is gone."""
        try:
            self.pipe.send(task.job)
        except OSError:
            return False
        self.task, self.heard = task, time.monotonic()
        return True

    def stop(self, *, patience: float = GOODBYE) -> None:
        """End the process: politely, so that it removes its temporary files, then at once."""
        self.pipe.close()
        self.process.terminate()
        self.process.join(patience)
        if self.process.is_alive():
            self.process.kill()
            self.process.join()


def run_on_processes(
    step: Callable[[J], R],
    queue: Queue[J],
    workers: int,
    note: Callable[[Note], object] | None,
    silence: float,
    *,
    preload: str = "",
) -> Iterator[tuple[J, R | Lost]]:
    """Run the queue's jobs on `workers` processes; each gets its next job before the result of its last is handed on.

    `preload` is the module with all that a worker needs; left out, it is the one that the step is written in.
    """
    crew: list[_Worker] = []
    stillborn = 0  # workers in a row that died before they could begin
    with tempfile.TemporaryDirectory(prefix="sfgen-") as scratch:  # what a killed worker leaves behind goes with it
        recruit = functools.partial(_start, _context(preload or _module(step)), step, scratch)
        try:
            while _employ(crew, queue, recruit, workers):
                for worker in _await_workers(crew, silence):
                    task = worker.task
                    kind, answer = _message(worker)
                    if kind in {READY, NOTE}:
                        stillborn = 0
                        if kind == NOTE and note:
                            note(answer)
                        continue
                    assert task is not None
                    worker.task = None
                    if kind == FAILED:
                        raise answer
                    if kind == DONE:
                        _employ(crew, queue, recruit, workers)
                        yield task.job, answer
                        continue
                    crew.remove(worker)
                    worker.stop(patience=0.0)
                    if worker.ready:
                        lost = queue.strike(task, kind)
                        if lost:
                            yield task.job, lost
                        continue
                    queue.put_back(task)
                    stillborn += 1
                    if stillborn == STRIKES:
                        raise ContentError("the worker processes do not start", "run it with --workers 1, which says why")
        finally:
            for worker in crew:
                worker.pipe.close()
                worker.process.terminate()
            for worker in crew:
                worker.stop()


def _employ(crew: list[_Worker], queue: Queue[J], recruit: Callable[[], _Worker], workers: int) -> bool:
    """Give every idle worker a task, and start more while there is more to do; False when nothing is at work."""
    idle = [worker for worker in crew if worker.task is None]
    while (idle or len(crew) < workers) and (task := queue.next()):
        if not idle:
            crew.append(recruit())
            idle.append(crew[-1])
        worker = idle.pop()
        if not worker.give(task):  # it died while it had nothing to do
            crew.remove(worker)
            worker.stop(patience=0.0)
            queue.put_back(task)
    return any(worker.task for worker in crew)


def _context(preload: str) -> Any:
    """Return how workers start: from a server that has imported `preload` once, anew where there is none (Windows).

    Never as copies of this process: one with threads of torch and Arrow in it may hang.
    """
    if "forkserver" not in multiprocessing.get_all_start_methods():
        return multiprocessing.get_context("spawn")
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload([preload])
    return context


def _module(step: Callable[..., object]) -> str:
    while isinstance(step, functools.partial):
        step = step.func
    return step.__module__


def _start(context: Any, step: Callable[[J], R], scratch: str) -> _Worker:
    ours, theirs = context.Pipe()
    process = context.Process(target=_serve, args=(theirs, step, scratch), daemon=True)
    process.start()
    theirs.close()  # so that the death of the process ends the pipe
    return _Worker(process, ours)


def _await_workers(crew: list[_Worker], silence: float) -> list[_Worker]:
    """Wait until a busy worker says something, dies or has been silent for too long; return those."""
    busy = {worker.pipe: worker for worker in crew if worker.task}
    until = min(worker.heard + _patience(worker, silence) for worker in busy.values())
    spoken = wait(list(busy), max(0.0, until - time.monotonic()))
    now = time.monotonic()
    return [worker for pipe, worker in busy.items() if pipe in spoken or now - worker.heard >= _patience(worker, silence)]


def _patience(worker: _Worker, silence: float) -> float:
    return silence if worker.ready else max(silence, START)


def _message(worker: _Worker) -> tuple[str, Any]:
    """Return what a worker says; ("died", None) or ("hung", None) where it says nothing."""
    if not worker.pipe.poll():
        return "hung", None
    try:
        kind, answer = worker.pipe.recv()
    except (EOFError, OSError):
        return "died", None
    worker.heard = time.monotonic()
    worker.ready = True
    return kind, answer


# -- in the worker -------------------------------------------------------------------------------------------------------


def _serve(pipe: Connection, step: Callable[[J], R], scratch: str) -> None:
    """Answer jobs until the pipe ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the terminal sends Ctrl-C to all; the main process decides
    signal.signal(signal.SIGTERM, _leave)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    tempfile.tempdir = scratch
    single_thread()
    listen(lambda note: pipe.send((NOTE, note)))
    try:
        pipe.send((READY, None))
        while True:
            pipe.send(_answer(step, pipe.recv()))
    except (EOFError, OSError):
        _leave()


def _answer(step: Callable[[J], R], job: J) -> tuple[str, Any]:
    try:
        return DONE, step(job)
    except Exception as error:  # noqa: BLE001 - the main process raises it
        error.add_note("".join(traceback.format_exception(error)))
        error.__traceback__ = error.__cause__ = error.__context__ = None
        return FAILED, error if _travels(error) else RuntimeError(f"{type(error).__name__}: {error}")


def _travels(error: Exception) -> bool:
    """Tell whether an exception survives the way to another process: many of libraries do not."""
    try:
        ForkingPickler.loads(ForkingPickler.dumps(error))
    except Exception:  # noqa: BLE001 - whatever its class raises
        return False
    return True


def _leave(*_signal: object) -> NoReturn:
    signal.signal(signal.SIGTERM, signal.SIG_IGN)  # to be told so while it is ending would print a traceback
    sys.exit(0)


def _end_with_parent() -> None:
    """End this process when the one that started it is gone."""
    parent = multiprocessing.parent_process()
    assert parent is not None
    wait([parent.sentinel])
    os._exit(1)
