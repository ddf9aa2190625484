"""The floor of rooms as a raster: where a round robot can stand, and which of it hangs together through the openings."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from pipeline.arrays import Floats
from pipeline.entities.plan import Opening, Room
from pipeline.geometry.compiled import borrowing
from pipeline.geometry.floor_raster import Mask, Raster, dilate, fill_all, standing_cells
from pipeline.geometry.prisms import Prisms

PASSABLE = ("door", "open", "portal", "entrance")  # kinds of openings that one walks through


@dataclass(frozen=True, slots=True)
class Floor:
    """Bare floor: `room` (x, y) holds the number of the room of each cell, -1 elsewhere; `free` adds the passages."""

    raster: Raster
    room: NDArray[np.int16]
    free: Mask


@dataclass(frozen=True, slots=True)
class FreeSpace:
    """Furnished floor: `labels` (x, y) number the connected places of the robot's centre from 1; `radius` in cells."""

    floor: Floor
    labels: NDArray[np.int32]
    radius: float

    def label_near(self, point: Floats, within: float) -> int:
        """Return the label of the standing place nearest to `point` (2,) [m], 0 when none is `within` [m]."""
        raster = self.floor.raster
        return int(_label_near(self.labels, (point - raster.origin) / raster.cell, within / raster.cell))

    def largest_label(self, where: Mask) -> int:
        """Return the label with most cells in a mask, 0 when there is none."""
        counts = np.bincount(self.labels[where], minlength=1)
        counts[0] = 0
        return int(np.argmax(counts)) if counts.any() else 0

    def centres(self, label: int) -> Mask:
        """Return the places of the robot's centre in one connected part."""
        return (self.labels == label) if label else np.zeros(self.labels.shape, np.bool_)

    def swept_floor(self, label: int) -> Mask:
        """Return the floor that the robot covers while it moves about one connected part."""
        return dilate(self.centres(label), self.radius)

    def shares(self, mask: Mask, rooms: int) -> Floats:
        """Return the share (rooms,) of each room's cells that are in a mask."""
        inside = self.floor.room >= 0
        total = np.bincount(self.floor.room[inside], minlength=rooms)
        part = np.bincount(self.floor.room[inside & mask], minlength=rooms)
        return part / np.maximum(total, 1)


def bare_floor(rooms: Sequence[Room], openings: Sequence[Opening], depth: float, cell: float, widest: float = np.inf) -> Floor:
    """Rasterise rooms of one storey and the passages through walls, `depth` [m] to both sides of the walls' centre lines.

    Passages are narrowed to `widest` [m] about their middles.
    """
    raster = Raster.around([r.polygon for r in rooms], cell, depth + cell)
    room = np.full(raster.shape, -1, np.int16)
    for number, r in enumerate(rooms):
        room[raster.fill(raster.empty(), [r.polygon])] = number
    free = room >= 0
    raster.fill(free, [passage(o, depth, widest) for o in openings if o.kind in PASSABLE])
    return Floor(raster, room, free)


@borrowing
def _label_near(labels: NDArray[np.int32], point: Floats, within: float) -> int:
    """Return the label other than 0 whose cell's centre is nearest to a point (2,), 0 when none is `within`; all in cells."""
    best, label = within * within, 0
    for i in range(max(0, int(point[0] - within - 1)), min(labels.shape[0], int(point[0] + within + 2))):
        for j in range(max(0, int(point[1] - within - 1)), min(labels.shape[1], int(point[1] + within + 2))):
            square = (i + 0.5 - point[0]) ** 2 + (j + 0.5 - point[1]) ** 2
            if labels[i, j] and (square < best or (label == 0 and square <= best)):
                best, label = square, labels[i, j]
    return label


def passage(opening: Opening, depth: float, widest: float = np.inf) -> Floats:
    """Return the rectangle (4, 2) that an opening cuts, `depth` [m] to both sides of its segment, at most `widest` [m]."""
    a, b = opening.segment
    along = (b - a) / max(opening.width, 1e-9)
    spare = max(0.0, opening.width - widest) / 2
    a, b = a + spare * along, b - spare * along
    n = depth * np.array([-along[1], along[0]])
    return np.array([a - n, b - n, b + n, a + n])


def standing_room(floor: Floor, free: Mask, radius: float) -> FreeSpace:
    """Find where on the `free` cells of a floor a robot of that radius [m] can stand, and which of it hangs together."""
    labels, _ = ndimage.label(standing_cells(free, radius / floor.raster.cell))
    return FreeSpace(floor, labels, radius / floor.raster.cell)


def free_space(floor: Floor, obstacles: Prisms, radius: float, heights: tuple[float, float]) -> FreeSpace:
    """Take obstacles off the floor that reach into `heights` (low, high) [m, world]; find where the robot can stand."""
    free = floor.free.copy()
    hit = np.flatnonzero((obstacles.z[:, 0] < heights[1]) & (obstacles.z[:, 1] > heights[0]))
    fill_all(free, np.ascontiguousarray(obstacles.corners), obstacles.count, hit, floor.raster.origin, floor.raster.cell, False)
    return standing_room(floor, free, radius)
