"""The proportions of the objects of a model category: PartNet-Mobility has no metric scale, but many objects of a kind."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pipeline.sources.articulated.part_classes import text_field
from pipeline.sources.guarded import MIB, Folder, read_json
from pipeline.sources.reasons import SourceError

Floats = NDArray[np.float64]
MANY = 8  # objects of a category from which on they speak for it
LEAST = 0.05  # of a spread: a category whose objects are all alike says no more than that
NORMAL = 1.4826  # standard deviations of a normal distribution in its median absolute deviation


@dataclass(frozen=True, slots=True)
class Proportions:
    """Logarithms of (w, d, h) over their geometric mean: `middle` (3,) and `spread` (3,), median and robust deviation."""

    middle: Floats
    spread: Floats


def read_extent(source: Path, path: str) -> tuple[str, Floats] | None:
    """Return model category and extent (w, d, h) [units] of an object as drawn, by its own small files; None where they do not say."""
    try:
        folder = Folder.at(source).sub(path)
        box = read_json(folder, "bounding_box.json", MIB)
        category = text_field(read_json(folder, "meta.json", MIB), "model_cat")
        low, high = (np.array(box[key], np.float64) for key in ("min", "max"))
    except (SourceError, KeyError, TypeError, ValueError, OSError):
        return None
    extent = (high - low)[[0, 2, 1]] if low.shape == high.shape == (3,) else np.zeros(3)
    return (category, extent) if category and np.isfinite(extent).all() and extent.min() > 0 else None


def spreads(objects: Iterable[tuple[str, Floats] | None]) -> Mapping[str, Proportions]:
    """Return the proportions of every model category of which there are MANY objects."""
    logs: dict[str, list[Floats]] = {}
    for entry in objects:
        if entry is not None:
            log = np.log(entry[1])
            logs.setdefault(entry[0], []).append(log - log.mean())
    by_category = {}
    for category, rows in logs.items():
        if len(rows) >= MANY:
            middle = np.median(rows, axis=0)
            spread = NORMAL * np.median(np.abs(np.array(rows) - middle), axis=0)
            by_category[category] = Proportions(middle, np.maximum(spread, LEAST))
    return by_category
