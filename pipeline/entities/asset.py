"""An asset: links of visual meshes and convex colliders, joined in a tree, at rest with all joints at 0."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

JointType = Literal["revolute", "prismatic", "continuous"]

# GAPartNet's nine part classes, in the order of its code (formats.md 2.2), then what it does not cover.
PART_CLASSES = (
    "line_fixed_handle",
    "round_fixed_handle",
    "slider_button",
    "hinge_door",
    "slider_drawer",
    "slider_lid",
    "hinge_lid",
    "hinge_knob",
    "hinge_handle",
    "other",
)


@dataclass(frozen=True, slots=True)
class Material:
    """A preview surface. `base_color` is linear RGB in [0, 1]; `texture` a path relative to the asset's folder."""

    name: str
    base_color: tuple[float, float, float] = (0.8, 0.8, 0.8)
    roughness: float = 0.6
    metallic: float = 0.0
    opacity: float = 1.0
    texture: str | None = None


@dataclass(frozen=True, slots=True)
class Mesh:
    """A triangle mesh in the object frame at rest.

    `vertices` (V, 3) float32 [m]; `faces` (F, 3) int32, counter-clockwise seen from outside; `uv` (V, 2) or None;
    `material` indexes the asset's materials; `part` is a GAPartNet class for handles and buttons that are fixed to
    the link ("" for the rest), so that they can be found by name downstream.
    """

    name: str
    vertices: NDArray[np.float32]
    faces: NDArray[np.int32]
    material: int = 0
    uv: NDArray[np.float32] | None = None
    part: str = ""


@dataclass(frozen=True, slots=True)
class Link:
    """A rigid body. Colliders are convex, one convex piece each; `mass` [kg]; `com` (3,) [m], object frame at rest.

    `inertia` (3, 3) [kg m2] about `com`, along the object frame's axes.
    """

    name: str
    visuals: tuple[Mesh, ...]
    colliders: tuple[Mesh, ...]
    mass: float
    com: NDArray[np.float64]
    inertia: NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Joint:
    """Moves `child` against `parent` (indices into the asset's links).

    `axis` (3,) unit and `origin` (3,) [m] in the object frame at rest; positive motion opens. Limits in rad
    (revolute) or m (prismatic), lower <= 0 <= upper; a continuous joint has limits (-inf, inf).
    `part_class` is one of PART_CLASSES. `after` names the asset's joints that must be open before this one can move: a drawer
    waits for the door before it.
    """

    name: str
    type: JointType
    parent: int
    child: int
    axis: NDArray[np.float64]
    origin: NDArray[np.float64]
    lower: float
    upper: float
    part_class: str
    after: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class PartBox:
    """The oriented box of a part of `part_class` on link `link` (index), object frame at rest.

    `centre` (3,) [m]; `axes` (3, 3) unit rows x, y, z, right-handed; `size` (3,) [m] along them. z looks outwards; x is
    a hinge's axis in the opening sense, or the long side of a handle. `annotated`: the class is the source's own, not
    inferred from names and shape.
    """

    link: int
    part_class: str
    centre: NDArray[np.float64]
    axes: NDArray[np.float64]
    size: NDArray[np.float64]
    annotated: bool


@dataclass(frozen=True, slots=True)
class Asset:
    """A piece of furniture or an appliance. Link 0 is the base; `joints` are ordered parents first.

    `size` (3,) [m] is the full extent (w, d, h) = (x, y, z) of the box with all joints at 0. Fixed joints of the
    source are already merged into their parent links. `derived` keeps what was computed from it (see `geometry.memo`), as long as it lives.
    """

    asset_id: str
    category: str
    size: NDArray[np.float64]
    links: Sequence[Link]
    joints: tuple[Joint, ...]
    materials: tuple[Material, ...]
    source: str
    source_id: str
    licence: str
    style: str = ""
    super_category: str = ""
    textures: Mapping[str, bytes] = field(default_factory=dict)
    parts: tuple[PartBox, ...] = ()
    derived: dict[str, Any] = field(default_factory=dict, init=False, repr=False, compare=False)

    @property
    def articulated(self) -> bool:
        """Whether anything moves."""
        return bool(self.joints)

    @property
    def openable(self) -> bool:
        """Whether a door, drawer or lid opens (a knob or a button alone does not count)."""
        return any(j.part_class in {"hinge_door", "slider_drawer", "hinge_lid", "slider_lid"} for j in self.joints)

    def meshes(self) -> Iterator[Mesh]:
        """Iterate over the visual meshes of all links."""
        for link in self.links:
            yield from link.visuals
