"""Free wall: where pictures, mirrors, towels and curtains hang, clear of openings, of what stands there and of all that moves."""

from collections.abc import Sequence

import numpy as np

from pipeline.arrange.walls import Edge, EdgeOpening, edges_of
from pipeline.arrays import Floats
from pipeline.entities.plan import Opening

GAP = 0.004  # between the wall and the back of what hangs on it [m]
ROOM = 0.06  # between what hangs and what is beside it [m]
DEEP = 0.45  # what stands within this of the wall hides what would hang behind it [m]
AT_WALL = 0.35  # the back of furniture that stands at a wall is within this of it [m]
IN_WALL = -1.0  # the near side of an opening, as told from what stands before the wall [m]
LEAST = 0.35  # shorter walls stay bare [m]
OVER = 0.1  # free wall between furniture and what hangs over it [m]


class Hanging:
    """The walls of a furnished room; what is hung takes its place, nothing is taken away. Heights are above the floor."""

    def __init__(self, polygon: Floats, openings: Sequence[Opening], corners: Floats, heights: Floats, ceiling: float) -> None:
        """`corners` (N, M, 2) and `heights` (N, 2) [m] are the prisms of all that stands or moves in the room; doors' leaves too."""
        self.ceiling = ceiling
        self.walls = edges_of(polygon, openings)
        self.windows = [(number, o) for number, wall in enumerate(self.walls) for o in wall.openings if o.window]
        self.taken = [_taken(wall, corners, heights) for wall in self.walls]

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
        for number, (wall, taken) in enumerate(zip(self.walls, self.taken, strict=True)):
            s, off = wall.along_of(footprint), wall.off(footprint)
            if off.min() > AT_WALL or off.min() < -AT_WALL or s.min() < -AT_WALL or s.max() > wall.length + AT_WALL:
                continue
            if beside:
                aside = float(size[0]) / 2 + 2 * ROOM
                places += [(number, float(s.min()) - aside, low), (number, float(s.max()) + aside, low)]
                continue
            mine = taken[(taken[:, 0] < s.max()) & (taken[:, 1] > s.min())]
            tops = mine[mine[:, 3] < 1.0, 4]
            places.append((number, float(s.mean()), max(low, float(tops.max(initial=0.0)) + OVER)))
        return places

    def _fits(self, number: int, s: float, z: float, size: Floats) -> bool:
        """Tell whether a stretch of wall and a little around it is free."""
        low, high, top = s - float(size[0]) / 2, s + float(size[0]) / 2, z + float(size[2])
        if top >= self.ceiling - ROOM or low < ROOM or high > self.walls[number].length - ROOM:
            return False
        t = self.taken[number]
        across = (t[:, 0] < high + ROOM) & (t[:, 1] > low - ROOM)
        return not bool((across & (t[:, 3] < top + ROOM) & (t[:, 4] > z - ROOM)).any())

    def _take(self, number: int, s: float, z: float, size: Floats) -> tuple[Floats, float]:
        half = float(size[0]) / 2
        self.taken[number] = np.vstack([self.taken[number], [s - half, s + half, 0.0, z, z + float(size[2])]])
        pose = self.walls[number].pose(s, float(size[1]) / 2 + GAP, z)
        return pose[:3], self.walls[number].yaw

    def before(
        self, number: int, window: EdgeOpening, size: Floats, parts: Floats, spread: float, bottoms: Sequence[float], flat: float = 1.0
    ) -> tuple[Floats, float, Floats] | None:
        """Hang something before a window of wall `number`: (x, y, z of its foot), yaw and its scale (3,); None where all is in the way.

        It reaches `spread` [m] beyond the window at either side, as far as the wall does, and is `flat` times as deep; `bottoms` [m] are the lower edges
        that are tried, in their order. `parts` (P, 4) are the boxes of its pieces seen from before: left, right, lower and upper
        edge from its middle and its foot [m]; what stands between drawn curtains is not in their way.
        """
        taken = self.taken[number]
        low, high = max(window.start - spread, 0.01), min(window.end + spread, self.walls[number].length - 0.01)
        top, depth = min(self.ceiling - 0.03, window.head + 0.2), flat * float(size[1]) + GAP + 0.01
        own = (taken[:, 0] >= window.start - 1e-6) & (taken[:, 1] <= window.end + 1e-6) & (taken[:, 2] == IN_WALL)
        near = taken[~own & (taken[:, 2] < depth)][None]
        for bottom in bottoms:
            scale = np.array([(high - low) / size[0], flat, (top - bottom) / size[2]])
            s, z = (low + high) / 2 + parts[:, None, :2] * scale[0], bottom + parts[:, None, 2:] * scale[2]
            across = (near[..., 0] < s[..., 1] + 0.01) & (near[..., 1] > s[..., 0] - 0.01)
            if not (across & (near[..., 3] < z[..., 1] + 0.01) & (near[..., 4] > z[..., 0] - 0.01)).any():
                placed, yaw = self._take(number, (low + high) / 2, bottom, size * scale)
                return placed, yaw, scale
        return None


def _taken(wall: Edge, corners: Floats, heights: Floats) -> Floats:
    """Return boxes (K, 5) that reach to within DEEP of a wall, and its openings: start and end along it, distance of their near side, lower and upper edge [m]."""
    s, off = wall.along_of(corners), wall.off(corners)
    standing = np.column_stack([s.min(1), s.max(1), off.min(1), heights])[off.max(1) > 0] if len(s) else np.zeros((0, 5))
    in_wall = np.array([[o.start, o.end, IN_WALL, o.sill, o.head] for o in wall.openings]).reshape(-1, 5)
    return np.concatenate([standing[standing[:, 2] < DEEP], in_wall])
