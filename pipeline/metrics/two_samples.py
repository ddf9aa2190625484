"""Two samples of rooms: whether a classifier tells them apart (SCA, .5 is best), how far apart they are (FID, KID), and their categories (CKL)."""

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from pipeline.arrays import Floats
from pipeline.metrics.intervals import Mean, Rate, interval, rate
from pipeline.metrics.rows import Row

FOLDS = 5
TREES = 100
SUBSETS = 200  # of KID
SUBSET = 100  # rooms in each, if there are so many
LEAST = 1e-6  # added inside both logarithms of CKL, as ATISS and its followers do


def forest_accuracy(seed: int, real: Floats, generated: Floats, real_rooms: Sequence[str], generated_rooms: Sequence[str]) -> Rate:
    """Return the share of rooms that a random forest puts with their kind, balanced and cross-validated by room.

    Rooms of one name, the real and the made furniture of one floor, are always in the same fold.
    """
    from sklearn.ensemble import RandomForestClassifier

    forest = RandomForestClassifier(TREES, min_samples_leaf=2, class_weight="balanced", random_state=seed, n_jobs=1)
    return _accuracy(forest, seed, real, generated, [*real_rooms, *generated_rooms])


def linear_accuracy(seed: int, real: Floats, generated: Floats, real_rooms: Sequence[str], generated_rooms: Sequence[str]) -> Rate:
    """Return the same for logistic regression on standardised features: a classifier on top of a frozen net."""
    from sklearn.linear_model import LogisticRegression
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    linear = make_pipeline(StandardScaler(), LogisticRegression(C=0.3, class_weight="balanced", max_iter=300))
    return _accuracy(linear, seed, real, generated, [*real_rooms, *generated_rooms])


def _accuracy(classifier: Any, seed: int, real: Floats, generated: Floats, rooms: Sequence[str]) -> Rate:
    """Return the balanced share of right answers over folds of whole rooms."""
    x, y = np.concatenate([real, generated]), np.repeat([0, 1], [len(real), len(generated)])
    names, room = np.unique(np.array(rooms), return_inverse=True)
    fold = (np.random.default_rng(seed).permutation(len(names)) % FOLDS)[room]
    right = np.zeros(len(y), bool)
    for k in range(FOLDS):
        known, asked = fold != k, fold == k
        if asked.any() and len(np.unique(y[known])) == 2:
            right[asked] = classifier.fit(x[known], y[known]).predict(x[asked]) == y[asked]
    balanced = (right[y == 0].mean() + right[y == 1].mean()) / 2 if len(real) and len(generated) else 0.0
    return rate(round(float(balanced) * len(y)), len(y))


def frechet(a: Floats, b: Floats) -> float:
    """Return the squared Fréchet distance between two Gaussians fitted to features (N, D), (M, D) (Heusel et al. 2017)."""
    cov_a, cov_b = np.cov(a, rowvar=False), np.cov(b, rowvar=False)
    values, vectors = np.linalg.eigh(cov_a)
    half = (
        vectors * np.sqrt(np.maximum(values, 0))
    ) @ vectors.T  # tr (AB)^1/2 = tr (A^1/2 B A^1/2)^1/2, which is symmetric: few rooms do no harm
    shared = np.sqrt(np.maximum(np.linalg.eigvalsh(half @ cov_b @ half), 0)).sum()
    apart = a.mean(0) - b.mean(0)
    return float(apart @ apart + np.trace(cov_a + cov_b) - 2 * shared)


def kernel_distance(rng: np.random.Generator, a: Floats, b: Floats) -> Mean:
    """Return KID: the unbiased squared MMD under the kernel (x.y/D + 1)^3, its mean over subsets with their 95 % interval.

    Binkowski et al. 2018. It may be negative, and its interval holds 0 where the samples are of one distribution.
    """
    size = min(SUBSET, len(a), len(b))
    drawn = []
    for _ in range(SUBSETS):
        x, y = a[rng.choice(len(a), size, replace=False)], b[rng.choice(len(b), size, replace=False)]
        xx, yy, xy = ((p @ q.T / p.shape[1] + 1) ** 3 for p, q in ((x, x), (y, y), (x, y)))
        within = (xx.sum() - np.trace(xx) + yy.sum() - np.trace(yy)) / (size * (size - 1))
        drawn.append(float(within - 2 * xy.mean()))
    return interval(float(np.mean(drawn)), drawn, SUBSETS)


def frequencies(categories: Iterable[str], names: Sequence[str]) -> Floats:
    """Return the share (C,) of each category among all objects, pooled over scenes; zeros when there are none."""
    counts = Counter(categories)
    per_category = np.array([counts[name] for name in names], float)
    return np.asarray(per_category / max(per_category.sum(), 1.0))


def divergence(p: Floats, q: Floats) -> float:
    """Return sum p (log(p + 1e-6) - log(q + 1e-6)) [nat]."""
    return float(np.sum(p * (np.log(p + LEAST) - np.log(q + LEAST))))


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
