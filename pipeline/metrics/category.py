"""CKL: how far the frequencies of object categories are from the real ones."""

from collections import Counter
from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from pipeline.metrics.rows import Row

FLOOR = 1e-6  # added inside both logarithms, as ATISS and its followers do


def frequencies(categories: Iterable[str], names: Sequence[str]) -> NDArray[np.float64]:
    """Return the share (C,) of each category among all objects, pooled over scenes; zeros when there are none."""
    counts = Counter(categories)
    per_category = np.array([counts[name] for name in names], float)
    return np.asarray(per_category / max(per_category.sum(), 1.0))


def divergence(p: NDArray[np.float64], q: NDArray[np.float64]) -> float:
    """Return sum p (log(p + 1e-6) - log(q + 1e-6)) [nat]."""
    return float(np.sum(p * (np.log(p + FLOOR) - np.log(q + FLOOR))))


def ckl(real: Sequence[Row], generated: Sequence[Row], names: Sequence[str]) -> dict[str, float]:
    """Return the category divergence [nat] between rows of two objects tables, of which `names` count.

    Both directions: the peers compute D(real || generated), the paper prints D(generated || real).
    """
    p, q = (frequencies((row["category"] for row in rows), names) for rows in (real, generated))
    return {
        "real_to_generated": round(divergence(p, q), 6),
        "generated_to_real": round(divergence(q, p), 6),
        "real_objects": len(real),
        "generated_objects": len(generated),
    }
