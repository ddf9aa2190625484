"""How far a run is, on stderr: a bar on a terminal, a line now and then elsewhere, JSON lines for machines, or nothing.

What a step tells while it works is passed to who called map_jobs, where the way is short; it is lost elsewhere (Dask).
"""

import json
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from typing import Any, Literal, TypeVar

J = TypeVar("J")
Voice = Literal["plain", "quiet", "json"]
Note = tuple[Any, ...]

_listeners: list[Callable[[Note], object]] = []

QUIET = 30.0  # seconds between two lines where there is no terminal
FIRST = 5.0  # seconds until the first of them; each comes twice as late as the one before, until they are QUIET apart
LIVELY = 0.5  # seconds between two changes of what a terminal shows beside the bar


def tell(*note: Any) -> None:
    """Tell how far the step is, in values that can be sent to another process. It also shows that the worker is not stuck."""
    for listener in _listeners:
        listener(note)


def listen(listener: Callable[[Note], object] | None) -> None:
    """Let `listener` hear what is told in this process from now on; None: nobody."""
    _listeners[:] = [] if listener is None else [listener]


class Progress:
    """Counts what is done of `total` units and says so from the first second on.

    What is told besides: `say` a line, `state` what is at work, `count` figures such as retries.
    """

    def __init__(self, total: int, label: str, *, unit: str = "home", voice: Voice = "plain") -> None:
        self.total, self.label, self.unit, self.voice = total, label, unit, voice
        self.done = 0
        self.counts: dict[str, int] = {}
        self._state = ""
        self._start = self._last = time.monotonic()
        self._wait = FIRST
        self._bar: Any = None
        if voice == "plain" and sys.stderr.isatty():
            from tqdm import tqdm

            self._bar = tqdm(total=total, desc=label, unit=unit, file=sys.stderr, dynamic_ncols=True, smoothing=0.1)

    def say(self, text: str) -> None:
        """Say a line of its own."""
        if self.voice == "json":
            self._event("said", text=text)
        elif self.voice == "plain":
            if self._bar is not None:
                self._bar.clear()
            sys.stderr.write(f"{self.label}: {text}\n")
            sys.stderr.flush()

    def phase(self, text: str) -> None:
        """Say what is at work now, in a line of its own when it is something else than before."""
        if text != self._state:
            self._state = text
            self.say(text)

    def state(self, text: str) -> None:
        """Tell what is at work now."""
        self._state = text
        self._show()

    def count(self, **counts: int) -> None:
        """Add to the figures."""
        for name, more in counts.items():
            self.counts[name] = self.counts.get(name, 0) + more

    def add(self, units: int = 1) -> None:
        """Count units as done."""
        self.done += units
        if self._bar is not None:
            self._bar.update(units)
        self._show()

    def at(self, done: int, total: int) -> None:
        """Take over a count from elsewhere."""
        self.total = total
        if self._bar is not None:
            self._bar.total = total
        self.add(done - self.done)

    def close(self) -> None:
        """End the display."""
        if self._bar is not None:
            self._bar.close()
            self._bar = None
        elif self._wait > FIRST:  # a run that was long enough to say something says how it ended
            self._show(last=True)

    def summary(self, **what: Any) -> None:
        """Write what a run came to as one JSON line on stdout."""
        sys.stdout.write(json.dumps({"event": "done", "seconds": round(self.seconds, 2), **what}) + "\n")

    @property
    def seconds(self) -> float:
        """Seconds since the beginning."""
        return time.monotonic() - self._start

    def _show(self, *, last: bool = False) -> None:
        now = time.monotonic()
        gone = now - self._last
        if self._bar is not None:
            if gone >= LIVELY:
                self._last = now
                self._bar.set_postfix_str(", ".join(filter(None, (*(f"{v} {k}" for k, v in self.counts.items() if v), self._state))))
            return
        if self.voice == "quiet" or (gone < self._wait and not last):
            return
        self._last, self._wait = now, min(QUIET, 2 * self._wait)
        rate = self.done / max(self.seconds, 1e-3)
        left = (self.total - self.done) / rate if self.done else None
        if self.voice == "json":
            self._event("progress", per_second=round(rate, 3), seconds_left=None if left is None else round(left, 1), state=self._state)
            return
        parts = [f"{self.done} of {self.total} {self.unit}s", f"{_clock(self.seconds)} gone"]
        parts += [f"{rate:.2f} a second, {_clock(left)} left"] if left is not None else []
        parts += [*(f"{v} {k}" for k, v in self.counts.items() if v), *([self._state] if self._state and not last else [])]
        sys.stderr.write(f"{self.label}: {', '.join(parts)}\n")
        sys.stderr.flush()

    def _event(self, event: str, **what: Any) -> None:
        record = {"event": event, f"{self.unit}s": self.done, "of": self.total, "seconds": round(self.seconds, 2), **self.counts, **what}
        sys.stderr.write(json.dumps(record) + "\n")
        sys.stderr.flush()


def track(
    items: Iterable[J], total: int, label: str, *, unit: str = "home", size: Callable[[J], int] = lambda _item: 1, voice: Voice = "plain"
) -> Iterator[J]:
    """Pass `items` on, showing how many of `total` units are done and the time left."""
    progress = Progress(total, label, unit=unit, voice=voice)
    for item in items:
        progress.add(size(item))
        yield item
    progress.close()


def _clock(seconds: float) -> str:
    return f"{int(seconds) // 60}:{int(seconds) % 60:02d}"
