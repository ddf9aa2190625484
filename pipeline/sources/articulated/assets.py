"""Articulated shapes at a metric scale: one asset per category that an object may serve as."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from pipeline.arrays import Floats
from pipeline.entities.asset import Asset, Joint, Link, PartBox
from pipeline.geometry.prerequisites import with_prerequisites
from pipeline.sources.articulated.hidden_boards import without_hidden
from pipeline.sources.articulated.metric_scale import Fit, Proportions, fit_shape
from pipeline.sources.articulated.shape import ArticulatedShape, ShapeBody, ShapeJoint
from pipeline.sources.articulated.shape_reader import distinct_names
from pipeline.sources.densities import density
from pipeline.sources.meshes.colliders import POCKET, Solids, bodies_solids, build_link, matter_volume, solids
from pipeline.sources.meshes.inertials import Inertial, combine_inertials, inertia_flaw, mass_flaw
from pipeline.sources.meshes.small_parts import UNDER
from pipeline.sources.meshes.touching import ANY, BUMPED, LEFT_ALONE, OVER, SAG, touch_tolerances
from pipeline.sources.reasons import Row, SourceError, reject
from pipeline.sources.settings import ModelLimits
from pipeline.taxonomy import Taxonomy

LIDS = ("hinge_lid", "slider_lid")
SHORT = {"gapartnet": "ga", "partnet-mobility": "pm", "urdf": "ur"}


def assets(
    shape: ArticulatedShape, stem: str, categories: Sequence[str], taxonomy: Taxonomy, limits: ModelLimits, licence: str,
    own: Proportions | None = None,
) -> Iterator[tuple[Asset, Fit, list[Row]]]:  # fmt: skip
    """Yield (asset, how it was scaled, reject rows) for each of the `categories` that the shape fits, best first.

    The assets' ids are made of `stem`; `own` are the proportions of the objects of its model category. Raises SourceError `unknown_category` or `no_metric_fit` where there is none.
    """
    if not categories:
        raise SourceError("unknown_category", shape.source_id, f"model_cat {shape.model_cat!r}")
    base = solids("base", shape.bodies[0].collisions, limits, None).pieces
    shape, fits = fit_shape(shape, base, categories, limits, own)
    low, high = shape.bounds()
    extent = high - low
    if not fits:
        what = shape.model_cat or "none of the categories"
        raise SourceError("no_metric_fit", shape.source_id, f"{what} of proportions {np.round(extent, 3).tolist()}")
    names = distinct_names(["base", *(body.name for body in shape.bodies[1:])])
    bodies = [replace(body, name=name) for body, name in zip(shape.bodies, names, strict=True)]
    # What fits nothing has cost no cut so far.
    tolerance = None if limits.cut == "none" else POCKET * float(np.linalg.norm(extent))
    matter = bodies_solids([(body.name, body.collisions) for body in bodies], limits, tolerance)
    middle = np.array([(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2]])
    for number, fit in enumerate(fits):
        category = taxonomy.categories[fit.category]
        kind, how = category.super, touch_tolerances(category, opens=True)
        lowest = min([UNDER, *(float((body.points()[:, 2] - middle[2]).min()) * fit.scale for body in bodies[1:])])
        over = OVER if category.mount == "floor" else ANY
        # nothing comes into a lid from below
        felt = {joint.child: replace(how, down=LEFT_ALONE) for joint in shape.joints if joint.part_class in LIDS}
        if not category.loose:
            felt[0] = replace(how, sides=BUMPED, down=LEFT_ALONE, under=lowest, over=over, sag=SAG)
        links: list[Link] = []
        weighed = []
        for k, (body, solid) in enumerate(zip(bodies, matter, strict=True)):
            real = solid.scaled(middle, fit.scale)
            stated, note = _stated_inertial(body, real, middle, fit, kind)
            weighed += note
            visuals = [replace(m, vertices=((m.vertices - middle) * fit.scale).astype(np.float32)) for m in body.visuals]
            links.append(build_link(body.name, visuals, real, density(kind, "", fit.category), kind, stated, felt.get(k, how)))
        shown = links if category.loose else without_hidden(links, shape.joints)
        asset = Asset(
            f"{SHORT[shape.source]}_{stem}_{fit.category}", fit.category, np.round(extent * fit.scale, 4),
            tuple(shown), tuple(_joint(j, middle, fit.scale) for j in shape.joints), tuple(shape.palette.materials),
            shape.source, shape.source_id, licence, "", kind, dict(shape.palette.textures),
            tuple(_part(p, middle, fit.scale) for p in shape.parts),
        )  # fmt: skip
        notes = [*shape.notes, *(("model", *note) for note in (*(note for solid in matter for note in solid.notes), *weighed))]
        told = [reject(what, shape.source_id, *note) for what, *note in notes] if number == 0 else []  # what befell the folder is told once
        yield with_prerequisites(asset), fit, told


def _stated_inertial(
    body: ShapeBody, matter: Solids, middle: Floats, fit: Fit, kind: str
) -> tuple[Inertial | float | None, list[tuple[str, str]]]:  # fmt: skip
    """Return what the source states of a body [m, kg] and a note of it: an inertial, the mass alone where the rest is a placeholder, or None."""
    pieces = [i for i in body.inertials if i is not None]
    if not pieces:
        return None, []
    points = (body.points() - middle) * fit.scale
    stated = combine_inertials(pieces).scaled(middle, fit.scale)
    why = mass_flaw(stated.mass, matter_volume(matter, kind))
    if fit.fitted:
        why = "is of another size"
    elif len(pieces) < len(body.inertials):
        why = f"is of {len(pieces)} of its {len(body.inertials)} links"
    if why:
        return None, [("inertial_refused", f"{body.name}: {why}")]
    placeholder = inertia_flaw(stated, points.min(axis=0), points.max(axis=0))
    if placeholder:
        return stated.mass, [("mass_used", f"{body.name}: {stated.mass:.4g} kg, its inertia {placeholder}")]
    return stated, [("inertial_used", f"{body.name}: {stated.mass:.4g} kg")]


def _joint(joint: ShapeJoint, middle: Floats, scale: float) -> Joint:
    reach = scale if joint.type == "prismatic" else 1.0
    axis: Floats = np.round(joint.axis / float(np.linalg.norm(joint.axis)), 9) + 0.0
    origin = np.round((joint.origin - middle) * scale, 6) + 0.0
    lower, upper = round(joint.lower * reach, 6) + 0.0, round(joint.upper * reach, 6) + 0.0
    return Joint(joint.name, joint.type, joint.parent, joint.child, axis, origin, lower, upper, joint.part_class)


def _part(part: PartBox, middle: Floats, scale: float) -> PartBox:
    centre, size = np.round((part.centre - middle) * scale, 6) + 0.0, np.round(part.size * scale, 6) + 0.0
    return replace(part, centre=centre, axes=np.round(part.axes, 9) + 0.0, size=size)
