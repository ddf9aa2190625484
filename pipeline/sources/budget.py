"""What the reading of one file may cost: processor time and memory, held by the operating system, whatever the file makes a reader do."""

import contextlib
import signal
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NoReturn

MIB = 1 << 20
AGAIN = 2  # times its seconds, and a second more, after which code that hears no signal ends with its process


@dataclass(frozen=True, slots=True)
class Budget:
    """`seconds` of processor time and `mebibytes` beyond what the process has before, for each file or folder of an object."""

    seconds: float = 120.0
    mebibytes: int = 2048


class OutOfTimeError(BaseException):
    """The time for a file is up. No `Exception`: readers turn those into a finding about a part of a file, and go on."""


@contextlib.contextmanager
def enforce(budget: Budget) -> Iterator[None]:
    """Hold what is done within to a budget: raises OutOfTimeError, or lets MemoryError arise; a library that is deaf to both ends the process.

    For the main thread of a process of its own. Where the system knows no such limits (Windows), only the pool's patience is one.
    """
    if sys.platform == "win32":
        yield
        return
    import resource

    before = {kind: resource.getrlimit(kind) for kind in (resource.RLIMIT_AS, resource.RLIMIT_CPU, resource.RLIMIT_CORE)}
    usage = resource.getrusage(resource.RUSAGE_SELF)
    last = int(usage.ru_utime + usage.ru_stime + AGAIN * budget.seconds) + 2
    wanted = {resource.RLIMIT_CPU: last, resource.RLIMIT_CORE: 0}
    if size := _address_space():
        wanted[resource.RLIMIT_AS] = size + budget.mebibytes * MIB
    old_handler = signal.signal(signal.SIGPROF, _out_of_time)
    try:
        for kind, most in wanted.items():
            hard = before[kind][1]
            resource.setrlimit(kind, (most if hard == resource.RLIM_INFINITY else min(most, hard), hard))
        signal.setitimer(signal.ITIMER_PROF, budget.seconds)
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, old_handler)
        for kind, limits in before.items():
            resource.setrlimit(kind, limits)


def _address_space() -> int:
    """Return what this process has mapped [bytes], 0 where the system does not say."""
    try:
        pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
    except OSError:
        return 0
    import resource

    return pages * resource.getpagesize()


def _out_of_time(*_signal: object) -> NoReturn:
    raise OutOfTimeError
