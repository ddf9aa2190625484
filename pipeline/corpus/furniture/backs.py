"""Backs of chairs: slats, ladders, panels, splats, spindles, cane, pads. Made upright, then leaned. Lengths in metres."""

from dataclasses import dataclass

import numpy as np

from pipeline.corpus.furniture.bent import lean, prism
from pipeline.corpus.furniture.finishes import Finish, Scheme, cane
from pipeline.corpus.furniture.intervals import around
from pipeline.corpus.furniture.shape import Pieces, pieces
from pipeline.corpus.furniture.solids import Solid, beam, box, rod
from pipeline.corpus.furniture.upholstery import upright_pad


@dataclass(frozen=True, slots=True)
class Frame:
    """Where a back goes: half width `x`, its plane `y`, from `low` (the seat) up to `high`, leaning back by `slope` per height."""

    x: float
    y: float
    low: float
    high: float
    slope: float
    thick: float
    wood: Finish

    def bar(self, a: float, b: float, inset: float, deep: float = 0.8) -> Solid:
        """Return a rail across between shares `a` and `b` of the height, `inset` from either side."""
        rise = self.high - self.low
        half = deep * self.thick / 2
        return box(around(self.x - inset), around(half, self.y), (self.low + a * rise, self.low + b * rise), 0.003)


def posts(frame: Frame, *, turned: bool = False) -> list[Solid]:
    """Return the two posts that rise from the seat."""
    solids = []
    for s in (-1, 1):
        x, y, t = s * (frame.x - frame.thick / 2), frame.y, frame.thick
        if turned:
            solids.append(rod((x, y, frame.low), (x, y, frame.high), 0.5 * t, 0.4 * t, 8))
        else:
            solids.append(beam((x, y, frame.low), (x, y, frame.high), 0.86 * t, 0.86 * t, 1.15))
    return solids


def back(rng: np.random.Generator, kind: str, frame: Frame, scheme: Scheme) -> Pieces:
    """Return a back of one kind: slat, ladder, panel, splat, spindle, cane, cross, pad."""
    t = frame.thick
    soft: list[Solid] = []
    wood: list[Solid] = []
    other: Pieces = ()
    if kind == "pad":
        soft = upright_pad(
            rng, scheme, around(frame.x), (frame.y - 0.035, frame.y + 0.03), (frame.low + 0.08 * (frame.high - frame.low), frame.high)
        )
    else:
        wood = posts(frame, turned=kind in ("spindle", "ladder") and scheme.manner.ornament > 0.3)
        wood.append(frame.bar(0.86, 1.0, t))
        wood += {"slat": _slats, "ladder": _ladder, "panel": _panel, "splat": _splat, "spindle": _spindles, "cross": _cross}.get(
            kind, _rail
        )(frame)
        if kind == "cane":
            rise = frame.high - frame.low
            inset = 1.0 * t
            sheet = box(around(frame.x - inset), around(0.004, frame.y), (frame.low + 0.3 * rise, frame.low + 0.86 * rise))
            other = pieces("cane", lean([sheet], frame.low, frame.slope), cane(rng))
    tilted = lean(wood, frame.low, frame.slope)
    return pieces("back", tilted, frame.wood) + pieces("back_pad", lean(soft, frame.low, frame.slope), scheme.soft) + other


def _rail(frame: Frame) -> list[Solid]:
    return [frame.bar(0.2, 0.3, frame.thick)]


def _slats(frame: Frame) -> list[Solid]:
    rise, t = frame.high - frame.low, frame.thick
    count = max(3, round(2 * frame.x / 0.1))
    xs = np.linspace(-frame.x + 2.2 * t, frame.x - 2.2 * t, count)
    low, high = frame.low + 0.24 * rise, frame.low + 0.86 * rise
    return [frame.bar(0.16, 0.24, t), *(box(around(0.016, x), around(0.006, frame.y), (low, high), 0.002) for x in xs)]


def _ladder(frame: Frame) -> list[Solid]:
    return [frame.bar(a, a + 0.11, frame.thick, 0.55) for a in (0.14, 0.38, 0.62)]


def _panel(frame: Frame) -> list[Solid]:
    return [frame.bar(0.28, 0.8, frame.thick, 0.5)]


def _splat(frame: Frame) -> list[Solid]:
    """Build a board down the middle, waisted: two trapezoids with a round between them."""
    rise = frame.high - frame.low
    low, high, middle = frame.low + 0.04 * rise, frame.low + 0.86 * rise, frame.low + 0.45 * rise
    wide = 0.42 * frame.x
    span = around(0.006, frame.y)
    under = np.array([(-0.75 * wide, low), (0.75 * wide, low), (0.42 * wide, middle), (-0.42 * wide, middle)])
    over = np.array([(-0.42 * wide, middle), (0.42 * wide, middle), (wide, high), (-wide, high)])
    return [prism(under, "y", span), prism(over, "y", span)]


def _spindles(frame: Frame) -> list[Solid]:
    rise, t = frame.high - frame.low, frame.thick
    count = max(5, round(2 * frame.x / 0.075))
    xs = np.linspace(-frame.x + 1.9 * t, frame.x - 1.9 * t, count)
    return [rod((x, frame.y, frame.low), (x, frame.y, frame.low + 0.86 * rise), 0.0075, 0.006, 6) for x in xs]


def _cross(frame: Frame) -> list[Solid]:
    """Two bars that cross behind each other, as on a bistro chair."""
    rise, t = frame.high - frame.low, frame.thick
    x, z = frame.x - 1.1 * t, (frame.low + 0.12 * rise, frame.low + 0.86 * rise)
    bars = [frame.bar(0.06, 0.12, t, 0.5)]
    for s, dy in ((-1, -0.009), (1, 0.009)):
        bars.append(rod((-s * x, frame.y + dy, z[0]), (s * x, frame.y + dy, z[1]), 0.009, n=8))
    return bars
