"""One way of standing at an anchor: a side and three spans; how far a member is from it, and where it would hold exactly."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pipeline.relations.arrangement import Thing
from pipeline.relations.frames import ALONG, NORMAL, SIDES, Boxes, Frames, base, extents, offset_along, relate, wrap_angle

Floats = NDArray[np.float64]

METRES, RADIANS = 0.05, 0.09  # a member this near to a mode holds it [m], [rad]: 5 cm, 5 degrees
LEVER = 0.5  # metres that a radian counts where modes are compared [m/rad]


class Span(NamedTuple):
    """Where the cases lie: 5 %, 50 % and 95 % of them are below; measured from a reference, see `frames.offset_along`."""

    reference: str
    low: float
    middle: float
    high: float


class Pose(NamedTuple):
    """A place and a yaw in the anchor's world [m, rad]; `weight` is the share of members that stand so."""

    x: float
    y: float
    yaw: float
    weight: float


class Nearest(NamedTuple):
    """The nearest mode of a relation: index, distances to it (0 within its spans), and the nearest pose that is within."""

    mode: int
    metres: float
    radians: float
    pose: Pose

    @property
    def holds(self) -> bool:
        """Whether the member is in the mode, but for the tolerance."""
        return self.metres <= METRES and self.radians <= RADIANS


@dataclass(frozen=True, slots=True)
class Mode:
    """A side of the anchor, the member's place outwards of it and along it, its turn, and the share of members that stand so.

    `turn` is measured from the anchor's yaw (`anchor`), or from the yaw at which the member's front points at the anchor's centre (`facing`).
    """

    side: str
    outwards: Span
    along: Span
    turn: Span
    weight: float

    def distances(self, frames: Frames) -> tuple[Floats, Floats]:
        """Return how far members are off (P,) [m] and (P,) [rad]: 0 within the spans."""
        k = SIDES.index(self.side)
        off = []
        for span, direction in ((self.outwards, NORMAL[k]), (self.along, ALONG[k])):
            beyond = excess(offset_along(frames, direction, span.reference), span)
            off.append(beyond * (frames.anchor @ np.abs(direction)) if span.reference == "share" else beyond)
        angle = wrap_angle((frames.facing if self.turn.reference == "facing" else frames.turn) - self.turn.middle)
        beyond = excess(angle, self.turn._replace(low=self.turn.low - self.turn.middle, high=self.turn.high - self.turn.middle))
        return np.hypot(*off), np.abs(beyond)

    def pose(self, anchor: Thing, member: Thing | None, size: tuple[float, float, float]) -> Pose:
        """Return the pose at `anchor` that is nearest to `member` within the spans; the median of all three where there is none."""
        frames = relate(boxes([anchor]), boxes([member])) if member else None
        facing = self.turn.reference == "facing"
        turned = self.turn.middle
        if frames is not None:
            off = wrap_angle((frames.facing if facing else frames.turn) - self.turn.middle)
            turned += float(np.clip(off[0], self.turn.low - self.turn.middle, self.turn.high - self.turn.middle))
        place = NORMAL[SIDES.index(self.side)] if frames is None else frames.place[0]
        yaw = turned
        for _ in range(3 if facing else 1):  # what faces the anchor turns as it moves, and its extents with it
            yaw = turned + (float(np.arctan2(-place[0], place[1])) if facing else 0.0)
            place = self._place(anchor, extents(np.array([size]), np.array([yaw])), frames)
        c, s = np.cos(anchor.yaw), np.sin(anchor.yaw)
        x, y = anchor.x + c * place[0] - s * place[1], anchor.y + s * place[0] + c * place[1]
        return Pose(float(x), float(y), float(wrap_angle(np.array(anchor.yaw + yaw))), self.weight)

    def _place(self, anchor: Thing, extent: Floats, frames: Frames | None) -> Floats:
        """Return the place (2,) in the anchor's frame of a member with these extents (1, 2)."""
        k = SIDES.index(self.side)
        place = np.zeros(2)
        for span, direction in ((self.outwards, NORMAL[k]), (self.along, ALONG[k])):
            axis = np.abs(direction)
            own, other = float(np.array(anchor.size[:2]) @ axis), float((extent @ axis)[0])
            zero, unit = (0.0, own) if span.reference == "share" else (base(span.reference, own, other), 1.0)
            value = span.middle
            if frames is not None:
                value = float(np.clip((frames.place[0] @ direction - zero) / unit, span.low, span.high))
            place += direction * (zero + unit * value)
        return place


def excess(value: Floats, span: Span) -> Floats:
    """Return how far values lie outside a span: negative below, positive above, 0 within."""
    return np.asarray(np.minimum(value - span.low, 0) + np.maximum(value - span.high, 0))


def boxes(things: list[Thing]) -> Boxes:
    """Return things as arrays."""
    return Boxes(np.array([[t.x, t.y, t.z] for t in things]), np.array([t.yaw for t in things]), np.array([t.size for t in things]))


def nearest(modes: tuple[Mode, ...], frames: Frames) -> tuple[NDArray[np.intp], Floats, Floats]:
    """Return for each member the nearest mode (P,), and how far it is off: [m], [rad]."""
    distances = [mode.distances(frames) for mode in modes]
    metres, radians = np.stack([m for m, _ in distances]), np.stack([r for _, r in distances])
    best = np.argmin(metres + LEVER * radians, axis=0)
    each = np.arange(len(best))
    return best, metres[best, each], radians[best, each]


def in_any_mode(modes: tuple[Mode, ...], frames: Frames) -> NDArray[np.bool_]:
    """Return which members are in a mode (P,)."""
    inside = np.zeros(len(frames.turn), bool)
    for mode in modes:
        metres, radians = mode.distances(frames)
        inside |= (metres <= METRES) & (radians <= RADIANS)
    return inside
