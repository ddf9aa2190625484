"""Free wall: where pictures, mirrors, towels and curtains hang, clear of openings, of what stands there and of all that moves."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeline.arrange.item import wrap_yaw
from pipeline.entities.plan import Opening

Floats = NDArray[np.float64]

OFF = 0.3  # an opening's segment is at most this far from the face of its wall [m]
GAP = 0.004  # between the wall and the back of what hangs on it [m]
ROOM = 0.06  # between what hangs and what is beside it [m]
DEEP = 0.45  # what stands within this of the wall hides what would hang behind it [m]
AT_WALL = 0.35  # the back of furniture that stands at a wall is within this of it [m]
IN_WALL = -1.0  # the near side of an opening, as told from what stands before the wall [m]
LEAST = 0.35  # shorter walls stay bare [m]
OVER = 0.1  # free wall between furniture and what hangs over it [m]


@dataclass(frozen=True, slots=True)
class Wall:
    """One edge of a room polygon: `start` (2,) and the unit vector `along` (2,) [m, plan]; the room lies on its left.

    `taken` (K, 5) are boxes that reach to within DEEP of it: start and end along it, distance of their near side, lower and upper edge [m].
    """

    start: Floats
    along: Floats
    length: float
    taken: Floats

    @property
    def yaw(self) -> float:
        """Yaw [rad] of what hangs on it: its front looks into the room."""
        return wrap_yaw(math.atan2(float(self.along[1]), float(self.along[0])) + math.pi)

    def point(self, s: float, off: float) -> Floats:
        """Return the point (2,) [m] at `s` along the wall, `off` before it."""
        position: Floats = self.start + s * self.along + off * np.array([-self.along[1], self.along[0]])
        return position

    def free(self, span: tuple[float, float], height: tuple[float, float]) -> bool:
        """Tell whether a stretch of wall and a little around it is free."""
        if span[0] < ROOM or span[1] > self.length - ROOM:
            return False
        t = self.taken
        across = (t[:, 0] < span[1] + ROOM) & (t[:, 1] > span[0] - ROOM)
        return not bool((across & (t[:, 3] < height[1] + ROOM) & (t[:, 4] > height[0] - ROOM)).any())


@dataclass(frozen=True, slots=True)
class Window:
    """A window in wall number `wall`: `start` to `end` along it, `sill` to `head` above the floor [m]."""

    wall: int
    start: float
    end: float
    sill: float
    head: float


class Hanging:
    """The walls of a furnished room; what is hung takes its place, nothing is taken away. Heights are above the floor."""

    def __init__(self, polygon: Floats, openings: Sequence[Opening], corners: Floats, heights: Floats, ceiling: float) -> None:
        """`corners` (N, M, 2) and `heights` (N, 2) [m] are the prisms of all that stands or moves in the room; doors' leaves too."""
        self.ceiling = ceiling
        self.walls: list[Wall] = []
        self.windows: list[Window] = []
        for a, b in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
            length = float(np.linalg.norm(b - a))
            along = (b - a) / max(length, 1e-9)
            s, off = (corners - a) @ along, (corners - a) @ np.array([-along[1], along[0]])
            standing = np.column_stack([s.min(1), s.max(1), off.min(1), heights])[off.max(1) > 0] if len(s) else np.zeros((0, 5))
            in_wall = self._openings_of(len(self.walls), a, along, length, openings)
            self.walls.append(Wall(a, along, length, np.concatenate([standing[standing[:, 2] < DEEP], in_wall])))

    def _openings_of(self, number: int, a: Floats, along: Floats, length: float, openings: Sequence[Opening]) -> Floats:
        rows = []
        for o in openings:
            s = (o.segment - a) @ along
            off = np.abs((o.segment - a) @ np.array([-along[1], along[0]]))
            start, end = max(float(s.min()), 0.0), min(float(s.max()), length)
            if off.max() < OFF and end - start > 0.05:
                rows.append([start, end, IN_WALL, o.sill, o.sill + o.height])
                if o.kind == "window":
                    self.windows.append(Window(number, start, end, o.sill, o.sill + o.height))
        return np.array(rows).reshape(-1, 5)

    def hang(
        self, rng: np.random.Generator, size: Floats, middle: float, anchors: Sequence[Floats], *, beside: bool, tries: int
    ) -> tuple[Floats, float] | None:
        """Find a place for something of `size` (3,) [m], its middle at `middle` above the floor: (x, y, z of its foot), yaw; None for none.

        `anchors` (A, 4, 2) are footprints of the furniture over which it hangs, or, `beside`, at whose sides; then come
        free places, but not for what has to hang beside something.
        """
        low = middle - float(size[2]) / 2
        spots = [spot for footprint in anchors for spot in self._near(footprint, size, low, beside=beside)]
        if not beside:
            lengths = np.array([max(w.length - float(size[0]) - 2 * ROOM, 0.0) * (w.length >= LEAST) for w in self.walls])
            if lengths.sum() > 0:
                chosen = rng.choice(len(lengths), tries, p=lengths / lengths.sum())
                where = rng.random(tries)
                spots += [(int(k), ROOM + float(size[0]) / 2 + float(u * lengths[k]), low) for k, u in zip(chosen, where, strict=True)]
        for number, s, z in spots:
            if self._fits(number, s, z, size):
                return self._take(number, s, z, size)
        return None

    def _near(self, footprint: Floats, size: Floats, low: float, *, beside: bool) -> list[tuple[int, float, float]]:
        """Return (wall, s, z) over the middle of a footprint that stands at a wall, or at both its sides."""
        places = []
        for number, wall in enumerate(self.walls):
            s, off = (footprint - wall.start) @ wall.along, (footprint - wall.start) @ np.array([-wall.along[1], wall.along[0]])
            if off.min() > AT_WALL or off.min() < -AT_WALL or s.min() < -AT_WALL or s.max() > wall.length + AT_WALL:
                continue
            if beside:
                aside = float(size[0]) / 2 + 2 * ROOM
                places += [(number, float(s.min()) - aside, low), (number, float(s.max()) + aside, low)]
                continue
            mine = wall.taken[(wall.taken[:, 0] < s.max()) & (wall.taken[:, 1] > s.min())]
            tops = mine[mine[:, 3] < 1.0, 4]
            places.append((number, float(s.mean()), max(low, float(tops.max(initial=0.0)) + OVER)))
        return places

    def _fits(self, number: int, s: float, z: float, size: Floats) -> bool:
        half = float(size[0]) / 2
        height = (z, z + float(size[2]))
        return height[1] < self.ceiling - ROOM and self.walls[number].free((s - half, s + half), height)

    def _take(self, number: int, s: float, z: float, size: Floats) -> tuple[Floats, float]:
        wall, half = self.walls[number], float(size[0]) / 2
        box = [s - half, s + half, 0.0, z, z + float(size[2])]
        self.walls[number] = Wall(wall.start, wall.along, wall.length, np.vstack([wall.taken, box]))
        return np.array([*wall.point(s, float(size[1]) / 2 + GAP), z]), wall.yaw

    def before(
        self, window: Window, size: Floats, parts: Floats, spread: float, bottoms: Sequence[float], flat: float = 1.0
    ) -> tuple[Floats, float, Floats] | None:
        """Hang something before a window: (x, y, z of its foot), yaw and its scale (3,); None where all is in the way.

        It reaches `spread` [m] beyond the window at either side, as far as the wall does, and is `flat` times as deep; `bottoms` [m] are the lower edges
        that are tried, in their order. `parts` (P, 4) are the boxes of its pieces seen from before: left, right, lower and upper
        edge from its middle and its foot [m]; what stands between drawn curtains is not in their way.
        """
        wall = self.walls[window.wall]
        low, high = max(window.start - spread, 0.01), min(window.end + spread, wall.length - 0.01)
        top, depth = min(self.ceiling - 0.03, window.head + 0.2), flat * float(size[1]) + GAP + 0.01
        own = (wall.taken[:, 0] >= window.start - 1e-6) & (wall.taken[:, 1] <= window.end + 1e-6) & (wall.taken[:, 2] == IN_WALL)
        near = wall.taken[~own & (wall.taken[:, 2] < depth)][None]
        for bottom in bottoms:
            scale = np.array([(high - low) / size[0], flat, (top - bottom) / size[2]])
            s, z = (low + high) / 2 + parts[:, None, :2] * scale[0], bottom + parts[:, None, 2:] * scale[2]
            across = (near[..., 0] < s[..., 1] + 0.01) & (near[..., 1] > s[..., 0] - 0.01)
            if not (across & (near[..., 3] < z[..., 1] + 0.01) & (near[..., 4] > z[..., 0] - 0.01)).any():
                placed, yaw = self._take(window.wall, (low + high) / 2, bottom, size * scale)
                return placed, yaw, scale
        return None
