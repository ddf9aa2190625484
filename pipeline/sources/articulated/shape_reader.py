"""URDF trees to articulated shapes: bodies of links that do not move against each other, joints between them, parts."""

import itertools
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import PurePosixPath

import numpy as np

from pipeline.arrays import Floats
from pipeline.entities.asset import Mesh, PartBox
from pipeline.sources.articulated import joint_rules
from pipeline.sources.articulated.mesh_files import MeshFiles
from pipeline.sources.articulated.part_classes import Annotation, Mobility, box_of, fixed_class, named_class
from pipeline.sources.articulated.shape import ArticulatedShape, Note, ShapeBody, ShapeJoint, span_of
from pipeline.sources.articulated.urdf import Shape, Urdf, UrdfLink
from pipeline.sources.guarded import Folder
from pipeline.sources.meshes.near_boxes import FACES
from pipeline.sources.meshes.obj_file import MeshMaterial, ObjFile, ObjGroup, linear
from pipeline.sources.meshes.visual_meshes import Palette, visual_mesh
from pipeline.sources.reasons import SourceError

LIKE = 0.03  # share of the object's diagonal within which the boxes of two sets of meshes of a body agree
PLAIN = 0.6  # roughness of what has no more than a colour
POST = 0.02  # the same for the thickness of the post that stands in for a frame that a door lacks


@dataclass(frozen=True, slots=True)
class Hints:
    """What a source says beside its URDF: annotations and semantics by link, PartNet's own joints, and a second URDF for looks."""

    annotated: Mapping[str, Annotation] = field(default_factory=dict)
    named: Mapping[str, str] = field(default_factory=dict)
    mobility: Mapping[str, Mobility] = field(default_factory=dict)
    looks: Urdf | None = None


class ShapeReader:
    """Reads one URDF: `base` is the folder of its paths, `frame` (3, 3) turns its root's frame into ours."""

    def __init__(self, folder: Folder, base: str, urdf: Urdf, frame: Floats, hints: Hints, texture_limit: int) -> None:
        self.urdf, self.hints, self.frame, self.base = urdf, hints, frame, base
        self.moving: set[str] = set()  # links that hang on a moving joint of their own
        self.palette = Palette(folder, texture_limit)
        self.notes: list[Note] = []
        self.files = MeshFiles(folder, base, self.notes)

    def shape(self, source: str, source_id: str, model_cat: str) -> ArticulatedShape:
        """Return the shape at rest, with the parts that are annotated (`complete_shape` finds the others).

        Raises SourceError `no_base`, or what a mesh file raises.
        """
        T = self._transforms(self.urdf)
        body_of, bodies, joints = self._tree(T)
        for name, link in self.urdf.links.items():
            body = bodies[body_of[name]]
            body.visuals += self._visuals(link, T[name], len(body.visuals))
            if link.visuals or link.collisions:
                body.inertials.append(link.inertial and link.inertial.moved(T[name]))
            body.collisions += [(points, group.faces) for _, group, _, points in self.files.geometry(link.collisions, T[name])]
        self._borrow_looks(bodies, body_of)
        shape = ArticulatedShape(source, source_id, model_cat, bodies, joints, [], self.palette, self.notes)
        joint_rules.drop_empty(shape, {body_of[name]: word for name, word in self.hints.named.items() if name in body_of})
        used = [0, *(j.child for j in shape.joints)]  # the others move with nothing
        index = {old: new for new, old in enumerate(used)}
        shape.bodies = [bodies[k] for k in used]
        shape.joints = [replace(j, parent=index[j.parent], child=index[j.child]) for j in shape.joints]
        self._ensure_base(shape)
        shape.parts = [
            PartBox(index[body_of[name]], note.part_class, *box_of(note.corners @ self.frame.T), annotated=True)
            for name, note in self.hints.annotated.items()
            if note.corners is not None and body_of.get(name) in index
        ]
        joint_rules.shift_to_rest(shape)
        for body in shape.bodies:
            if not body.collisions:
                body.collisions = [(m.vertices.astype(np.float64), m.faces.astype(np.int64)) for m in body.visuals]
        names = distinct_names(slug(j.name) for j in shape.joints)
        shape.joints = [replace(j, name=name) for j, name in zip(shape.joints, names, strict=True)]
        shape.notes += (("model", reason, detail) for reason, detail in self.palette.notes)
        return shape

    def _transforms(self, urdf: Urdf) -> dict[str, Floats]:
        """Return the pose (4, 4) of every link with all joints at 0, in our orientation."""
        T = {urdf.root: np.eye(4)}
        T[urdf.root][:3, :3] = self.frame
        for joint in urdf.joints:
            T[joint.child] = T[joint.parent] @ joint.T
        return T

    def _tree(self, T: Mapping[str, Floats]) -> tuple[dict[str, int], list[ShapeBody], list[ShapeJoint]]:
        """Return the body of every link, the bodies, still empty, and the moving joints."""
        bodies = [ShapeBody(slug(self.urdf.root))]
        body_of = {self.urdf.root: 0}
        joints: list[ShapeJoint] = []
        for joint in self.urdf.joints:
            limits = joint_rules.limits(joint, self.hints.mobility.get(joint.child), self.notes)
            if limits is None:
                body_of[joint.child] = body_of[joint.parent]
                continue
            kind, lower, upper = limits
            self.moving.add(joint.child)
            body_of[joint.child] = child = len(bodies)
            part, inferred = self._part_class(joint.child, kind)
            axis, origin = T[joint.child][:3, :3] @ joint.axis, T[joint.child][:3, 3].copy()
            ends = body_of[joint.parent], child
            joints.append(ShapeJoint(joint.name, kind, *ends, axis, origin, lower, upper, part, inferred=inferred))
            bodies.append(ShapeBody(slug(joint.child)))
        return body_of, bodies, joints

    def _part_class(self, link: str, kind: str) -> tuple[str, bool]:
        """Return (part class, whether inferred) of a moving link, "other" where nothing but its shape can tell."""
        if link in self.hints.annotated:
            return self.hints.annotated[link].part_class, False
        known = self.hints.mobility.get(link)
        return named_class(kind, self.hints.named.get(link) or (known.name if known else "")) or "other", True

    def _visuals(self, link: UrdfLink, T: Floats, start: int) -> list[Mesh]:
        meshes: list[Mesh] = []
        for shape, group, file, points in self.files.geometry(link.visuals, T):
            extent = np.ptp(points[group.faces.ravel()], axis=0)
            part = fixed_class(link.name, shape.name, self.hints.annotated, extent, moves=link.name in self.moving)
            material = self._material(shape, file, group)
            mesh = visual_mesh(group, file, points, f"mesh_{start + len(meshes):03d}", material, part)
            if mesh:
                meshes.append(mesh)
        return meshes

    def _material(self, shape: Shape, file: ObjFile, group: ObjGroup) -> int:
        own = self.files.materials.get(shape.mesh, {}).get(group.material)
        base = PurePosixPath(self.base, self.files.place(shape.mesh).replace("\\", "/")).parent.as_posix() if shape.mesh else ""
        base = "" if base == "." else base
        if own is None and shape.color and not file.library:
            own = MeshMaterial(linear(shape.color[:3]), shape.color[3], PLAIN)
        if own is not None:
            return self.palette.index(own, base, f"{shape.mesh}#{group.material}")
        return self.palette.named(file.library, base, group.material)

    def _borrow_looks(self, bodies: list[ShapeBody], body_of: Mapping[str, int]) -> None:
        """Take the visuals of the second URDF where it has the same links in the same places; else keep our own."""
        looks = self.hints.looks
        if looks is None:
            return
        T = self._transforms(looks)
        owner = {looks.root: body_of.get(looks.root, 0)}
        for joint in looks.joints:
            owner[joint.child] = body_of.get(joint.child, owner[joint.parent])
        borrowed = [ShapeBody(body.name) for body in bodies]
        for name, link in looks.links.items():
            body = borrowed[owner[name]]
            body.visuals += self._visuals(link, T[name], len(body.visuals))
        span = span_of(bodies)
        if all(_alike(a, b, span) for a, b in zip(bodies, borrowed, strict=True)):
            for body, other in zip(bodies, borrowed, strict=True):
                body.visuals = other.visuals
        else:
            self.notes.append(("model", "looks_differ", "the meshes of the URDF for looks are not where the annotated ones are"))

    def _ensure_base(self, shape: ArticulatedShape) -> None:
        """See that every body has visuals, and the base something to be seen at all."""
        for body in shape.bodies:
            if not body.visuals and body.collisions:
                material = self.palette.index(MeshMaterial(linear((0.7, 0.7, 0.7)), roughness=PLAIN), "")
                body.visuals = [
                    Mesh(f"mesh_{k:03d}", v.astype(np.float32), f.astype(np.int32), material) for k, (v, f) in enumerate(body.collisions)
                ]
                self.notes.append(("model", "looks_from_colliders", body.name))
        if shape.bodies[0].visuals:
            return
        carried = [j for j in shape.joints if j.parent == 0]
        if [j.type for j in carried] != ["revolute"] or any(reason == "missing_mesh" for _, reason, _ in self.notes):
            raise SourceError("no_base", shape.source_id, "its root body has no geometry")
        material = self.palette.index(MeshMaterial(linear((0.6, 0.6, 0.6)), roughness=PLAIN), "")
        shape.bodies[0].visuals = [Mesh("post", _post(shape, carried[0]).astype(np.float32), FACES.astype(np.int32), material)]
        self.notes.append(("model", "base_made", f"a post along the hinge {carried[0].name}"))


def _alike(body: ShapeBody, other: ShapeBody, span: float) -> bool:
    if not body.visuals or not other.visuals:
        return not body.visuals and not other.visuals
    a, b = body.points(), other.points()
    away = np.maximum(np.abs(a.min(axis=0) - b.min(axis=0)), np.abs(a.max(axis=0) - b.max(axis=0)))
    return float(away.max()) <= LIKE * span


def _post(shape: ArticulatedShape, hinge: ShapeJoint) -> Floats:
    """Return the corners (8, 3) of a square post along a hinge, on the far side of it from its leaf."""
    points = shape.points_below(hinge.child)
    along = (points - hinge.origin) @ hinge.axis
    thick = POST * float(np.linalg.norm(np.ptp(points, axis=0)))
    out = hinge.origin - points.mean(axis=0)
    out = out - hinge.axis * (out @ hinge.axis)
    length = float(np.linalg.norm(out))
    across = out / length if length > 1e-9 else np.cross(hinge.axis, [1.0, 0.3, 0.2])
    across = across / np.linalg.norm(across)
    side = np.cross(hinge.axis, across)
    reach = float(((points - hinge.origin) @ across).max())
    corners = [
        hinge.origin + hinge.axis * a + across * (max(reach, 0.0) + b * thick) + side * (c - 0.5) * thick
        for a in (along.min(), along.max()) for b in (0, 1) for c in (0, 1)
    ]  # fmt: skip
    return np.array(corners)


def distinct_names(names: Iterable[str]) -> list[str]:
    """Return the names, with a number behind those that another before them has."""
    kept: list[str] = []
    for name in names:
        candidates = itertools.chain([name], (f"{name}_n{number}" for number in itertools.count(2)))
        kept.append(next(candidate for candidate in candidates if candidate not in kept))
    return kept


def slug(name: str) -> str:
    """Return a name that matches [a-z][a-z0-9_]*, of at most 48 characters."""
    plain = re.sub(r"[^a-z0-9]+", "_", name.lower()).strip("_")[:48]
    return plain if plain[:1].isalpha() else f"n_{plain}"
