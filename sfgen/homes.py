"""What a home is, as plain records: the columns of the tables, lists of numbers as arrays."""

from __future__ import annotations

import json
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

Record = TypeVar("Record")
Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Room:
    """A room; `polygon` (n, 2) [m, world]: inner wall faces, counter-clockwise, not closed; `area` [m2], `height` [m]."""

    room_id: str
    type: str
    layout_type: str
    role: str
    level: int
    height: float
    area: float
    polygon: Floats
    objects: int
    openable: int
    walkable_paper: float
    walkable_free: float


@dataclass(frozen=True, slots=True, eq=False)
class Opening:
    """A door, open front, portal, window or entrance; `segment` (2, 2) [m, world] is its clear width on the wall's centre line.

    A leaf turns about the segment's end `swing_hinge` into `swing_room` by up to `swing_angle` [rad].
    """

    opening_id: str
    kind: str
    rooms: tuple[str, ...]
    segment: Floats
    width: float
    height: float
    sill: float
    swing_room: str
    swing_hinge: int | None
    swing_angle: float | None
    level: int


@dataclass(frozen=True, slots=True, eq=False)
class PlacedObject:
    """A placed asset.

    `position` (3,) [m, world] is the bottom centre of its box with all joints at 0; `size` (3,) [m] the full extents
    (w, d, h) in its own frame; `yaw` [rad]; `scale` (3,) the factor on the asset's own size; `latent` (32,). `support`
    is the object that it stands on or in, "" for the floor, a wall or the ceiling.
    """

    object_id: str
    room_id: str
    category: str
    asset_id: str
    position: Floats
    yaw: float
    size: Floats
    scale: Floats
    openable: bool
    latent: NDArray[np.float32]
    retrieval_distance: float
    support: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class Joint:
    """A joint of a placed object, or of a room door (`object_id` is then an opening's).

    `axis` (3,) and `origin` (3,) [m] in the world frame; limits [rad or m]; `clear_upper` is how far it opens before it
    touches something, with the joints `after` of the same object open; `stand` (3,) is where a robot can stand to open it: x, y [m], yaw [rad].
    """

    object_id: str
    joint_id: str
    type: str
    part_class: str
    axis: Floats
    origin: Floats
    lower: float
    upper: float
    clear_upper: float
    clear: bool
    blocker: str
    stand: Floats | None
    after: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class Home:
    """One home. `scene` is its whole row of the scenes table; `usd` the path of its stage, None where there is none."""

    scene_id: str
    index: int
    split: str
    prompt: str
    scene: dict[str, Any]
    rooms: tuple[Room, ...]
    openings: tuple[Opening, ...]
    objects: tuple[PlacedObject, ...]
    joints: tuple[Joint, ...]
    usd: Path | None

    @property
    def program(self) -> dict[str, Any] | None:
        """The typed request that the home was made from, None when there is none."""
        return json.loads(self.scene["program"]) if self.scene["program"] else None

    def in_room(self, room_id: str) -> tuple[PlacedObject, ...]:
        """Return the objects of one room."""
        return tuple(o for o in self.objects if o.room_id == room_id)

    def joints_of(self, object_id: str) -> tuple[Joint, ...]:
        """Return the joints of one object, or of a room door by its opening_id."""
        return tuple(j for j in self.joints if j.object_id == object_id)


def record(cls: type[Record], row: dict[str, Any]) -> Record:
    """Build a record from a table row; columns that it does not know are left out, and older datasets lack some."""
    return cls(**{f.name: _value(f.name, row[f.name]) for f in fields(cls) if f.name in row})  # type: ignore[arg-type]


def _value(name: str, value: Any) -> Any:
    if not isinstance(value, list):
        return value
    if name in {"rooms", "after"}:
        return tuple(value)
    return np.array(value, np.float32 if name == "latent" else np.float64)
