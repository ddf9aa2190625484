"""The metric scale of shapes that have none: PartNet-Mobility's are normalised to the unit sphere.

For each category that an object may serve as, one uniform scale is fitted to the log-normal distribution of that
category's sizes by maximum likelihood. Proportions alone rarely tell which category it is: at any scale of its own a
nightstand has those of a kitchen unit. So categories compare by what the object would be at their scale: how likely its
size is, how large its doors, drawers, handles and boards would be, which of them such furniture has
(`category_signs`), and how common the category is.

Real things are drawn open (laptops), lying or upright (a remote), along their depth (toasters), with a handle pulled out
(suitcases) or without the frame that one assumes (doors). What fits as drawn is taken so; else folded or turned, else by wide priors.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from pipeline.arrays import Floats
from pipeline.sources.articulated.category_signs import Signs, log_likelihood, signs
from pipeline.sources.articulated.joint_rules import fold_shape
from pipeline.sources.articulated.part_classes import text_field
from pipeline.sources.articulated.shape import ArticulatedShape
from pipeline.sources.guarded import MIB, Folder, finite_array, read_json
from pipeline.sources.meshes.mesh_solids import Part
from pipeline.sources.reasons import SourceError
from pipeline.sources.settings import ModelLimits
from pipeline.sources.sizes import sizes

AS_DRAWN, ALONG = (0, 1, 2), (1, 0, 2)  # its own width and depth, and exchanged: built along its depth, its front stays in front
# Rotations to what lies and what stands, and the log-likelihood that it costs to believe them.
LAID = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])  # on its back: the front looks up
STOOD = LAID.T
TURN, EXCHANGE, FOLD = 3.0, 0.5, 0.1
ANYTHING = 20  # categories from which on nobody has said what it is: then nothing but its size tells
COMMON = 30  # models that every category counts beside its own, so that none is ruled out for being rare
UNITS = (1.0, 0.01, 0.001)  # metres per unit of files that are to scale: metres, centimetres, millimetres
METRIC = 2.5  # rms of standard deviations within which a shape passes for one that is in metres already
WIDE = 0.35  # spread of the logarithm that is added where nothing but our estimates of usual products is known
AGREE = 2.5  # spreads within which two of three sides must agree on a scale
ODD = math.log(15)  # by how much the third may be off: a laptop that stays open is as much higher than a closed one
MANY = 8  # objects of a category from which on they speak for it
LEAST = 0.05  # of a spread: a category whose objects are all alike says no more than that
NORMAL = 1.4826  # standard deviations of a normal distribution in its median absolute deviation
TALLEST = 2.75  # [m] that such a shape may be: rooms are 2.6 to 2.8 m high, and a chest of 3.2 m was drawn to be scaled


@dataclass(frozen=True, slots=True)
class Proportions:
    """Logarithms of (w, d, h) over their geometric mean: `middle` (3,) and `spread` (3,), median and robust deviation."""

    middle: Floats
    spread: Floats


@dataclass(frozen=True, slots=True)
class Fit:
    """`scale` [m per unit] as `category`; `rms` in standard deviations; log-likelihood of the object at that scale.

    `fitted`: the scale was chosen for that category; otherwise it is the unit of the file.
    """

    category: str
    scale: float
    rms: float
    likelihood: float
    fitted: bool


def fit(extent: Floats, category: str, observed: Signs | None = None, unit: float = 0.0) -> Fit | None:
    """Fit a category's sizes to an object of `extent` (w, d, h) [units], at `unit` metres per unit where that is known; None without statistics.

    With e = log extent and N(m, s^2) the logarithm of the sizes, log scale = sum((m - e) / s^2) / sum(1 / s^2).
    """
    known = sizes().get(category)
    if known is None or extent.min() <= 0:
        return None
    location, spread = known.logarithmic()
    weight = 1 / spread**2
    scale = unit or math.exp(float(((location - np.log(extent)) * weight).sum() / weight.sum()))
    z = (np.log(extent) + math.log(scale) - location) / spread
    likelihood = float(-0.5 * (z**2).sum() - np.log(spread).sum() - 1.5 * math.log(2 * math.pi))
    return _fit_at(category, scale, z, likelihood, observed, fitted=not unit)


def fit_metric(extent: Floats, category: str, observed: Signs | None = None, unit: float = 1.0) -> Fit | None:
    """Return the fit of an object that is to scale already, of `unit` metres per unit, or None where it is no such thing."""
    candidate = fit(extent, category, observed, unit) if extent[2] * unit <= TALLEST else None
    return candidate if candidate and candidate.rms <= METRIC else None


def fit_wide(extent: Floats, category: str, observed: Signs | None = None, own: Proportions | None = None) -> Fit | None:
    """Return the fit of an object that is built unlike its category's usual products, or None where it is nothing of the kind.

    Two of its three sides must agree on a scale, and decide it; the third may be odd (the sum of log(1 + z^2), Cauchy's
    likelihood, has its least value near what most say). How much a side says is its spread: the category's own, from its
    objects (`own`) and with how far these are from our estimate, or WIDE.
    """
    known = sizes().get(category)
    if known is None or extent.min() <= 0:
        return None
    location, spread = known.logarithmic()
    if own is not None:
        away = location - own.middle
        spread = np.sqrt(spread**2 + own.spread**2 + (away - np.median(away)) ** 2)
    else:
        spread = np.sqrt(spread**2 + WIDE**2)
    asked = location - np.log(extent)  # the log of the scale that each side asks for
    tried = np.array([*asked, (asked / spread**2).sum() / (1 / spread**2).sum()])
    z = (asked[None] - tried[:, None]) / spread
    cost = np.log1p(z**2).sum(axis=1).round(9)
    k = int(np.argmin(cost))
    off = np.sort(np.abs(z[k]))
    if off[1] > AGREE or float(np.abs(asked - tried[k]).max()) > ODD:
        return None
    scale = round(math.exp(float(tried[k])), 6)
    return _fit_at(category, scale, z[k], -float(cost[k] + np.log(spread).sum()), observed, fitted=True)


def _fit_at(category: str, scale: float, z: Floats, likelihood: float, observed: Signs | None, *, fitted: bool) -> Fit:
    """Return the fit of sides that are `z` (3,) deviations off; how common the category is and what is observed add to the likelihood."""
    likelihood += math.log(sizes()[category].count + COMMON)
    if observed is not None:
        likelihood += log_likelihood(observed, category, scale)
    return Fit(category, round(scale, 6), float(np.sqrt((z**2).mean())), likelihood, fitted)


def best_fits(fits: Iterable[Fit | None], *, rms: float, keep: int, margin: float) -> tuple[Fit, ...]:
    """Return the fits within `rms`, most likely first: at most `keep`, none worse than the best by more than `margin`."""
    candidates = [f for f in fits if f is not None and f.rms <= rms]
    candidates.sort(key=lambda f: (-f.likelihood, f.category))
    return tuple(f for f in candidates[:keep] if f.likelihood >= candidates[0].likelihood - margin)


def read_extent(source: Path, path: str) -> tuple[str, Floats] | None:
    """Return model category and extent (w, d, h) [units] of an object as drawn, by its own small files; None where they do not say."""
    try:
        folder = Folder.at(source).sub(path)
        box = read_json(folder, "bounding_box.json", MIB)
        category = text_field(read_json(folder, "meta.json", MIB), "model_cat")
    except (SourceError, OSError):
        return None
    low, high = (finite_array(box.get(key), 3) if isinstance(box, dict) else None for key in ("min", "max"))
    if not category or low is None or high is None or not (high > low).all():
        return None
    return category, (high - low)[[0, 2, 1]]


def gather_proportions(objects: Iterable[tuple[str, Floats] | None]) -> Mapping[str, Proportions]:
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


@dataclass(frozen=True, slots=True)
class _Variant:
    shape: ArticulatedShape
    order: tuple[int, int, int]
    cost: float
    what: str


def fit_shape(
    shape: ArticulatedShape, base: Sequence[Part], categories: Sequence[str], limits: ModelLimits, own: Proportions | None
) -> tuple[ArticulatedShape, tuple[Fit, ...]]:
    """Return the shape as it fits best, and its fits, likeliest first; none where it is nothing of the kind.

    `base` are convex pieces of its body, `own` the proportions of the objects of its model category.
    """

    def fits(variant: _Variant, fit_one: Callable[..., Fit | None], rms: float) -> tuple[Fit, ...]:
        extent, observed = variant.shape.extent[list(variant.order)], signs(variant.shape, base)
        tried = [fit_one(extent, category, observed) for category in categories]
        return best_fits(tried, rms=rms, keep=limits.fit_keep, margin=limits.fit_margin)

    # A file by itself is taken to be to scale where that makes it furniture.
    to_scale: list[Callable[..., Fit | None]] = [partial(fit_metric, unit=unit) for unit in UNITS] if shape.source == "urdf" else []
    for fit_one in (*to_scale, fit):
        if fitting := fits(_Variant(shape, AS_DRAWN, 0.0, ""), fit_one, limits.fit_rms if fit_one is fit else np.inf):
            return shape, fitting
    variants = list(_variants(shape))
    for wide in (False, True):
        if wide and shape.source == "urdf" and len(categories) > ANYTHING:
            break
        candidates = []
        for variant in variants:
            # Objects of a category are compared as they are drawn: turned ones are another matter.
            speaks = own if variant.order == AS_DRAWN and variant.cost <= FOLD else None
            how = partial(fit_wide, own=speaks) if wide else fit
            if fitting := fits(variant, how, np.inf if wide else limits.fit_rms):
                candidates.append((fitting[0].likelihood - variant.cost, variant, fitting))
        if candidates:
            _, best, fitting = max(candidates, key=lambda entry: entry[0])
            what = ", ".join(filter(None, (best.what, "wide priors" if wide else ""))) or "as drawn"
            shape = best.shape.copied()
            shape.notes.append(("model", "refitted", f"{what}: rms {fitting[0].rms:.2f} as {fitting[0].category}"))
            return shape, fitting
    return shape, ()


def _variants(shape: ArticulatedShape) -> Iterator[_Variant]:
    less = fold_shape(shape)
    for state, cost, what in ((shape, 0.0, ""), *(((less, FOLD, "folded"),) if less is not None else ())):
        turned = [(state, cost, what)]
        if shape.source != "urdf":  # whose frame has been looked for already
            turned += [
                (state.turned(R), cost + TURN, f"{what} {word}".strip()) for R, word in ((LAID, "laid on its back"), (STOOD, "stood up"))
            ]
        for other, price, how in turned:
            yield _Variant(other, AS_DRAWN, price, how)
            yield _Variant(other, ALONG, price + EXCHANGE, f"{how} along its depth".strip())
