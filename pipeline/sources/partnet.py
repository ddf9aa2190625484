"""PartNet-Mobility and GAPartNet folders to articulated shapes without a metric size.

PartNet's world (z up, front -x) to ours (z up, front -y): (x, y, z) = (-Y, X, Z). The URDF's first fixed joint turns
the mesh frame (y up, front +z) into that world, so mesh (x, y, z) ends as ours (x, -z, y).
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field, replace
from pathlib import PurePosixPath

import numpy as np
from numpy.typing import NDArray

from pipeline.entities.asset import JointType, Mesh
from pipeline.geometry.kinematics import rotation
from pipeline.sources.guarded import MIB, Folder, read_json
from pipeline.sources.obj_file import MAX_OBJ, ObjFile, ObjGroup, parse_obj
from pipeline.sources.part_classes import joint_class, link_classes, semantics, text_field, visual_class
from pipeline.sources.primitives import MAX_STL, parse_stl, primitive
from pipeline.sources.reasons import SourceError
from pipeline.sources.surfaces import Palette, visual
from pipeline.sources.urdf import MAX_URDF, Shape, Urdf, UrdfJoint, UrdfLink, parse_urdf

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

URDFS = (("mobility_annotation_gapartnet.urdf", "gapartnet"), ("mobility.urdf", "partnet-mobility"))
FROM_PARTNET = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
TURNS = 4 * math.pi  # [rad] a range beyond this is no limit
SMALLEST = {"revolute": 1e-3, "prismatic": 1e-4}  # ranges [rad, units] below which nothing moves
MOVING = frozenset({"revolute", "prismatic", "continuous"})


@dataclass(slots=True)
class ShapeBody:
    """A rigid body in units of the source: visual meshes, collision meshes."""

    name: str
    visuals: list[Mesh] = field(default_factory=list)
    collisions: list[tuple[Floats, Ints]] = field(default_factory=list)

    @property
    def empty(self) -> bool:
        """Whether it has no geometry at all."""
        return not self.visuals and not self.collisions


@dataclass(frozen=True, slots=True)
class ShapeJoint:
    """A moving joint in our orientation and the source's units, at rest; positive motion opens."""

    name: str
    type: JointType
    parent: int
    child: int
    axis: Floats
    origin: Floats
    lower: float
    upper: float
    part_class: str


@dataclass(frozen=True, slots=True)
class ArticulatedShape:
    """What a folder holds: bodies (0 is the base), joints parents first, and (what, reason, detail) of repairs."""

    source: str
    source_id: str
    model_cat: str
    bodies: tuple[ShapeBody, ...]
    joints: tuple[ShapeJoint, ...]
    palette: Palette
    notes: tuple[tuple[str, str, str], ...]

    def bounds(self) -> tuple[Floats, Floats]:
        """Return the corners of the box at rest [units]."""
        points = np.concatenate([m.vertices for b in self.bodies for m in b.visuals])
        return points.min(axis=0).astype(np.float64), points.max(axis=0).astype(np.float64)


def read_shape(folder: Folder, source_id: str, texture_limit: int) -> ArticulatedShape:
    """Read the folder of one object. Raises SourceError for what cannot be used."""
    model_cat = text_field(read_json(folder, "meta.json", MIB), "model_cat")
    name, source = next(((n, s) for n, s in URDFS if folder.has(n)), ("", ""))
    if not name:
        for candidate, _ in URDFS:
            folder.path(candidate)  # says what is wrong with a link or a pipe of that name
    urdf = parse_urdf(folder.read(name, MAX_URDF), name)
    return _Reader(folder, urdf, link_classes(folder), semantics(folder), texture_limit).shape(source, source_id, model_cat)


class _Reader:
    """State of reading one folder: meshes by path, materials, notes."""

    def __init__(self, folder: Folder, urdf: Urdf, annotated: dict[str, str], named: dict[str, str], texture_limit: int) -> None:
        self.folder, self.urdf, self.annotated, self.named = folder, urdf, annotated, named
        self.palette = Palette(folder, texture_limit)
        self.files: dict[str, ObjFile | None] = {}
        self.notes: list[tuple[str, str, str]] = []

    def shape(self, source: str, source_id: str, model_cat: str) -> ArticulatedShape:
        """Return the bodies and joints."""
        T = {self.urdf.root: np.eye(4)}
        T[self.urdf.root][:3, :3] = FROM_PARTNET
        bodies = [ShapeBody(_slug(self.urdf.root))]
        body_of = {self.urdf.root: 0}
        joints: list[ShapeJoint] = []
        moves: set[str] = set()
        for joint in self.urdf.joints:
            T_joint = T[joint.parent] @ joint.T
            limits = self._limits(joint)
            if limits is None:
                body_of[joint.child], T[joint.child] = body_of[joint.parent], T_joint
                continue
            kind, lower, upper, rest = limits
            T[joint.child] = T_joint @ _motion(kind, joint.axis, rest)
            body_of[joint.child] = len(bodies)
            moves.add(joint.child)
            bodies.append(ShapeBody(_slug(joint.child)))
            axis = T_joint[:3, :3] @ joint.axis
            part = joint_class(joint.child, kind, self.annotated, self.named)
            made = ShapeJoint(joint.name, kind, body_of[joint.parent], len(bodies) - 1, axis, T_joint[:3, 3].copy(), lower, upper, part)
            joints.append(_opening(made))
        for name, link in self.urdf.links.items():
            self._fill(bodies[body_of[name]], link, T[name], moves=name in moves)
        bodies, joints = self._without_empty(bodies, joints)
        if not bodies[0].visuals:
            raise SourceError("no_base", source_id, "its root body has no geometry")
        for body in bodies:
            if not body.collisions:
                body.collisions = [(m.vertices.astype(np.float64), m.faces.astype(np.int64)) for m in body.visuals]
        notes = [*self.notes, *(("model", reason, detail) for reason, detail in self.palette.notes)]
        return ArticulatedShape(source, source_id, model_cat, tuple(bodies), tuple(_named(joints)), self.palette, tuple(notes))

    def _limits(self, joint: UrdfJoint) -> tuple[JointType, float, float, float] | None:
        """Return (type, lower, upper, rest) with limits about the rest, or None for a joint that is taken as fixed."""
        if joint.type == "fixed":
            return None
        if joint.type not in MOVING:
            self._note(joint, "joint_unsupported", f"type {joint.type!r}")
            return None
        if joint.type == "continuous":
            return "continuous", -math.inf, math.inf, 0.0
        kind: JointType = "revolute" if joint.type == "revolute" else "prismatic"
        lower, upper = joint.limits or (0.0, 0.0)
        if lower > upper:
            self._note(joint, "joint_flipped_limits", f"{lower} to {upper}")
            lower, upper = upper, lower
        if upper - lower < SMALLEST[kind]:
            self._note(joint, "joint_no_range", f"{kind}, limits {joint.limits}")
            return None
        if kind == "revolute" and upper - lower > TURNS:
            return "continuous", -math.inf, math.inf, 0.0
        rest = min(max(0.0, lower), upper)
        if rest:
            self._note(joint, "joint_rest_shifted", f"by {rest:.4f}, limits {lower} to {upper}")
        return kind, lower - rest, upper - rest, rest

    def _note(self, joint: UrdfJoint, reason: str, detail: str) -> None:
        self.notes.append(("joint", reason, f"{joint.name}: {detail}"))

    def _fill(self, body: ShapeBody, link: UrdfLink, T: Floats, *, moves: bool) -> None:
        for shape in link.visuals:
            part = visual_class(link.name, shape.name, self.annotated, moves=moves)
            for group, file, points in self._geometry(shape, T):
                material = self._material(shape, file, group)
                mesh = visual(group, file, points, f"mesh_{len(body.visuals):03d}", material, part)
                if mesh:
                    body.visuals.append(mesh)
        for shape in link.collisions:
            for group, _, points in self._geometry(shape, T):
                body.collisions.append((points, group.faces))

    def _geometry(self, shape: Shape, T: Floats) -> list[tuple[ObjGroup, ObjFile, Floats]]:
        """Return the groups of a shape with their file and its vertices in our orientation; mirrored scales turn faces."""
        if shape.mesh:
            file = self._file(shape.mesh)
        elif shape.primitive[0]:
            vertices, faces = primitive(*shape.primitive, shape.name)
            file = _plain(vertices, faces)
        else:
            return []
        if file is None:
            return []
        T_shape = T @ shape.T
        points = (file.vertices * shape.scale) @ T_shape[:3, :3].T + T_shape[:3, 3]
        groups = file.groups
        if np.prod(shape.scale) < 0:
            groups = tuple(replace(g, faces=g.faces[:, ::-1], uv_faces=g.uv_faces[:, ::-1]) for g in groups)
        return [(group, file, points) for group in groups if len(group.faces)]

    def _file(self, path: str) -> ObjFile | None:
        """Return a mesh file, read once; a missing one is noted, one that is broken or outside the folder raises."""
        if path not in self.files:
            try:
                self.files[path] = self._load(path)
            except SourceError as error:
                if error.code != "missing_file":
                    raise
                self.notes.append(("model", "missing_mesh", f"{path}: {error.detail}"))
                self.files[path] = None
        return self.files[path]

    def _load(self, path: str) -> ObjFile:
        suffix = path.lower().rsplit(".", 1)[-1]
        if suffix == "obj":
            return parse_obj(self.folder.read(path, MAX_OBJ), path)
        if suffix == "stl":
            return _plain(*parse_stl(self.folder.read(path, MAX_STL), path))
        self.folder.path(path)  # a path that leaves the folder is refused whatever it names
        raise SourceError("missing_file", path, f"is of a kind that is not read ({suffix[:10]})")

    def _material(self, shape: Shape, file: ObjFile, group: ObjGroup) -> int:
        if shape.color and not file.library:
            return self.palette.add(shape.color[:3], shape.color[3], None)
        base = str(PurePosixPath(shape.mesh.replace("\\", "/")).parent) if shape.mesh else ""
        return self.palette.index(file.library, "" if base == "." else base, group.material)

    def _without_empty(self, bodies: list[ShapeBody], joints: list[ShapeJoint]) -> tuple[list[ShapeBody], list[ShapeJoint]]:
        """Leave out moving bodies without geometry: helper links of screws, and what moves nothing."""
        while True:
            odd = next((j for j in joints if bodies[j.child].empty), None)
            if odd is None:
                break
            after = [j for j in joints if j.parent == odd.child]
            rest = [j for j in joints if j is not odd and j not in after]
            if len(after) == 1:
                self.notes.append(("joint", "screw_collapsed", f"{odd.name} and {after[0].name}"))
                kept = odd if odd.type == "prismatic" or after[0].type != "prismatic" else after[0]
                part = after[0].part_class if after[0].part_class != "other" else odd.part_class
                after = [replace(kept, parent=odd.parent, child=after[0].child, part_class=part)]
            else:
                self.notes.append(("joint", "joint_moves_nothing", odd.name))
                after = [replace(j, parent=odd.parent) for j in after]
            joints = sorted([*rest, *after], key=lambda j: j.child)
        used = [0, *(j.child for j in joints)]
        index = {old: new for new, old in enumerate(used)}
        return [bodies[k] for k in used], [replace(j, parent=index[j.parent], child=index[j.child]) for j in joints]


def _opening(joint: ShapeJoint) -> ShapeJoint:
    """Turn the axis so that the longer side of the range is positive: from closed, motion opens."""
    if -joint.lower > joint.upper:
        return replace(joint, axis=-joint.axis, lower=-joint.upper, upper=-joint.lower)
    return joint


def _motion(kind: JointType, axis: Floats, position: float) -> Floats:
    T = np.eye(4)
    if kind == "prismatic":
        T[:3, 3] = axis * position
    elif position:
        T[:3, :3] = rotation(axis, position)
    return T


def _plain(vertices: Floats, faces: Ints) -> ObjFile:
    return ObjFile(vertices, np.zeros((0, 2)), (ObjGroup("", "", faces, np.full_like(faces, -1)),), "")


def _named(joints: list[ShapeJoint]) -> list[ShapeJoint]:
    """Give joints ids that are unique in the asset and match [a-z][a-z0-9_]*."""
    taken: set[str] = set()
    named = []
    for number, joint in enumerate(joints):
        name = _slug(joint.name)
        name = name if name not in taken else f"{name}_n{number}"
        taken.add(name)
        named.append(replace(joint, name=name))
    return named


def _slug(name: str) -> str:
    plain = re.sub(r"[^a-z0-9]+", "_", name.lower()).strip("_")
    return plain if plain[:1].isalpha() else f"n_{plain}"
