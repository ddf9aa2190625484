"""Compilation of hot loops: numba with a disk cache where one can be written, without it elsewhere (a read-only checkout)."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar, cast

import numba

F = TypeVar("F", bound=Callable[..., object])


def compiled(function: F) -> F:
    """Compile `function` on its first call. The plain form stays at `.py_func`: the oracle of the tests."""
    try:
        return cast("F", numba.njit(cache=True, error_model="numpy")(function))
    except RuntimeError:  # numba finds no folder for its cache
        return cast("F", numba.njit(cache=False)(function))
