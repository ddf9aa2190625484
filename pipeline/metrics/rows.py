"""Rows of tables as the arrays that metrics need."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from pipeline.arrays import Floats

Row = Mapping[str, Any]
Boxes = tuple[Floats, Floats, Floats]  # bottom centres (N, 3) [m], yaws (N,) [rad], full extents (N, 3) [m]


def by_room(rows: Iterable[Row]) -> dict[tuple[str, str], list[Row]]:
    """Group rows by (scene_id, room_id), in order of appearance: the paper's "scene" is our room."""
    grouped: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        grouped.setdefault((row["scene_id"], row["room_id"]), []).append(row)
    return grouped


def boxes(objects: Sequence[Row]) -> Boxes:
    """Return the boxes of objects."""
    position = np.array([o["position"] for o in objects], float).reshape(-1, 3)
    yaw = np.array([o["yaw"] for o in objects], float)
    return position, yaw, np.array([o["size"] for o in objects], float).reshape(-1, 3)
