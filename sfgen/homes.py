"""What a home is, as plain records: the columns of the tables, lists of numbers as arrays."""

import json
from dataclasses import MISSING, dataclass, field, fields
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from sfgen.place import DatasetError, Place

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
    """One home. `scene` is its whole row of the scenes table; `usd` the path (or address) of its stage, None where there is none."""

    scene_id: str
    index: int
    split: str
    prompt: str
    scene: dict[str, Any]
    rooms: tuple[Room, ...]
    openings: tuple[Opening, ...]
    objects: tuple[PlacedObject, ...]
    joints: tuple[Joint, ...]
    usd: Path | str | None
    place: Place = field(repr=False)

    def stage(self) -> Path | str:
        """Return the path of the home's stage, after a look whether it and the assets that it refers to are there. Raises DatasetError."""
        files = [self.scene["usd"], *sorted({f"assets/{o.asset_id}/{o.asset_id}.usda" for o in self.objects})]
        missing = next((file for file in files if not file or not self.place.exists(file)), None)
        if missing is not None or self.usd is None:
            what = f"{self.place.path(missing)} is missing" if missing else "it was made without stages"
            msg = f"{self.scene_id} has no stage that can be opened ({what}); copy the dataset again, with usd/ and assets/"
            raise DatasetError(msg)
        return self.usd

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


def records(cls: type[Record], rows: pa.Table) -> list[Record]:
    """Build records from rows of a table; columns that they do not know are left out."""
    columns = {f.name: _values(rows.column(f.name)) for f in fields(cls) if f.name in rows.column_names}  # type: ignore[arg-type]
    return [cls(**dict(zip(columns, row, strict=True))) for row in zip(*columns.values(), strict=True)]


def require_columns(rows: pa.Table, cls: type[Any], path: str) -> None:
    """Raise DatasetError for a table that lacks columns which the records need: another program's file, or another version's."""
    needed = [f.name for f in fields(cls) if f.default is MISSING] if cls is not Home else ["index", "split", "prompt", "usd", "program"]
    lacking = [name for name in ("scene_id", *needed) if name not in rows.column_names]
    if lacking:
        msg = f"{path} has no column {', '.join(lacking)}: it is not a table of this format; copy the dataset again"
        raise DatasetError(msg)


def _values(column: pa.ChunkedArray) -> list[Any]:
    kind = column.type
    if pa.types.is_fixed_size_list(kind) and column.null_count == 0:
        flat = np.concatenate([chunk.flatten().to_numpy(zero_copy_only=False) for chunk in column.chunks] or [np.empty(0)])
        return list(flat.reshape(-1, kind.list_size))
    values: list[Any] = column.to_pylist()
    if pa.types.is_fixed_size_list(kind) or (pa.types.is_list(kind) and not pa.types.is_string(kind.value_type)):
        return [None if value is None else np.array(value, np.float64) for value in values]
    return list(map(tuple, values)) if pa.types.is_list(kind) else values
