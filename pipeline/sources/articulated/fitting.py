"""How an articulated shape fits the categories that it may serve as: as drawn, else folded or turned, else by wide priors.

Real things are drawn open (laptops), lying or upright (a remote), along their depth (toasters), with a handle pulled out
(suitcases) or without the frame that one assumes (doors). What fits as drawn is taken so; the rest is searched before it
is refused.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from pipeline.sources.articulated import metric_scale
from pipeline.sources.articulated.category_signs import signs
from pipeline.sources.articulated.joint_rules import fold_shape
from pipeline.sources.articulated.metric_scale import UNITS, Fit
from pipeline.sources.articulated.proportions import Proportions
from pipeline.sources.articulated.shape import ArticulatedShape
from pipeline.sources.meshes.mesh_solids import Part
from pipeline.sources.settings import ModelLimits

AS_DRAWN, ALONG = (0, 1, 2), (1, 0, 2)  # its own width and depth, and exchanged: built along its depth, its front stays in front
# Rotations to what lies and what stands, and the log-likelihood that it costs to believe them.
LAID = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])  # on its back: the front looks up
STOOD = LAID.T
TURN, EXCHANGE, FOLD = 3.0, 0.5, 0.1
ANYTHING = 20  # categories from which on nobody has said what it is: then nothing but its size tells


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
    fits = _as_drawn(shape, base, categories, limits)
    if fits:
        return shape, fits
    variants = list(_variants(shape))
    for wide in (False, True):
        if wide and shape.source == "urdf" and len(categories) > ANYTHING:
            break
        candidates = [(v, f) for v in variants if (f := _fits(v, base, categories, limits, own, wide=wide))]
        if candidates:
            best, fits = max(candidates, key=lambda entry: entry[1][0].likelihood - entry[0].cost)
            what = ", ".join(filter(None, (best.what, "wide priors" if wide else ""))) or "as drawn"
            shape = best.shape.copied()
            shape.notes.append(("model", "refitted", f"{what}: rms {fits[0].rms:.2f} as {fits[0].category}"))
            return shape, fits
    return shape, ()


def _as_drawn(shape: ArticulatedShape, base: Sequence[Part], categories: Sequence[str], limits: ModelLimits) -> tuple[Fit, ...]:
    """Return the fits as drawn; a file by itself is taken to be to scale where that makes it furniture."""
    if shape.source == "urdf":
        extent, observed = shape.extent, signs(shape, base)
        for unit in UNITS:
            tried = (metric_scale.metric(extent, c, observed, unit) for c in categories)
            kept = metric_scale.best(tried, rms=metric_scale.METRIC, keep=limits.fit_keep, margin=limits.fit_margin)
            if kept:
                return kept
    return _fits(_Variant(shape, AS_DRAWN, 0.0, ""), base, categories, limits, None, wide=False)


def _variants(shape: ArticulatedShape) -> Iterator[_Variant]:
    less = fold_shape(shape)
    for state, cost, what in ((shape, 0.0, ""), *(((less, FOLD, "folded"),) if less is not None else ())):
        yield _Variant(state, AS_DRAWN, cost, what)
        yield _Variant(state, ALONG, cost + EXCHANGE, f"{what} along its depth".strip())
        if shape.source != "urdf":  # whose frame has been looked for already
            for R, word in ((LAID, "laid on its back"), (STOOD, "stood up")):
                turned = state.turned(R)
                yield _Variant(turned, AS_DRAWN, cost + TURN, f"{what} {word}".strip())
                yield _Variant(turned, ALONG, cost + TURN + EXCHANGE, f"{what} {word} along its depth".strip())


def _fits(
    variant: _Variant, base: Sequence[Part], categories: Sequence[str], limits: ModelLimits, own: Proportions | None, *, wide: bool
) -> tuple[Fit, ...]:
    extent, observed = variant.shape.extent[list(variant.order)], signs(variant.shape, base)
    if not wide:
        tried = [metric_scale.fit(extent, c, observed) for c in categories]
        return metric_scale.best(tried, rms=limits.fit_rms, keep=limits.fit_keep, margin=limits.fit_margin)
    # Objects of a category are compared as they are drawn: turned ones are another matter.
    speaks = own if variant.order == AS_DRAWN and variant.cost <= FOLD else None
    tried = [metric_scale.wide(extent, c, observed, speaks) for c in categories]
    return metric_scale.best(tried, rms=np.inf, keep=limits.fit_keep, margin=limits.fit_margin)
