"""How things stand to the walls of their room: which side is at a wall, how near, how straight."""

import numpy as np

from pipeline.arrays import Floats
from pipeline.relations.arrangement import Arrangement

AROUND = ("front", "right", "back", "left")
STRAIGHT = np.radians(2.5)  # a turn to the walls that no training room has: what is turned by less stands straight
OBLIQUE = 0.35  # a side does not face a wall that is turned from it by more than this [rad]


def measure(room: Arrangement) -> tuple[Floats, Floats]:
    """Return for each thing and side, in the order of AROUND, the gap (N, 4) [m] to the wall that it faces and the turn (N, 4) [rad].

    A ray goes from the middle of the thing; negative gaps reach into the wall. inf where a side faces no wall squarely.
    """
    start, stop = room.polygon, np.roll(room.polygon, -1, axis=0)
    edge = stop - start
    outside = np.stack([edge[:, 1], -edge[:, 0]], -1) / np.maximum(np.linalg.norm(edge, axis=1, keepdims=True), 1e-9)
    angles = room.yaw[:, None] + np.array([-np.pi / 2, 0, np.pi / 2, np.pi])
    ways = np.stack([np.cos(angles), np.sin(angles)], -1)  # (N, 4, 2)
    half = room.size[:, [1, 0, 1, 0]] / 2
    towards = ways @ outside.T  # (N, 4, E), cosine between way and the wall's normal
    apart = start[None] - room.position[:, None, :2]  # (N, E, 2)
    with np.errstate(divide="ignore", invalid="ignore"):
        reach = (apart * outside).sum(-1)[:, None] / towards
        hit = room.position[:, None, None, :2] + reach[..., None] * ways[:, :, None]
        place = ((hit - start) * edge).sum(-1) / np.maximum((edge * edge).sum(-1), 1e-12)
        visible = (towards > np.cos(OBLIQUE)) & (reach > 0) & (place > -1e-6) & (place < 1 + 1e-6)
    reach = np.where(visible, reach, np.inf)
    nearest = reach.argmin(-1)
    gap = np.take_along_axis(reach, nearest[..., None], -1)[..., 0] - half
    normal = outside[nearest]
    cross = ways[..., 1] * normal[..., 0] - ways[..., 0] * normal[..., 1]
    turn = np.arctan2(cross, (ways * normal).sum(-1))
    return gap, np.where(np.isfinite(gap), turn, 0.0)
