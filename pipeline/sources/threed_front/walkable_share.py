"""How much of a source house's floor a robot can walk on, with furniture as boxes; the judge uses the meshes themselves."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pipeline.entities.plan import Opening, Room
from pipeline.geometry.floor_raster import components, standing
from pipeline.geometry.free_space import FreeSpace, bare_floor

Floats = NDArray[np.float64]

CELL = 0.05  # [m] of the raster
RADIUS, HEIGHT, STEP = 0.25, 1.4, 0.02  # [m] the robot that homes are verified for: an upright cylinder


def walkable(rooms: Sequence[Room], openings: Sequence[Opening], footprints: Sequence[Floats]) -> list[float]:
    """Return for each room the share of its floor in the largest connected part that the robot covers.

    `footprints` (4, 2) [m] are those of the objects in its way: between STEP and HEIGHT above the floor.
    """
    floor = bare_floor(rooms, openings, 0.2, CELL)
    free = floor.raster.fill(floor.free.copy(), footprints, value=False)
    labels, sizes = components(standing(free, RADIUS / CELL))
    space = FreeSpace(floor, labels, RADIUS / CELL)
    label = int(np.argmax(sizes[1:])) + 1 if len(sizes) > 1 else 0
    return [round(float(share), 4) for share in space.shares(space.covered(label), len(rooms))]
