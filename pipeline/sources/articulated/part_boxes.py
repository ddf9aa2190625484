"""Parts in GAPartNet's sense, their classes and boxes: as annotated, or of the geometry where there is no annotation.

z looks outwards, the way in which a part sets off when it opens, or its carrier's front; x is a hinge's axis in the
opening sense, the long side of a handle, else level; y = z x x.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from pipeline.arrays import Floats
from pipeline.entities.asset import PartBox
from pipeline.geometry.kinematics import axis_distances
from pipeline.sources.articulated.joint_rules import close_drawn_open
from pipeline.sources.articulated.part_classes import shaped_class
from pipeline.sources.articulated.shape import ArticulatedShape, ShapeBody, ShapeJoint
from pipeline.sources.meshes.mesh_solids import qhull_of

FRONT = np.array([0.0, -1.0, 0.0])


def complete_shape(shape: ArticulatedShape) -> ArticulatedShape:
    """Return the shape, which stands upright with its front towards -y, with all that its form tells.

    Every joint gets a class, doors and drawers are closed, and the movers and fixed handles without an annotation get boxes.
    """
    shape = shape.copied()
    everything = np.concatenate([body.points() for body in shape.bodies])
    low, whole = everything.min(axis=0), np.ptp(everything, axis=0)
    middle = np.array([low[0] + whole[0] / 2, low[1] + whole[1] / 2, low[2]])
    for number, joint in enumerate(shape.joints):
        if joint.part_class == "other" and joint.inferred:
            mine = shape.points_below(joint.child) - middle
            part_class = shaped_class(joint.type, joint.axis, mine.min(axis=0), mine.max(axis=0), whole)
            shape.joints[number] = replace(joint, part_class=part_class)
    close_drawn_open(shape)
    known = {("other", j.child) for j in shape.joints} | {(p.part_class, p.link) for p in shape.parts}
    movers = [_mover_part(shape.bodies[j.child], j) for j in shape.joints if (j.part_class, j.child) not in known]
    fixed = [part for k, body in enumerate(shape.bodies) for part in _fixed_parts(k, body, shape.joints)]
    shape.parts += [*movers, *(part for part in fixed if (part.part_class, part.link) not in known)]
    return shape


def _mover_part(body: ShapeBody, joint: ShapeJoint) -> PartBox:
    """Return the part that a joint moves, boxed by its own geometry."""
    points = body.points()
    if joint.type == "prismatic":
        z = _unit(joint.axis, FRONT)
    else:
        radius = axis_distances(joint, points)
        far = points[radius >= 0.9 * radius.max()].mean(axis=0)
        out = _unit(np.cross(joint.axis, far - joint.origin), FRONT)
        z = max((s * n for n in _sides(points, joint.axis) for s in (1, -1)), key=lambda n: float(n @ out), default=out)
    x = joint.axis if joint.part_class in {"hinge_door", "hinge_lid"} else _level(z)
    return _fit_part_box(joint.child, joint.part_class, points, x, z, annotated=not joint.inferred)


def _sides(points: Floats, axis: Floats) -> list[Floats]:
    """Return the normals (3,) of two sides of the narrowest box about an axis (a side lies along an edge of the outline)."""
    across = _level(axis)
    plane = np.stack([across, np.cross(axis, across)])
    flat = points @ plane.T
    hull = qhull_of(flat)
    if hull is None:
        return []
    outline = flat[hull.vertices]
    edges = np.roll(outline, -1, axis=0) - outline
    along = edges / np.linalg.norm(edges, axis=1)[:, None]
    normal = np.stack([-along[:, 1], along[:, 0]], axis=1)
    areas = np.ptp(outline @ along.T, axis=0) * np.ptp(outline @ normal.T, axis=0)
    best = int(np.argmin(areas.round(9)))
    return [along[best] @ plane, normal[best] @ plane]


def _fixed_parts(number: int, body: ShapeBody, joints: Sequence[ShapeJoint]) -> list[PartBox]:
    """Return the handles and buttons among a body's visuals, one part for each mesh."""
    carrier = next((j for j in joints if j.child == number), None)
    parts = []
    for mesh in body.visuals:
        if mesh.part:
            points = np.asarray(mesh.vertices, np.float64)
            z = FRONT if carrier is None else _outwards(points, carrier)
            across = np.ptp(points, axis=0) * (np.abs(z) < 0.5)
            x = np.eye(3)[int(np.argmax(across))] if mesh.part == "line_fixed_handle" else _level(z)
            parts.append(_fit_part_box(number, mesh.part, points, x, z, annotated=False))
    return parts


def _outwards(points: Floats, carrier: ShapeJoint) -> Floats:
    """Return the axis along which a handle sets off when its carrier opens."""
    out = carrier.axis if carrier.type == "prismatic" else np.cross(carrier.axis, points.mean(axis=0) - carrier.origin)
    z = np.zeros(3)
    k = int(np.argmax(np.abs(out)))
    z[k] = np.sign(out[k]) or 1.0
    return z


def _fit_part_box(body: int, part_class: str, points: Floats, x: Floats, z: Floats, *, annotated: bool) -> PartBox:
    z = _unit(z - x * (z @ x), _level(x))
    axes = np.stack([x, np.cross(z, x), z])
    along = points @ axes.T
    low, high = along.min(axis=0), along.max(axis=0)
    return PartBox(body, part_class, (low + high) / 2 @ axes, axes, high - low, annotated)


def _level(z: Floats) -> Floats:
    """Return a unit vector across z, level where z is not upright."""
    return _unit(np.cross([0.0, 0.0, 1.0], z), np.array([1.0, 0.0, 0.0]))


def _unit(vector: Floats, otherwise: Floats) -> Floats:
    length = float(np.linalg.norm(vector))
    return np.asarray(vector / length) if length > 1e-6 else otherwise
