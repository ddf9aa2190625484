"""The chances of manifests/calibration/rates.yaml, and decisions on them drawn in strata: over the rooms of one kind in a block of houses, each falls evenly.

A room is one of `total` of its kind in its block. For every decision the unit interval is cut into so many strata, and the rooms get
one each, in an order of the decision's own: a Latin hypercube. So a few hundred houses have the shares that were asked for.
"""

import functools
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from pipeline.seeds import generator

PATH = Path(__file__).resolve().parents[3] / "manifests" / "calibration" / "rates.yaml"
Rates = Mapping[str, Any]


@functools.cache
def load() -> Mapping[str, Rates]:
    """Read the manifest: by kind of room, then by decision; a chance, or a mapping of choices to their shares."""
    loaded: dict[str, Rates] = yaml.safe_load(PATH.read_text(encoding="utf-8"))
    return loaded


@dataclass(frozen=True, slots=True)
class Deal:
    """The hand of one room: number `ordinal` of the `total` rooms of its `kind` in block `block` of the corpus of a seed."""

    seed: int
    kind: str
    block: int
    ordinal: int
    total: int

    def mark(self, decision: str) -> float:
        """Return the room's number in [0, 1) for a decision; the same whenever it is asked."""
        return _marks(self.seed, self.kind, self.block, self.total, decision)[self.ordinal % self.total]

    def choose(self, decision: str, shares: Mapping[str, float]) -> str:
        """Return one of the choices; their shares need not sum to 1."""
        left = self.mark(decision) * sum(shares.values())
        for name, share in shares.items():
            left -= share
            if left < 0:
                return name
        return list(shares)[-1]


@functools.lru_cache(maxsize=8192)
def _marks(seed: int, kind: str, block: int, total: int, decision: str) -> tuple[float, ...]:
    rng = generator(seed, "deal", kind, block, decision)
    return tuple(((rng.permutation(total) + rng.random(total)) / total).tolist())
