"""Articulated shapes at a metric scale: one asset per category that an object may serve as."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pipeline.entities.asset import Asset, Joint, Mesh
from pipeline.sources import metric_scale
from pipeline.sources.colliders import Decompose, Solids, link, solids
from pipeline.sources.densities import density
from pipeline.sources.partnet import ArticulatedShape, ShapeBody, ShapeJoint
from pipeline.sources.reasons import Row, SourceError, reject
from pipeline.sources.settings import ModelLimits
from pipeline.taxonomy import Taxonomy

Floats = NDArray[np.float64]
SHORT = {"gapartnet": "ga", "partnet-mobility": "pm"}


def assets(
    shape: ArticulatedShape, taxonomy: Taxonomy, limits: ModelLimits, licence: str, decompose: Decompose | None = None
) -> Iterator[tuple[Asset, float, list[Row]]]:
    """Yield (asset, metres per unit, reject rows) for each category that the shape fits, best first.

    Raises SourceError `unknown_category` or `no_metric_fit` where there is none.
    """
    categories = taxonomy.from_partnet(shape.model_cat)
    if not categories:
        raise SourceError("unknown_category", shape.source_id, f"model_cat {shape.model_cat!r}")
    low, high = shape.bounds()
    extent = high - low
    fits = metric_scale.best(extent, categories, rms=limits.fit_rms, keep=limits.fit_keep, margin=limits.fit_margin)
    if not fits:
        raise SourceError("no_metric_fit", shape.source_id, f"{shape.model_cat} of proportions {np.round(extent, 3).tolist()}")
    middle = np.array([(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2]])
    bodies = _unique(shape.bodies)
    matter = [solids(body.name, body.collisions, limits, decompose) for body in bodies]
    for number, fit in enumerate(fits):
        kind = taxonomy.categories[fit.category].super
        links = [
            link(body.name, _metric(body, middle, fit.scale), solid.scaled(middle, fit.scale), density(kind, ""), kind)
            for body, solid in zip(bodies, matter, strict=True)
        ]
        asset = Asset(
            f"{SHORT[shape.source]}_{_plain(shape.source_id)}_{fit.category}", fit.category, np.round(extent * fit.scale, 4),
            tuple(links), tuple(_joint(j, middle, fit.scale) for j in shape.joints), tuple(shape.palette.materials),
            shape.source, shape.source_id, licence, "", kind, dict(shape.palette.textures),
        )  # fmt: skip
        yield asset, fit.scale, _rejects(shape, matter) if number == 0 else []  # what befell the folder is told once


def _rejects(shape: ArticulatedShape, matter: list[Solids]) -> list[Row]:
    rows = [reject(what, shape.source_id, reason, detail) for what, reason, detail in shape.notes]
    return rows + [reject("model", shape.source_id, reason, detail) for solid in matter for reason, detail in solid.notes]


def _metric(body: ShapeBody, middle: Floats, scale: float) -> list[Mesh]:
    return [replace(m, vertices=((m.vertices - middle) * scale).astype(np.float32)) for m in body.visuals]


def _joint(joint: ShapeJoint, middle: Floats, scale: float) -> Joint:
    reach = scale if joint.type == "prismatic" else 1.0
    axis: Floats = np.round(joint.axis / float(np.linalg.norm(joint.axis)), 9) + 0.0
    origin = np.round((joint.origin - middle) * scale, 6) + 0.0
    lower, upper = round(joint.lower * reach, 6) + 0.0, round(joint.upper * reach, 6) + 0.0
    return Joint(joint.name, joint.type, joint.parent, joint.child, axis, origin, lower, upper, joint.part_class)


def _unique(bodies: tuple[ShapeBody, ...]) -> list[ShapeBody]:
    """Return the bodies under names that differ."""
    taken: set[str] = {"base"}
    named = [replace(bodies[0], name="base")]
    for k, body in enumerate(bodies[1:], 1):
        name = body.name if body.name not in taken else f"{body.name}_n{k}"
        taken.add(name)
        named.append(replace(body, name=name))
    return named


def _plain(text: str) -> str:
    return "".join(c if c.isalnum() and c.isascii() else "_" for c in text.lower())
