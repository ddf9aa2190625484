"""How an articulated shape fits the categories that it may serve as: as drawn, else folded or turned, else by wide priors.

Real things are drawn open (laptops), lying or upright (a remote), along their depth (toasters), with a handle pulled out
(suitcases) or without the frame that one assumes (doors). What fits as drawn is taken so; the rest is searched before it
is refused.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from pipeline.sources.articulated import metric_scale
from pipeline.sources.articulated.category_signs import signs
from pipeline.sources.articulated.joint_rules import fold_shape
from pipeline.sources.articulated.metric_scale import UNITS, Fit, Proportions
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

    def fits(variant: _Variant, fit_one: Callable[..., Fit | None], rms: float) -> tuple[Fit, ...]:
        extent, observed = variant.shape.extent[list(variant.order)], signs(variant.shape, base)
        tried = [fit_one(extent, category, observed) for category in categories]
        return metric_scale.best_fits(tried, rms=rms, keep=limits.fit_keep, margin=limits.fit_margin)

    # A file by itself is taken to be to scale where that makes it furniture.
    to_scale: list[Callable[..., Fit | None]] = (
        [partial(metric_scale.fit_metric, unit=unit) for unit in UNITS] if shape.source == "urdf" else []
    )
    for fit_one in (*to_scale, metric_scale.fit):
        if fitting := fits(_Variant(shape, AS_DRAWN, 0.0, ""), fit_one, limits.fit_rms if fit_one is metric_scale.fit else np.inf):
            return shape, fitting
    variants = list(_variants(shape))
    for wide in (False, True):
        if wide and shape.source == "urdf" and len(categories) > ANYTHING:
            break
        candidates = []
        for variant in variants:
            # Objects of a category are compared as they are drawn: turned ones are another matter.
            speaks = own if variant.order == AS_DRAWN and variant.cost <= FOLD else None
            how = partial(metric_scale.fit_wide, own=speaks) if wide else metric_scale.fit
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
