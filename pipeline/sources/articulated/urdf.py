"""URDF files, read strictly: no DTD, no entities, no path that leaves the folder; tolerant of other people's quirks.

Quirks that are read: commas between numbers, child before parent, limits without effort and velocity, missing axis or
limit, several visuals of one name, extra attributes and elements, rpy that is nearly a right angle.
"""

import math
import re
from collections import defaultdict
from dataclasses import dataclass
from typing import Any

import numpy as np

from pipeline.arrays import Floats
from pipeline.sources.guarded import xml_root
from pipeline.sources.meshes.inertials import Inertial
from pipeline.sources.reasons import SourceError

MAX_URDF = 8 << 20  # bytes
MAX_ELEMENTS = 100_000
MAX_LINKS = 1000
MAX_SHAPES = 5000
PRIMITIVES: dict[str, dict[str, tuple[float, ...]]] = {  # their sizes where the file does not say
    "box": {"size": (1.0, 1.0, 1.0)},
    "sphere": {"radius": (0.5,)},
    "cylinder": {"radius": (0.5,), "length": (1.0,)},
}
MOMENTS = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")


@dataclass(frozen=True, slots=True)
class Shape:
    """A visual or collision: T_link_shape (4, 4), the mesh's path or a primitive, scale (3,), colour or None."""

    name: str
    T: Floats
    mesh: str
    primitive: tuple[str, tuple[float, ...]]
    scale: Floats
    color: tuple[float, float, float, float] | None


@dataclass(frozen=True, slots=True)
class UrdfLink:
    """A link with its shapes, and the inertial that it states, in the link's frame."""

    name: str
    visuals: tuple[Shape, ...]
    collisions: tuple[Shape, ...]
    inertial: Inertial | None = None


@dataclass(frozen=True, slots=True)
class UrdfJoint:
    """A joint as written: T_parent_joint (4, 4), axis (3,) in the joint's frame, limits or None; `follows`: the joint that it mimics."""

    name: str
    type: str
    parent: str
    child: str
    T: Floats
    axis: Floats
    limits: tuple[float, float] | None
    follows: str = ""


@dataclass(frozen=True, slots=True)
class Urdf:
    """A robot: links by name, joints parents first, and the name of the root link."""

    links: dict[str, UrdfLink]
    joints: tuple[UrdfJoint, ...]
    root: str


def parse_urdf(data: bytes, where: str) -> Urdf:
    """Parse a URDF. Raises SourceError `not_urdf`, `bad_number` or `too_large`, naming `where`."""
    if not data.strip():
        raise SourceError("not_urdf", where, "is empty")
    root = xml_root(data, "not_urdf", where, MAX_ELEMENTS)
    if root.tag != "robot":
        raise SourceError("not_urdf", where, f"its root is <{str(root.tag)[:40]}>, not <robot>")
    colors = {m.get("name", ""): _color(m) for m in root.findall("material")}
    links: dict[str, UrdfLink] = {}
    for element in root.findall("link"):
        name = element.get("name") or ""
        if not name or name in links:
            raise SourceError("not_urdf", where, f"a link is unnamed or named twice ({name[:40]!r})")
        shapes = {k: tuple(_shape(e, colors, where) for e in element.findall(k)) for k in ("visual", "collision")}
        links[name] = UrdfLink(name, shapes["visual"], shapes["collision"], _inertial(element, where))
    joints = [_joint(e, where) for e in root.findall("joint")]
    if len(links) > MAX_LINKS or sum(len(v.visuals) + len(v.collisions) for v in links.values()) > MAX_SHAPES:
        raise SourceError("too_large", where, f"has {len(links)} links")
    return _build_urdf(links, joints, where)


def _build_urdf(links: dict[str, UrdfLink], joints: list[UrdfJoint], where: str) -> Urdf:
    children: dict[str, UrdfJoint] = {}
    for joint in joints:
        if joint.parent not in links or joint.child not in links:
            raise SourceError("not_urdf", where, f"joint {joint.name!r} names a link that is not there")
        if joint.child in children:
            raise SourceError("not_urdf", where, f"link {joint.child!r} has two parents")
        children[joint.child] = joint
    roots = [name for name in links if name not in children]
    if len(roots) != 1:
        raise SourceError("not_urdf", where, f"has {len(roots)} root links, not one tree")
    below: dict[str, list[UrdfJoint]] = defaultdict(list)
    for joint in joints:
        below[joint.parent].append(joint)
    ordered = list(below[roots[0]])
    for joint in ordered:  # which grows: breadth first
        ordered += below[joint.child]
    if len(ordered) != len(joints):
        raise SourceError("not_urdf", where, "has a loop of joints")
    return Urdf(links, tuple(ordered), roots[0])


def _joint(element: Any, where: str) -> UrdfJoint:
    parent, child = (_text(element, end, "link") or "" for end in ("parent", "child"))
    axis = _vector(_text(element, "axis", "xyz"), (1.0, 0.0, 0.0), where)
    length = float(np.linalg.norm(axis))
    axis = axis / length if length > 1e-6 else np.array([1.0, 0.0, 0.0])
    ends = [_text(element, "limit", end) for end in ("lower", "upper")]
    lower, upper = (float(_vector(end, (0.0,), where)[0]) for end in ends)
    limits = None if ends == [None, None] else (lower, upper)
    follows = "" if element.find("mimic") is None else _text(element, "mimic", "joint") or "another"
    kind = (element.get("type") or "fixed").strip()
    return UrdfJoint(element.get("name") or f"{parent}_{child}", kind, parent, child, _origin(element, where), axis, limits, follows)


def _inertial(element: Any, where: str) -> Inertial | None:
    """Return a link's inertial, of nan where it is broken: a wrong mass is no reason to lose a model."""
    inertial = element.find("inertial")
    if inertial is None:
        return None
    try:
        (kg,) = _vector(_text(inertial, "mass", "value"), (math.nan,), where)
        values = [_vector(_text(inertial, "inertia", k), (math.nan,), where, 1e12)[0] for k in MOMENTS]
        T = _origin(inertial, where)
    except SourceError:
        kg, values, T = np.float64(math.nan), [math.nan] * 6, np.eye(4)
    xx, xy, xz, yy, yz, zz = values
    return Inertial(float(kg), np.zeros(3), np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])).moved(T)


def _shape(element: Any, colors: dict[str, Any], where: str) -> Shape:
    geometry = element.find("geometry")
    mesh, scale = "", np.ones(3)
    primitive: tuple[str, tuple[float, ...]] = ("", ())
    for child in list(geometry) if geometry is not None else []:
        if child.tag == "mesh":
            mesh = (child.get("filename") or "").strip()
            scale = _vector(child.get("scale"), (1.0, 1.0, 1.0), where)
        elif child.tag in PRIMITIVES:
            sizes = PRIMITIVES[child.tag].items()
            primitive = (child.tag, tuple(float(v) for k, usual in sizes for v in _vector(child.get(k), usual, where)))
    material = element.find("material")
    color = None
    if material is not None:
        color = _color(material) or colors.get(material.get("name", ""))
    return Shape(element.get("name") or "", _origin(element, where), mesh, primitive, scale, color)


def _color(element: Any) -> tuple[float, float, float, float] | None:
    try:
        r, g, b, a = (min(max(float(v), 0.0), 1.0) for v in re.split(r"[\s,]+", (_text(element, "color", "rgba") or "").strip()))
    except ValueError:
        return None
    return (r, g, b, a) if all(map(math.isfinite, (r, g, b, a))) else None


def _origin(element: Any, where: str) -> Floats:
    """Return the 4x4 transform of <origin xyz rpy>: rotation Rz(y) Ry(p) Rx(r)."""
    T = np.eye(4)
    if element.find("origin") is None:
        return T
    T[:3, 3] = _vector(_text(element, "origin", "xyz"), (0.0, 0.0, 0.0), where)
    r, p, y = _vector(_text(element, "origin", "rpy"), (0.0, 0.0, 0.0), where)
    (cr, cp, cy), (sr, sp, sy) = np.cos([r, p, y]), np.sin([r, p, y])
    T[:3, :3] = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    return T


def _text(element: Any, tag: str, key: str) -> str | None:
    """Return an attribute of an element's child, None where either is missing."""
    child = element.find(tag)
    return None if child is None else child.get(key)


def _vector(text: str | None, default: tuple[float, ...], where: str, most: float = 1e6) -> Floats:
    """Parse numbers separated by blanks or commas, as many as `default` has."""
    if text is None:
        return np.array(default)
    words = [w for w in re.split(r"[\s,]+", text[:400]) if w]
    try:
        values = np.array([float(w) for w in words])
    except ValueError as error:
        raise SourceError("bad_number", where, f"{text[:40]!r} is no list of numbers") from error
    if len(values) != len(default):
        raise SourceError("bad_number", where, f"{text[:40]!r} has {len(values)} numbers, not {len(default)}")
    if not np.isfinite(values).all() or np.abs(values).max() > most:
        raise SourceError("bad_number", where, f"{text[:40]!r} is not finite, or absurd")
    return values
