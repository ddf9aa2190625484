"""What is derived from an asset alone, computed once and kept while the asset is; from other things, while they are in use."""

import functools
from collections.abc import Callable
from typing import Any, ParamSpec, TypeVar

from pipeline.entities.asset import Asset

T = TypeVar("T")
P = ParamSpec("P")


def cached_on_asset(make: Callable[[Asset], T]) -> Callable[[Asset], T]:
    """Let `make` run once per asset; the result lies with the asset and goes with it."""
    name = f"{make.__module__}.{make.__qualname__}"

    @functools.wraps(make)
    def cached(asset: Asset) -> T:
        if name not in asset.derived:
            asset.derived[name] = make(asset)
        result: T = asset.derived[name]
        return result

    return cached


def recent(most: int) -> Callable[[Callable[P, T]], Callable[P, T]]:
    """Let `make(subject, *others)` run once while its result is among the last `most`: homes in the making are asked the same again.

    Keyed by the identity of the subject, which holds arrays and has no hash, and by the values of the other arguments.
    """

    def decorate(make: Callable[P, T]) -> Callable[P, T]:
        known: dict[tuple[Any, ...], tuple[Any, T]] = {}

        @functools.wraps(make)
        def cached(*args: P.args, **kwargs: P.kwargs) -> T:
            key = (id(args[0]), *args[1:], *kwargs.items())
            entry = known.get(key)
            if entry is None:
                if len(known) >= most:
                    del known[next(iter(known))]
                entry = known[key] = (args[0], make(*args, **kwargs))
            return entry[1]

        return cached

    return decorate
