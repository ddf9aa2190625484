"""What is derived from an asset alone, computed once and kept while the process lives."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import TypeVar

from pipeline.entities.asset import Asset

T = TypeVar("T")


def kept(make: Callable[[Asset], T]) -> Callable[[Asset], T]:
    """Let `make` run once per asset.

    Keyed by identity: an asset holds arrays and has no hash. The asset is kept too, so that its id is never used again.
    """
    known: dict[int, tuple[Asset, T]] = {}

    @functools.wraps(make)
    def found(asset: Asset) -> T:
        entry = known.get(id(asset))
        if entry is None:
            entry = known[id(asset)] = (asset, make(asset))
        return entry[1]

    return found
