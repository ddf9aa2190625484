"""What a step tells while it works: how far it is. Passed to who called map_jobs, where the way is short; lost elsewhere (Dask)."""

from collections.abc import Callable
from typing import Any

Note = tuple[Any, ...]

_listeners: list[Callable[[Note], object]] = []


def tell(*note: Any) -> None:
    """Tell how far the step is, in values that can be sent to another process. It also shows that the worker is not stuck."""
    for listener in _listeners:
        listener(note)


def listen(listener: Callable[[Note], object] | None) -> None:
    """Let `listener` hear what is told in this process from now on; None: nobody."""
    _listeners[:] = [] if listener is None else [listener]
