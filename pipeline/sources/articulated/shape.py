"""Articulated shapes as they are read: bodies, joints and parts in our orientation, in the source's units."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from pipeline.arrays import Floats, Ints
from pipeline.entities.asset import Joint, Mesh, PartBox
from pipeline.geometry.kinematics import joint_motion
from pipeline.sources.meshes.inertials import Inertial
from pipeline.sources.meshes.visual_meshes import Palette

Note = tuple[str, str, str]  # (what, reason, detail)


@dataclass(slots=True)
class ShapeBody:
    """A rigid body: visual meshes, collision meshes, and what each of its links with geometry states of its mass, if anything."""

    name: str
    visuals: list[Mesh] = field(default_factory=list)
    collisions: list[tuple[Floats, Ints]] = field(default_factory=list)
    inertials: list[Inertial | None] = field(default_factory=list)

    @property
    def empty(self) -> bool:
        """Whether it has no geometry at all."""
        return not self.visuals and not self.collisions

    def points(self) -> Floats:
        """Return the vertices (V, 3) of the visuals, or of the collision meshes where there are none."""
        vertices = [np.asarray(m.vertices, np.float64) for m in self.visuals] or [v[np.unique(f)] for v, f in self.collisions]
        return np.concatenate(vertices) if vertices else np.zeros((0, 3))

    def moved(self, T: Floats) -> ShapeBody:
        """Return the body under the rigid motion T (4, 4)."""
        visuals = [replace(m, vertices=apply(T, np.asarray(m.vertices, np.float64)).astype(np.float32)) for m in self.visuals]
        inertials = [i and i.moved(T) for i in self.inertials]
        return ShapeBody(self.name, visuals, [(apply(T, v), f) for v, f in self.collisions], inertials)


@dataclass(frozen=True, slots=True)
class ShapeJoint(Joint):
    """A moving joint between bodies, in the shape's units. `inferred`: nobody has annotated its part class."""

    inferred: bool = True

    def moved(self, T: Floats) -> ShapeJoint:
        """Return the joint under the rigid motion T (4, 4)."""
        return replace(self, axis=T[:3, :3] @ self.axis, origin=T[:3, :3] @ self.origin + T[:3, 3])

    def opening(self) -> ShapeJoint:
        """Return the joint with its axis turned so that the longer side of the range is positive: from closed, motion opens."""
        return replace(self, axis=-self.axis, lower=-self.upper, upper=-self.lower) if -self.lower > self.upper else self


@dataclass(slots=True)
class ArticulatedShape:
    """What a folder or file holds: bodies (0 is the base), joints parents first, parts by body, and the notes of repairs."""

    source: str
    source_id: str
    model_cat: str
    bodies: list[ShapeBody]
    joints: list[ShapeJoint]
    parts: list[PartBox]
    palette: Palette
    notes: list[Note]

    def bounds(self) -> tuple[Floats, Floats]:
        """Return the corners of the box at rest [units]."""
        points = np.concatenate([m.vertices for b in self.bodies for m in b.visuals])
        return points.min(axis=0).astype(np.float64), points.max(axis=0).astype(np.float64)

    @property
    def extent(self) -> Floats:
        """Extents (3,) of that box [units]."""
        low, high = self.bounds()
        return high - low

    def turned(self, R: Floats) -> ArticulatedShape:
        """Return the shape turned by R (3, 3)."""
        T = np.eye(4)
        T[:3, :3] = R
        turned = self.copied()
        turned.bodies = [body.moved(T) for body in self.bodies]
        turned.joints = [joint.moved(T) for joint in self.joints]
        turned.parts = [_moved_part(part, T) for part in self.parts]
        return turned

    def copied(self) -> ArticulatedShape:
        """Return a shape that can be changed without this one."""
        return replace(self, bodies=list(self.bodies), joints=list(self.joints), parts=list(self.parts), notes=list(self.notes))

    def below(self, body: int) -> list[int]:
        """Return the bodies that move with `body`, itself included, in order."""
        bodies = {body}
        for joint in self.joints:
            if joint.parent in bodies:
                bodies.add(joint.child)
        return sorted(bodies)

    def points_below(self, body: int) -> Floats:
        """Return the points (V, 3) of all that moves with `body`."""
        return np.concatenate([self.bodies[k].points() for k in self.below(body)])

    def shift(self, number: int, q: float) -> tuple[list[int], Floats]:
        """Move what hangs on a joint by `q`, in place; its limits become relative to that. Return the bodies and their motion (4, 4)."""
        joint = self.joints[number]
        T, moved = joint_motion(joint, q), self.below(joint.child)
        for k in moved:
            self.bodies[k] = self.bodies[k].moved(T)
        self.joints = [other.moved(T) if other.parent in moved else other for other in self.joints]
        self.parts = [_moved_part(part, T) if part.link in moved else part for part in self.parts]
        self.joints[number] = replace(joint, lower=joint.lower - q, upper=joint.upper - q)
        return moved, T


def _moved_part(part: PartBox, T: Floats) -> PartBox:
    return replace(part, centre=T[:3, :3] @ part.centre + T[:3, 3], axes=part.axes @ T[:3, :3].T)


def apply(T: Floats, points: Floats) -> Floats:
    """Return points (N, 3) under T (4, 4)."""
    return np.asarray(points @ T[:3, :3].T + T[:3, 3])


def span_of(bodies: Sequence[ShapeBody]) -> float:
    """Return the diagonal of the box around bodies at rest [units], 1 where they have no geometry."""
    points = np.concatenate([body.points() for body in bodies])
    return float(np.linalg.norm(np.ptp(points, axis=0))) if len(points) else 1.0
