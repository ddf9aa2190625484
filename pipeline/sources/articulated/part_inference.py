"""Part classes and boxes that nobody has annotated, from shapes that stand upright with their front towards -y."""

from dataclasses import replace

import numpy as np

from pipeline.sources.articulated import joint_rules
from pipeline.sources.articulated.part_boxes import fixed_parts, mover_part
from pipeline.sources.articulated.part_classes import shaped_class
from pipeline.sources.articulated.shape import ArticulatedShape, ShapeBody, ShapeJoint, ShapePart, below


def complete_shape(shape: ArticulatedShape) -> ArticulatedShape:
    """Return the shape with a class for every joint that its form tells, doors and drawers closed, and all part boxes."""
    bodies, parts, notes = list(shape.bodies), list(shape.parts), list(shape.notes)
    joints = _classify_joints(bodies, list(shape.joints))
    joint_rules.close_drawn_open(bodies, joints, parts, notes)
    parts += _inferred_parts(bodies, joints, parts)
    return replace(shape, bodies=tuple(bodies), joints=tuple(joints), parts=tuple(parts), notes=tuple(notes))


def _classify_joints(bodies: list[ShapeBody], joints: list[ShapeJoint]) -> list[ShapeJoint]:
    points = [body.points() for body in bodies]
    everything = np.concatenate(points)
    low, whole = everything.min(axis=0), np.ptp(everything, axis=0)
    middle = np.array([low[0] + whole[0] / 2, low[1] + whole[1] / 2, low[2]])
    classed_joints = []
    for joint in joints:
        if joint.part_class == "other" and joint.inferred:
            mine = np.concatenate([points[k] for k in sorted(below(joints, joint.child))]) - middle
            part = shaped_class(joint.type, joint.axis, mine.min(axis=0), mine.max(axis=0), whole)
            classed_joints.append(replace(joint, part_class=part))
        else:
            classed_joints.append(joint)
    return classed_joints


def _inferred_parts(bodies: list[ShapeBody], joints: list[ShapeJoint], parts: list[ShapePart]) -> list[ShapePart]:
    """Return boxes of the movers and fixed handles for which no annotation has one."""
    known = {(p.body, p.part_class) for p in parts}
    movers = [mover_part(bodies[j.child], j) for j in joints if j.part_class != "other" and (j.child, j.part_class) not in known]
    fixed = [part for k, body in enumerate(bodies) for part in fixed_parts(k, body, joints) if (k, part.part_class) not in known]
    return movers + fixed
