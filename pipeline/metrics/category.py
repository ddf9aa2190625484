"""CKL: how far the frequencies of object categories are from the real ones."""

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import TypedDict

import numpy as np
from numpy.typing import NDArray

from pipeline.metrics.rows import Row

FLOOR = 1e-6  # added inside both logarithms, as ATISS and its followers do


class Ckl(TypedDict):
    """Both directions [nat]: the peers compute D(real || generated), the paper prints D(generated || real)."""

    real_to_generated: float
    generated_to_real: float
    real_objects: int
    generated_objects: int


def frequencies(categories: Iterable[str], names: Sequence[str]) -> NDArray[np.float64]:
    """Return the share (C,) of each category among all objects, pooled over scenes; zeros when there are none.

    Raises ValueError for a category that is not in `names`.
    """
    counts = Counter(categories)
    unknown = sorted(set(counts) - set(names))
    if unknown:
        raise ValueError(f"unknown categories: {', '.join(unknown)}")
    per_category = np.array([counts[name] for name in names], float)
    shares: NDArray[np.float64] = per_category / max(float(per_category.sum()), 1.0)
    return shares


def divergence(p: NDArray[np.float64], q: NDArray[np.float64]) -> float:
    """Return sum p (log(p + 1e-6) - log(q + 1e-6)) [nat]."""
    return float(np.sum(p * (np.log(p + FLOOR) - np.log(q + FLOOR))))


def ckl(real: Iterable[Row], generated: Iterable[Row], names: Sequence[str]) -> Ckl:
    """Return the category divergence between rows of two objects tables."""
    mine, theirs = [r["category"] for r in real], [g["category"] for g in generated]
    p, q = frequencies(mine, names), frequencies(theirs, names)
    return {
        "real_to_generated": round(divergence(p, q), 6),
        "generated_to_real": round(divergence(q, p), 6),
        "real_objects": len(mine),
        "generated_objects": len(theirs),
    }
