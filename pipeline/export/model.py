"""What every format must say of a home: bodies, joints, what one sees of them, what collides; all closed and at rest.

Metres, kilograms, radians, Z up; lengths within a body are in the body's frame. Transforms are (4, 4), T_parent_child, and rigid.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pipeline.arrays import Floats


def inverse(T: Floats) -> Floats:
    """Return T_child_parent of T_parent_child."""
    return np.asarray(np.linalg.inv(T), np.float64)


@dataclass(frozen=True, slots=True)
class Material:
    """How a surface looks; `color` is linear RGB, `texture` a picture that takes its place."""

    name: str
    color: tuple[float, float, float]
    roughness: float
    metallic: float
    opacity: float
    texture: Path | None


@dataclass(frozen=True, slots=True, eq=False)
class Surface:
    """Triangles of one material. `points` and `normals` (n, 3), `uv` (n, 2) or None (v upwards), `faces` (m, 3).

    `group` tells apart what belongs to one body: "handle", "floor", "ceiling"; "" is the rest.
    """

    name: str
    group: str
    material: Material
    points: NDArray[np.float32]
    normals: NDArray[np.float32]
    uv: NDArray[np.float32] | None
    faces: NDArray[np.int32]


@dataclass(frozen=True, slots=True, eq=False)
class Box:
    """A collider: a box along its body's axes, `center` (3,) and half extents `half` (3,) [m]; `prim` is its path below the model's root."""

    center: Floats
    half: Floats
    friction: float
    prim: str


@dataclass(frozen=True, slots=True, eq=False)
class Hull:
    """A collider: the convex hull of `points` (n, 3) with triangles `faces` (m, 3); `prim` is its path below the model's root."""

    name: str
    points: NDArray[np.float32]
    faces: NDArray[np.int32]
    friction: float
    prim: str


@dataclass(frozen=True, slots=True, eq=False)
class Inertia:
    """Mass [kg], its centre (3,), principal moments (3,) [kg m2] and the quaternion (w, x, y, z) of their axes."""

    mass: float
    center: Floats
    moments: Floats
    axes: Floats


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """One rigid part. `inertia` is None for what never moves; `handle` (3,) is the middle of what a hand takes hold of, or None."""

    name: str
    T_model_body: Floats
    inertia: Inertia | None
    surfaces: tuple[Surface, ...]
    boxes: tuple[Box, ...]
    hulls: tuple[Hull, ...]
    handle: Floats | None


@dataclass(frozen=True, slots=True, eq=False)
class Joint:
    """A hinge, a slide or a weld ("fixed") between two bodies of a model; `parent` -1 is the ground.

    `axis` (3,) is in the joint's frame; limits and resistance in rad or m, N m or N; infinite limits mean none.
    A spring of `stiffness` pulls towards `rest`. `stops` are MuJoCo's solref and solimp of the limits, where the stage names them. `after` are joints that must be open first.
    """

    name: str
    kind: str
    parent: int
    child: int
    T_parent_joint: Floats
    T_child_joint: Floats
    axis: Floats
    lower: float
    upper: float
    damping: float
    friction: float
    armature: float
    stiffness: float
    rest: float
    stops: tuple[tuple[float, ...], ...]
    after: tuple[str, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Model:
    """A thing that can be placed. `grounded` are the bodies that the ground holds; every body has at most one joint to its parent.

    `passes` are pairs of bodies that do not collide. `shared`: of the library, not of one home.
    """

    name: str
    shared: bool
    bodies: tuple[Body, ...]
    joints: tuple[Joint, ...]
    grounded: frozenset[int]
    passes: tuple[tuple[int, int], ...]

    @property
    def still(self) -> bool:
        """Whether nothing of it ever moves."""
        return not self.joints and len(self.grounded) == len(self.bodies)

    def surfaces(self) -> list[Surface]:
        """Return the surfaces of all bodies."""
        return [surface for body in self.bodies for surface in body.surfaces]

    def materials(self) -> list[Material]:
        """Return the materials of all surfaces, each once."""
        return list(dict.fromkeys(surface.material for surface in self.surfaces()))

    def without(self, off: frozenset[str]) -> "Model":
        """Return the model without the colliders of these prims."""

        def kept(body: Body) -> Body:
            boxes, hulls = (box for box in body.boxes if box.prim not in off), (hull for hull in body.hulls if hull.prim not in off)
            return replace(body, boxes=tuple(boxes), hulls=tuple(hulls))

        return replace(self, bodies=tuple(map(kept, self.bodies))) if off else self


@dataclass(frozen=True, slots=True, eq=False)
class Placed:
    """A model in a home: where, and at which `scale` (3,), which is 1 for what moves. `support` is what it stands on.

    `off` are the prims of its colliders that the home switches off, because others are felt there.
    """

    name: str
    kind: str
    model: str
    T_world_model: Floats
    scale: Floats
    support: str
    off: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """A home: its models by name, and where they are; what is slower than `asleep` [m/s] may sleep."""

    scene_id: str
    models: Mapping[str, Model]
    placed: tuple[Placed, ...]
    asleep: float = 0.0
