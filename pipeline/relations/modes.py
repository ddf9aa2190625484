"""One way of standing at an anchor: a side and three spans; how far members are from it."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pipeline.arrays import Floats
from pipeline.relations.frames import ALONG, NORMAL, SIDES, Frames, offset_along, wrap_angle

METRES, RADIANS = 0.05, 0.09  # a member this near to a mode holds it [m], [rad]: 5 cm, 5 degrees


class Span(NamedTuple):
    """Where the cases lie: 5 %, 50 % and 95 % of them are below; measured from a reference, see `frames.offset_along`."""

    reference: str
    low: float
    middle: float
    high: float

    def excess(self, value: Floats) -> Floats:
        """Return how far values lie outside: negative below, positive above, 0 within."""
        return np.asarray(np.minimum(value - self.low, 0) + np.maximum(value - self.high, 0))


class Mode(NamedTuple):
    """A side of the anchor, the share of members that stand so, their place outwards of it and along it, their turn.

    `turn` is measured from the anchor's yaw (`anchor`), or from the yaw at which the member's front points at the anchor's centre (`facing`).
    """

    side: str
    weight: float
    outwards: Span
    along: Span
    turn: Span

    def distances(self, frames: Frames) -> tuple[Floats, Floats]:
        """Return how far members are off (P,) [m] and (P,) [rad]: 0 within the spans."""
        k = SIDES.index(self.side)
        off = []
        for span, direction in ((self.outwards, NORMAL[k]), (self.along, ALONG[k])):
            beyond = span.excess(offset_along(frames, direction, span.reference))
            off.append(beyond * (frames.anchor @ np.abs(direction)) if span.reference == "share" else beyond)
        turn = self.turn
        angle = wrap_angle((frames.facing if turn.reference == "facing" else frames.turn) - turn.middle)
        beyond = turn._replace(low=turn.low - turn.middle, high=turn.high - turn.middle).excess(angle)
        return np.hypot(*off), np.abs(beyond)


def in_any_mode(modes: tuple[Mode, ...], frames: Frames) -> NDArray[np.bool_]:
    """Return which members are in a mode (P,)."""
    inside = np.zeros(len(frames.turn), bool)
    for mode in modes:
        metres, radians = mode.distances(frames)
        inside |= (metres <= METRES) & (radians <= RADIANS)
    return inside
