"""A furnished room from above in plain colours: a box for each thing, its kind by colour, its front by a dark edge.

What image metrics see: no textures and no light, so that drafts without models, real rooms and shipped ones are drawn alike.
"""

import colorsys
import functools

import numpy as np
from numpy.typing import NDArray

from pipeline import taxonomy
from pipeline.relations.arrangement import Arrangement
from pipeline.rendering.raster import fill, shrink, top_down

SIZE = 64  # pixels
FINE = 2  # samples per pixel and axis
SMALLEST = 4.0  # narrowest plan that fills the image [m]; smaller rooms leave a margin
MARGIN = 0.25  # around the room [m]
FRONT = 0.22  # share of the depth that is dark
HANGING = 0.5  # lamps under the ceiling are drawn so much smaller, for they hide what is below
FLOOR, PAPER, DOOR, WINDOW = (0.93, 0.92, 0.90), (1.0, 1.0, 1.0), (0.55, 0.35, 0.2), (0.5, 0.7, 0.95)
OPENING = 0.12  # half of the thickness at which openings are drawn [m]


@functools.cache
def colours() -> dict[str, tuple[float, float, float]]:
    """Return a colour for each category of the layout model: hues by the golden section, so that neighbours in the list differ."""
    names = taxonomy.load().names
    return {
        name: colorsys.hsv_to_rgb(k * 0.618034 % 1.0, (0.85, 0.55, 0.75)[k % 3], (0.9, 0.75, 0.6)[k // 3 % 3])
        for k, name in enumerate(names)
    }


def plan_view(room: Arrangement, size: int = SIZE) -> NDArray[np.uint8]:
    """Draw a room: (size, size, 3) in 8 bits, +y up."""
    low, high = room.polygon.min(0), room.polygon.max(0)
    middle, half = (low + high) / 2, max(SMALLEST / 2, float((high - low).max()) / 2) + MARGIN
    view = top_down(middle - half, middle + half, FINE * size, FINE * size)
    known, ceiling = colours(), {c.name for c in taxonomy.load().categories.values() if c.mount == "ceiling"}
    shapes, paints = [_fan(room.polygon, 0.0)], [np.tile(FLOOR, (len(room.polygon) - 2, 1))]
    for opening in room.openings:
        shapes.append(_quad(_band(opening.segment), 0.01))
        paints.append(np.tile(WINDOW if opening.kind == "window" else DOOR, (2, 1)))
    for k, name in enumerate(room.categories):
        if name in known:
            scale = HANGING if name in ceiling else 1.0
            w, d = scale * room.size[k, 0] / 2, scale * room.size[k, 1] / 2
            top = float(room.position[k, 2] + room.size[k, 2])
            edge = -d + FRONT * 2 * d
            for (y0, y1), dark, lift in (((-d, d), 1.0, 0.0), ((-d, edge), 0.35, 0.005)):
                corners = np.array([[-w, y0], [w, y0], [w, y1], [-w, y1]])
                shapes.append(_quad(_place_corners(corners, room.position[k, :2], float(room.yaw[k])), top + lift))
                paints.append(np.tile(np.array(known[name]) * dark, (2, 1)))
    triangles = np.concatenate(shapes)
    frame = fill(view.project(triangles), np.concatenate(paints).astype(np.float32), None, (view.width, view.height), PAPER)
    return shrink(frame, FINE).colour


def _place_corners(corners: NDArray[np.float64], place: NDArray[np.float64], yaw: float) -> NDArray[np.float64]:
    c, s = np.cos(yaw), np.sin(yaw)
    return np.asarray(corners @ np.array([[c, s], [-s, c]]) + place)


def _band(segment: NDArray[np.float64]) -> NDArray[np.float64]:
    along = segment[1] - segment[0]
    across = OPENING * np.array([-along[1], along[0]]) / max(float(np.linalg.norm(along)), 1e-6)
    return np.array([segment[0] - across, segment[1] - across, segment[1] + across, segment[0] + across])


def _quad(corners: NDArray[np.float64], top: float) -> NDArray[np.float64]:
    lifted = np.column_stack([corners, np.full(4, top)])
    return np.asarray(lifted[np.array([[0, 1, 2], [0, 2, 3]])])


def _fan(polygon: NDArray[np.float64], top: float) -> NDArray[np.float64]:
    """Cut a polygon into triangles (T, 3, 3) at one height."""
    from shapely import constrained_delaunay_triangles
    from shapely.geometry import Polygon

    parts = constrained_delaunay_triangles(Polygon(polygon)).geoms
    corners = np.array([np.asarray(part.exterior.coords)[:3] for part in parts])
    return np.asarray(np.concatenate([corners, np.full((*corners.shape[:2], 1), top)], -1))
