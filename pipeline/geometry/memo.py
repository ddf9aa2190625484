"""What is derived from an asset alone, computed once and kept while the asset is."""

import functools
from collections.abc import Callable
from typing import TypeVar

from pipeline.entities.asset import Asset

T = TypeVar("T")


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
