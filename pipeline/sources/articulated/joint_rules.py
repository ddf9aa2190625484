"""What becomes of a joint as it is written: limits, direction, rest, and screws of two joints."""

import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from pipeline.arrays import Floats
from pipeline.entities.asset import PART_CLASSES, JointType
from pipeline.geometry.kinematics import joint_motion
from pipeline.sources.articulated.part_classes import Mobility, words_of
from pipeline.sources.articulated.shape import ArticulatedShape, Note, ShapeBody, ShapeJoint, apply, span_of
from pipeline.sources.articulated.urdf import UrdfJoint
from pipeline.sources.meshes.mesh_solids import even_directions
from pipeline.sources.meshes.near_boxes import AROUND

TURNS = 4 * math.pi  # [rad] a range beyond this is no limit
SMALLEST = {"revolute": 1e-3, "prismatic": 1e-4}  # ranges [rad, units] below which nothing moves
WORDS = {"revolute": ("hinge",), "prismatic": ("slider", "slider+")}  # mobility_v2.json's for a joint that moves so
MOVING = frozenset({"revolute", "prismatic", "continuous"})
CLOSED = 0.8  # a door or drawer is drawn open when at its other limit the object's box is smaller than this
FOLDED = 0.93  # the same for handles that are pulled out and whatever else can be put away
STEPS = 41  # positions of a hinge that are tried, and again between the neighbours of the best
STROKE = 0.08  # share of the object's diagonal up to which what slides and turns is a knob or cap that turns
TURNED = frozenset({"hinge_knob", "hinge_handle", "hinge_lid", "hinge_door"})
TURNING_WORDS = ("knob", "cap", "dial", "switch", "screw", "lever", "valve", "wheel", "seat", "chair")
DIRECTIONS = np.concatenate([even_directions(100), AROUND / np.linalg.norm(AROUND, axis=1)[:, None]])  # in which outlines reach furthest
Limits = tuple[JointType, float, float]


def limits(joint: UrdfJoint, known: Mobility | None, notes: list[Note]) -> Limits | None:
    """Return (type, lower, upper), or None for a joint that is taken as fixed.

    `known` is PartNet's own entry; it speaks where the URDF has no limit, or one without range.
    """
    if joint.type not in MOVING:
        if joint.type != "fixed":
            notes.append(_note(joint, "joint_unsupported", f"type {joint.type!r}"))
        return None
    if joint.follows:
        notes.append(_note(joint, "joint_mimic", f"follows {joint.follows}"))
    if joint.type == "continuous":
        return "continuous", -math.inf, math.inf
    kind: JointType = "revolute" if joint.type == "revolute" else "prismatic"
    lower, upper = joint.limits or (0.0, 0.0)
    if lower > upper:
        notes.append(_note(joint, "joint_flipped_limits", f"{lower} to {upper}"))
        lower, upper = upper, lower
    if upper - lower < SMALLEST[kind]:
        motion = _from_mobility(joint, kind, known)
        if motion is None:
            notes.append(_note(joint, "joint_no_range", f"{kind}, limits {joint.limits}"))
            return None
        notes.append(_note(joint, "joint_limits_found", f"{kind}, limits {joint.limits} in the URDF, {motion[1:]} in mobility_v2.json"))
        return motion
    if kind == "revolute" and upper - lower > TURNS:
        return "continuous", -math.inf, math.inf
    return kind, lower, upper


def _from_mobility(joint: UrdfJoint, kind: JointType, known: Mobility | None) -> Limits | None:
    if known is None or known.joint not in WORDS[kind]:
        return None
    if known.free and kind == "revolute":
        return "continuous", -math.inf, math.inf
    if known.limits is None:
        return None
    a, b = known.limits
    if known.direction is not None and float(known.direction @ joint.axis) < 0:  # the URDF turned the axis round
        a, b = -a, -b
    lower, upper = min(a, b), max(a, b)
    return (kind, lower, upper) if SMALLEST[kind] <= upper - lower <= TURNS else None


def shift_to_rest(shape: ArticulatedShape) -> None:
    """Bring every joint to its rest, in place: 0 where the limits allow it, else the nearest limit; limits become relative to it."""
    for number in range(len(shape.joints)):
        joint = shape.joints[number]
        rest = min(max(0.0, joint.lower), joint.upper)
        if rest:
            shape.notes.append(
                ("joint", "joint_rest_shifted", f"{joint.name}: by {rest:.4f}, limits {joint.lower:.4f} to {joint.upper:.4f}")
            )
            shape.shift(number, rest)
        shape.joints[number] = shape.joints[number].opening()


def close_drawn_open(shape: ArticulatedShape) -> None:
    """Close, in place, doors, drawers and lids that are drawn open: the object's box is much smaller at their other limit.

    A lid closes where the box is smallest, which need be no limit; it opens from there the way that it was drawn.
    """
    for number, q in _put_away(shape, CLOSED, "drawn open, closed", {"hinge_lid"}):
        shut = shape.joints[number]
        shape.joints[number] = (replace(shut, lower=0.0) if q < 0 else replace(shut, upper=0.0)).opening()
    boxes = [_box(body) for body in shape.bodies]
    for number in range(len(shape.joints)):
        joint = shape.joints[number]
        if joint.part_class not in {"hinge_door", "slider_drawer"} or not math.isfinite(joint.upper):
            continue
        volume = _volume_at(shape, boxes, number)
        ends = [(q, volume(q)) for q in (0.0, joint.lower, joint.upper) if q == 0.0 or abs(q) > 1e-9]
        best = min(ends[1:], key=lambda e: e[1], default=ends[0])
        if best[1] < CLOSED * ends[0][1]:
            shape.notes.append(("joint", "joint_rest_shifted", f"{joint.name}: drawn open, closed by {best[0]:.4f}"))
            shape.shift(number, best[0])
            shape.joints[number] = shape.joints[number].opening()
            boxes = [_box(body) for body in shape.bodies]


def fold_shape(shape: ArticulatedShape) -> ArticulatedShape | None:
    """Return the shape with every joint where the object's box is smallest, None where that is how it is drawn."""
    folded = shape.copied()
    for number, _ in _put_away(folded, FOLDED, "drawn spread out, folded"):
        folded.joints[number] = folded.joints[number].opening()
    return folded if len(folded.notes) > len(shape.notes) else None


def _put_away(shape: ArticulatedShape, share: float, how: str, classes: Collection[str] = PART_CLASSES) -> Iterator[tuple[int, float]]:
    """Bring joints, in place, to where the box around the shape is smallest and below `share` of what it was; yield which, and by how much."""
    chosen = [k for k, joint in enumerate(shape.joints) if joint.part_class in classes and math.isfinite(joint.upper)]
    outlines = [_outline(body) for body in shape.bodies] if chosen else []
    for number in chosen:
        q = _smallest(shape, outlines, number, share)
        if q:
            shape.notes.append(("joint", "joint_rest_shifted", f"{shape.joints[number].name}: {how} by {q:.4f}"))
            moved, T = shape.shift(number, q)
            for k in moved:
                outlines[k] = apply(T, outlines[k])
            yield number, q


def _smallest(shape: ArticulatedShape, outlines: Sequence[Floats], number: int, share: float) -> float:
    """Return the position of a joint at which the box around the bodies' outlines is smallest, 0 where it is not below `share` of that at 0."""
    joint = shape.joints[number]
    volume = _volume_at(shape, outlines, number)
    ends = (joint.lower, joint.upper)
    tried = np.linspace(*ends, STEPS) if joint.type == "revolute" else np.array(ends)
    best = min(tried.tolist(), key=volume)
    if joint.type == "revolute":
        step = (ends[1] - ends[0]) / (STEPS - 1)
        best = min(np.clip(best + np.linspace(-step, step, STEPS), *ends).tolist(), key=volume)
    end = min(ends, key=volume)
    best = end if volume(end) <= 1.02 * volume(best) else best
    return best if abs(best) > 1e-6 and volume(best) < share * volume(0.0) else 0.0


def _volume_at(shape: ArticulatedShape, outlines: Sequence[Floats], number: int) -> Callable[[float], float]:
    """Return the volume of the box around points of the bodies as a function of a joint's position."""
    joint = shape.joints[number]
    moved = shape.below(joint.child)
    still = np.concatenate([np.zeros((0, 3)), *(points for k, points in enumerate(outlines) if k not in moved)])
    mine = np.concatenate([outlines[k] for k in moved])
    return lambda q: float(np.prod(np.ptp(np.concatenate([still, apply(joint_motion(joint, q), mine)]), axis=0)))


def _outline(body: ShapeBody) -> Floats:
    """Return the points (N, 3) of a body that lie furthest in one of many directions: the corners of what is angular."""
    points = body.points()
    if not len(points):
        return points
    few = range(0, len(DIRECTIONS), 8)  # at a time: a mesh may have half a million points
    furthest = np.unique(np.concatenate([np.argmax(points @ DIRECTIONS[k : k + 8].T, axis=0) for k in few]))
    return np.asarray(points[furthest])


def drop_empty(shape: ArticulatedShape, words: Mapping[int, str]) -> None:
    """Leave out, in place, joints to bodies without geometry: helper links of screws, and what moves nothing. `words` name bodies."""
    span = span_of(shape.bodies)
    while odd := next((j for j in shape.joints if shape.bodies[j.child].empty), None):
        after = [j for j in shape.joints if j.parent == odd.child]
        rest = [j for j in shape.joints if j is not odd and j not in after]
        if len(after) == 1:
            kept = _screw(odd, after[0], words.get(after[0].child, ""), span)
            what = f"{odd.name} ({odd.type}) and {after[0].name} ({after[0].type}): {kept.name} is kept"
            shape.notes.append(("joint", "screw_collapsed", what))
            part = after[0] if after[0].part_class != "other" else odd
            after = [replace(kept, parent=odd.parent, child=after[0].child, part_class=part.part_class, inferred=part.inferred)]
        else:
            shape.notes.append(("joint", "joint_moves_nothing", odd.name))
            after = [replace(j, parent=odd.parent) for j in after]
        shape.joints = sorted([*rest, *after], key=lambda j: j.child)


def _screw(first: ShapeJoint, second: ShapeJoint, word: str, span: float) -> ShapeJoint:
    """Return which of two joints in a row stands for both: what a hand does with the part.

    A slide and a turn, in either order: what is a knob, cap or lid by its class or name turns, and so does what slides
    by a few hundredths of the object only; a drawer slides. Of two joints of one kind the one with the longer range.
    """
    if (first.type == "prismatic") == (second.type == "prismatic"):
        return max((second, first), key=lambda j: j.upper - j.lower)
    slide, turn = (first, second) if first.type == "prismatic" else (second, first)
    for joint in (second, first):
        if not joint.inferred:
            return turn if joint.part_class in TURNED else slide
    words = words_of(word)
    if any(w in words for w in TURNING_WORDS):
        return turn
    if "drawer" in words or "button" in words:
        return slide
    return turn if slide.upper - slide.lower <= STROKE * span else slide


def _box(body: ShapeBody) -> Floats:
    """Return the corners (8, 3) of a body's box, (0, 3) of an empty one."""
    points = body.points()
    if not len(points):
        return points
    low, high = points.min(axis=0), points.max(axis=0)
    return np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])


def _note(joint: UrdfJoint, reason: str, detail: str) -> Note:
    return "joint", reason, f"{joint.name}: {detail}"
