"""What a 3D-FRONT house says of one opening: meshes of its reveal or frame, records of the leaf or pane that stands in it.

Meshes of type Door, Window, BayWindow and Hole are reveals; their inner faces bound what is clear. A Pocket is the frame
around an opening, and the record of a door is as large as its frame: both are wider than what one passes. Some meshes are
flat: the threshold of a door, the sill of a window, the head of a hole; they belong to the reveal that they touch.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import shapely
from shapely.geometry import Polygon

from pipeline.arrays import Floats
from pipeline.sources.threed_front.poses import to_ours

Evidence = Literal["door", "window", "hole"]
Origin = Literal["reveal", "hole", "frame", "record"]

ORIGINS: tuple[Origin, ...] = ("reveal", "hole", "frame", "record")  # whose measures count, best first
MESHES: dict[str, tuple[Evidence, Origin]] = {
    "Door": ("door", "reveal"),
    "Window": ("window", "reveal"),
    "BayWindow": ("window", "reveal"),
    "Hole": ("hole", "hole"),
    "Pocket": ("hole", "frame"),
}
MIN_WIDTH = 0.35  # [m] a narrower reveal is a pipe's hole or one jamb of several
MIN_PANE = 0.2  # [m] the same for windows: a bay has narrow panes
LEAST: Mapping[Evidence, float] = {"door": MIN_WIDTH, "window": MIN_PANE, "hole": MIN_WIDTH}
SAME = 0.35  # [m] two pieces of evidence this near, of one direction, are one opening
FLAT = 0.1  # [m] what is lower is a threshold, a sill or a head
DOOR_WIDTH, DOOR_HEIGHT = 0.9, 2.1  # [m] of a leaf whose size is not in the file
WINDOW_WIDTH, WINDOW_HEIGHT = 1.5, 1.4  # [m] the same
CASING = (0.128, 0.064)  # [m] by which frames are wider and higher than what is clear: medians of 50 doors of 12 real houses
LEAST_CLEAR = 0.55  # of a mesh's width: what is less between its faces is no passage, but a leaf with panels
HEADROOM = 1.5  # [m] faces above a passage that are lower are no head
LEVEL = 0.47  # of a mesh's height, at which its faces are cut: no edge of a quad lies there


@dataclass(frozen=True, slots=True)
class OpeningEvidence:
    """Evidence of an opening: `centre` (2,), unit `along` (2,) the wall, `width`, `sill`, `top`, wall `depth` [m].

    `sized` says whether the width is the file's own and not a default.
    """

    evidence: Evidence
    centre: Floats
    along: Floats
    width: float
    sill: float
    top: float
    depth: float
    origin: Origin = "reveal"
    sized: bool = True

    @property
    def flat(self) -> bool:
        """Whether it is a threshold, a sill or a head."""
        return self.top - self.sill < FLAT

    @property
    def across(self) -> Floats:
        """Unit normal (2,) of the wall, to the left of `along`."""
        return np.array([-self.along[1], self.along[0]])

    @property
    def ends(self) -> Floats:
        """Both ends (2, 2) of its middle line."""
        half = self.width / 2 * self.along
        return np.array([self.centre - half, self.centre + half])

    def offset(self, point: Floats) -> tuple[float, float]:
        """Return how far a point (2,) lies from the middle: along the wall and across it [m]."""
        apart = point - self.centre
        return float(apart @ self.along), float(apart @ self.across)

    def reaches(self, point: Floats) -> bool:
        """Whether a point (2,) lies at it, give or take SAME."""
        along, across = map(abs, self.offset(point))
        return along < self.width / 2 + SAME and across < self.depth / 2 + SAME

    def span(self, other: OpeningEvidence) -> tuple[float, float]:
        """Return from where to where the other reaches along this one, measured from this one's centre [m]."""
        middle, _ = self.offset(other.centre)
        half = abs(float(other.along @ self.along)) * other.width / 2
        return middle - half, middle + half

    def between(self, low: float, high: float) -> OpeningEvidence:
        """Return the part from `low` to `high` [m] along it, measured from its centre."""
        return replace(self, centre=self.centre + (low + high) / 2 * self.along, width=high - low)


def from_mesh(evidence: Evidence, vertices: Floats, triangles: Floats | None = None, origin: Origin = "reveal") -> OpeningEvidence | None:
    """Return the hole of a mesh in the file's frame, `vertices` (V, 3) and `triangles` (T, 3, 3), or None where it has no extent in plan.

    The wall runs along the longer side of the smallest rectangle around it. Of doors and holes the width and the top are those of what lies clear
    between the faces, where the triangles show it.
    """
    points = to_ours(vertices)
    if len(points) < 3:
        return None
    around = shapely.MultiPoint(points[:, :2]).minimum_rotated_rectangle
    frame = np.asarray(around.exterior.coords if isinstance(around, Polygon) else around.coords)
    sides = np.diff(frame[:3], axis=0)
    lengths = np.append(np.hypot(*sides.T), 0.0)  # a flat leaf has one side
    long = int(np.argmax(lengths))
    if lengths[long] < 1e-3:
        return None
    centre, sill, top = frame[:4].mean(axis=0), float(points[:, 2].min()), float(points[:, 2].max())
    hole = OpeningEvidence(evidence, centre, sides[long] / lengths[long], float(lengths[long]), sill, top, float(lengths[1 - long]), origin)
    if evidence == "window" or hole.flat or triangles is None or not len(triangles):
        return hole
    return _clear(hole, to_ours(triangles))


def from_furniture(title: str, position: Floats, yaw: float, box: tuple[float, float, float] | None) -> OpeningEvidence | None:
    """Return the hole of a built-in door or window at `position` (3,) in the file's frame, or None for other titles.

    The declared box (w, d, h) of a door is that of its frame.
    """
    kind = title.split("/", 1)[0].strip()
    if kind not in {"door", "window"}:
        return None
    point = to_ours(position)
    evidence: Evidence = "door" if kind == "door" else "window"
    width, _, height = box or ((DOOR_WIDTH, 0.0, DOOR_HEIGHT) if kind == "door" else (WINDOW_WIDTH, 0.0, WINDOW_HEIGHT))
    if box and kind == "door":
        width, height = width - CASING[0], height - CASING[1]
    sill = float(max(point[2], 0.0))
    along = np.array([math.cos(yaw), math.sin(yaw)])
    return OpeningEvidence(evidence, point[:2], along, max(width, LEAST[evidence]), sill, sill + height, 0.0, "record", box is not None)


def _clear(hole: OpeningEvidence, triangles: Floats) -> OpeningEvidence:
    """Return the passage between the faces (T, 3, 3) [our frame] of a mesh, or the hole itself where they close it."""
    along, up = (triangles[..., :2] - hole.centre) @ hole.along, triangles[..., 2]
    half = hole.width / 2
    low, high = _widest(_line_crossings(up, along, hole.sill + LEVEL * (hole.top - hole.sill)), -half, half)
    if high - low < max(LEAST_CLEAR * hole.width, MIN_WIDTH):
        if hole.origin != "frame":
            return hole
        return replace(hole, width=max(hole.width - CASING[0], MIN_WIDTH), top=hole.top - CASING[1])
    heads = [start for start, _ in _line_crossings(along, up, low + LEVEL * (high - low)) if start > hole.sill + HEADROOM]
    return replace(hole.between(low, high), top=min(heads, default=hole.top))


def _line_crossings(cut: Floats, kept: Floats, at: float) -> list[tuple[float, float]]:
    """Return where triangles, given by two coordinates (T, 3) of their corners, meet the line `cut` = `at`: intervals of `kept`."""
    intervals = []
    for a, b in zip(cut - at, kept, strict=True):
        ends = [float(b[i] + a[i] / (a[i] - a[j]) * (b[j] - b[i])) for i, j in ((0, 1), (1, 2), (2, 0)) if float(a[i]) * float(a[j]) < 0.0]
        if ends:
            intervals.append((min(ends), max(ends)))
    return intervals


def _widest(taken: list[tuple[float, float]], low: float, high: float) -> tuple[float, float]:
    """Return the widest interval between `low` and `high` that none of `taken` reaches into."""
    best, reached = (low, low), low
    for start, end in [*sorted(taken), (high, high)]:
        if start - reached > best[1] - best[0]:
            best = (reached, start)
        reached = max(reached, end)
    return best
