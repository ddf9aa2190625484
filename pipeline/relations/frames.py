"""How a member stands in its anchor's frame, for P pairs at once: side, distances under each reference, turn.

Anchor frame: origin at the centre of its box, x along its width, front towards -y. A side's `normal` points away from the
anchor; `along` is +x for front and back, +y for left and right. `over` is no side: the member is above or below, normal +y.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeline.arrays import Floats

SIDES = ("front", "right", "back", "left", "over")
NORMAL = np.array([[0.0, -1], [1, 0], [0, 1], [-1, 0], [0, 1]])
ALONG = np.array([[1.0, 0], [0, 1], [1, 0], [0, 1], [1, 0]])
OVER = SIDES.index("over")
REFERENCES = ("middle", "low", "high", "share", "outside")  # what an offset is measured from, see `offset_along`
THIN = 0.03  # a thing no higher than this, or heights that overlap no more: one lies over the other [m]


@dataclass(frozen=True, slots=True)
class Boxes:
    """P boxes: bottom centre (P, 3) [m], yaw (P,) [rad], size (P, 3) [m]."""

    position: Floats
    yaw: Floats
    size: Floats

    def __getitem__(self, index: NDArray[np.generic] | slice) -> Boxes:
        """Return some of them."""
        return Boxes(self.position[index], self.yaw[index], self.size[index])


@dataclass(frozen=True, slots=True)
class Frames:
    """P members in their anchors' frames: place (P, 2), extents along the frame's axes of the member and of the anchor (P, 2).

    `turn` (P,) is the member's yaw less the anchor's, `facing` (P,) less the yaw at which its front would point at the anchor.
    """

    place: Floats
    extent: Floats
    anchor: Floats
    turn: Floats
    facing: Floats
    over: NDArray[np.bool_]

    def __getitem__(self, index: NDArray[np.generic]) -> Frames:
        """Return some of them."""
        return Frames(*(getattr(self, name)[index] for name in self.__slots__))

    def gaps(self) -> Floats:
        """Return the gaps (P, 2) between the boxes along both axes; negative where they overlap there [m]."""
        return np.asarray(np.abs(self.place) - (self.anchor + self.extent) / 2)

    def apart(self) -> Floats:
        """Return how far apart the boxes are (P,) [m]."""
        return np.asarray(np.linalg.norm(np.maximum(self.gaps(), 0), axis=1))

    def distance(self) -> Floats:
        """Return the same, but that overlapping boxes differ a little, by their centres."""
        return np.asarray(self.apart() + 1e-3 * np.linalg.norm(self.place, axis=1))

    def sides(self) -> NDArray[np.intp]:
        """Return on which side of its anchor each member stands (P,): the side with the widest gap."""
        across = self.gaps()
        lateral = across[:, 0] > across[:, 1]
        side = np.where(lateral, np.where(self.place[:, 0] > 0, 1, 3), np.where(self.place[:, 1] > 0, 2, 0))
        return np.asarray(np.where(self.over, OVER, side))


def wrap_angle(angle: Floats) -> Floats:
    """Return angles in (-pi, pi]."""
    return np.asarray(np.pi - np.mod(np.pi - angle, 2 * np.pi))


def extents(size: Floats, turn: Floats) -> Floats:
    """Return the full extents (P, 2) along the frame's axes of boxes turned by `turn`."""
    c, s = np.abs(np.cos(turn)), np.abs(np.sin(turn))
    return np.stack([size[:, 0] * c + size[:, 1] * s, size[:, 0] * s + size[:, 1] * c], -1)


def relate(anchors: Boxes, members: Boxes) -> Frames:
    """Express P members in the frames of P anchors."""
    apart = members.position - anchors.position
    c, s = np.cos(anchors.yaw), np.sin(anchors.yaw)
    place = np.stack([c * apart[:, 0] + s * apart[:, 1], c * apart[:, 1] - s * apart[:, 0]], -1)
    turn = wrap_angle(members.yaw - anchors.yaw)
    extent, anchor = extents(members.size, turn), anchors.size[:, :2]
    heights, reach = np.stack([anchors.size[:, 2], members.size[:, 2]]), apart[:, 2]
    shared = np.minimum(heights[0], reach + heights[1]) - np.maximum(0.0, reach)
    meet = (np.abs(place) < (anchor + extent) / 2).all(1)
    inside = (np.abs(place) < np.maximum(anchor, extent) / 2).all(1)
    over = meet & inside & ((shared < THIN) | (heights.min(0) < THIN))
    facing = wrap_angle(turn - np.arctan2(-place[:, 0], place[:, 1]))
    return Frames(place, extent, anchor, turn, facing, over)


def offset_along(frames: Frames, direction: Floats, reference: str) -> Floats:
    """Return the members' place (P,) along a direction (2,) of the anchor's frame: metres from the reference.

    middle: the anchor's middle; low, high: where the two boxes' ends of that name are flush; outside: where they touch;
    share: the anchor's middle, in lengths of the anchor.
    """
    value = frames.place @ direction
    own, other = frames.anchor @ np.abs(direction), frames.extent @ np.abs(direction)
    if reference == "share":
        return np.asarray(value / own)
    zero = (own + other) / 2 if reference == "outside" else {"middle": 0.0, "low": -1.0, "high": 1.0}[reference] * (own - other) / 2
    return np.asarray(value - zero)
