"""Doors and windows of a 3D-FRONT house from geometry: the file's own lists do not say which rooms they join.

Evidence: meshes of type Door, Window, BayWindow, Hole and Pocket (the reveals in the wall), and built-in furniture
titled "door/..." or "window/..." (the leaf). Which rooms an opening joins is read off the floor outlines: on each side
of the wall, the first outline met within `reach` of the opening's centre.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import LineString, Polygon

from pipeline.entities.plan import Opening, OpeningKind
from pipeline.sources.front_poses import to_ours

Floats = NDArray[np.float64]
Evidence = Literal["door", "window", "hole"]

MESHES: dict[str, Evidence] = {"Door": "door", "Window": "window", "BayWindow": "window", "Hole": "hole", "Pocket": "hole"}
MIN_WIDTH = 0.35  # [m] a narrower reveal is a pipe's hole or one jamb of several
DOOR_WIDTH, DOOR_HEIGHT = 0.9, 2.1  # [m] of a leaf whose size is not in the file
WINDOW_SILL = 0.3  # [m] a hole that starts above this is a window
OPEN_WIDTH = 1.8  # [m] a hole without a leaf that is wider is an open front
TOUCHING = 0.03  # [m] rooms nearer than this have no wall between them
SAME = 0.35  # [m] two pieces of evidence this near, of one direction, are one opening
STEP = 0.04  # [m] of the walk from an opening's centre to the rooms


@dataclass(frozen=True, slots=True)
class Hole:
    """Evidence of an opening: `centre` (2,), unit `along` (2,) the wall, `width`, `sill`, `top`, wall `depth` [m]."""

    evidence: Evidence
    centre: Floats
    along: Floats
    width: float
    sill: float
    top: float
    depth: float
    leaf: bool = False


@dataclass(frozen=True, slots=True)
class Outline:
    """A room as the openings see it: its id and its polygon in plan."""

    room_id: str
    polygon: Polygon


def from_mesh(evidence: Evidence, vertices: Floats) -> Hole | None:
    """Return the hole of a reveal mesh (V, 3) in the file's frame, or None where it is no wider than a jamb.

    The wall runs along the longer side of the smallest rectangle around it, unless that rectangle is nearly square.
    """
    points = to_ours(vertices)
    if len(points) < 3:
        return None
    around = shapely.MultiPoint(points[:, :2]).minimum_rotated_rectangle
    frame = np.asarray(around.exterior.coords if isinstance(around, Polygon) else [])
    if len(frame) < 5:  # the points are on one line: a flat leaf
        low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
        if np.ptp(points[:, 0]) and np.ptp(points[:, 1]) and np.corrcoef(points[:, 0], points[:, 1])[0, 1] < 0:
            low[1], high[1] = high[1], low[1]
        sides = np.array([high - low, [0.0, 0.0]])
        centre = (low + high) / 2
    else:
        sides = np.array([frame[1] - frame[0], frame[2] - frame[1]])
        centre = frame[:4].mean(axis=0)
    lengths = np.hypot(sides[:, 0], sides[:, 1])
    long = int(np.argmax(lengths))
    if lengths[long] < MIN_WIDTH:
        return None
    sill, top = float(points[:, 2].min()), float(points[:, 2].max())
    return Hole(evidence, centre, sides[long] / lengths[long], float(lengths[long]), sill, top, float(lengths[1 - long]))


def from_furniture(title: str, position: Floats, yaw: float, box: tuple[float, float, float] | None) -> Hole | None:
    """Return the hole of a built-in door or window at `position` (3,) in the file's frame, or None for other titles."""
    kind = title.split("/", 1)[0].strip()
    if kind not in {"door", "window"}:
        return None
    point = to_ours(position)
    width, _, height = box or (DOOR_WIDTH, 0.0, DOOR_HEIGHT)
    sill = float(max(point[2], 0.0))
    along = np.array([math.cos(yaw), math.sin(yaw)])
    evidence: Evidence = "door" if kind == "door" else "window"
    return Hole(evidence, point[:2], along, max(width, MIN_WIDTH), sill, sill + height, 0.0, leaf=kind == "door")


def merge(holes: Iterable[Hole]) -> list[Hole]:
    """Join evidence of the same opening: reveals from both rooms, a leaf in its reveal. Reveals give the geometry."""
    merged: list[Hole] = []
    for hole in sorted(holes, key=lambda h: (h.depth == 0.0, -h.width, tuple(np.round(h.centre, 3)))):
        for k, other in enumerate(merged):
            apart = hole.centre - other.centre
            across = abs(float(apart @ np.array([-other.along[1], other.along[0]])))
            inside = abs(float(apart @ other.along)) < max(SAME, other.width / 2 - 0.1)
            same_wall = abs(float(hole.along @ other.along)) > 0.9 or hole.depth == 0.0
            if across < SAME and inside and same_wall and hole.sill < other.top and other.sill < hole.top:
                evidence = other.evidence if other.evidence != "hole" else hole.evidence
                merged[k] = replace(other, evidence=evidence, leaf=other.leaf or hole.leaf)
                break
        else:
            merged.append(hole)
    return merged


def sides(hole: Hole, outlines: Sequence[Outline], reach: float) -> tuple[list[str], Floats]:
    """Return the rooms that the hole joins (0 to 2, left side first) and its direction, squared to a room's wall.

    A leaf without reveal takes the direction of the nearest wall, for its own yaw may be a swing.
    """
    along = hole.along
    if hole.depth == 0.0:
        wall = _wall_direction(hole.centre, outlines, reach)
        along = hole.along if wall is None else wall
    normal = np.array([-along[1], along[0]])
    found = []
    for side in (1.0, -1.0):
        for step in np.arange(STEP, reach + STEP / 2, STEP):
            point = shapely.Point(hole.centre + side * step * normal)
            room = next((o.room_id for o in outlines if o.polygon.contains(point)), None)
            if room:
                found.append(room)
                break
    return list(dict.fromkeys(found)), along


def _wall_direction(centre: Floats, outlines: Sequence[Outline], reach: float) -> Floats | None:
    best: tuple[float, Floats] | None = None
    for outline in outlines:
        ring = np.asarray(outline.polygon.exterior.coords)
        for a, b in itertools.pairwise(ring):
            length = float(np.hypot(*(b - a)))
            t = min(1.0, max(0.0, float((centre - a) @ (b - a)) / length**2))
            gap = float(np.hypot(*(a + t * (b - a) - centre)))
            if length > MIN_WIDTH and gap < reach and (best is None or gap < best[0]):
                best = (gap, (b - a) / length)
    return None if best is None else best[1]


def resolve(hole: Hole, outlines: Sequence[Outline], opening_id: str, reach: float) -> Opening | None:
    """Return the opening, or None where no room lies at it."""
    rooms, along = sides(hole, outlines, reach)
    if not rooms:
        return None
    kind = _kind(hole, len(rooms))
    half = along * hole.width / 2
    ends = np.round(np.array([hole.centre - half, hole.centre + half]), 4)
    ends = ends[np.lexsort((ends[:, 1], ends[:, 0]))]
    sill = round(max(hole.sill, 0.0), 4) if kind == "window" else 0.0
    return Opening(opening_id, kind, tuple(sorted(rooms)), ends, round(hole.top - sill, 4), sill)


def _kind(hole: Hole, rooms: int) -> OpeningKind:
    if hole.evidence == "window" or (hole.evidence == "hole" and hole.sill > WINDOW_SILL):
        return "window"
    if rooms == 1:
        return "entrance"
    if hole.evidence == "door" or hole.leaf:
        return "door"
    return "open" if hole.width > OPEN_WIDTH else "portal"


def touching(outlines: Sequence[Outline], height: float, first: int) -> list[Opening]:
    """Return an `open` opening for each pair of rooms whose floors meet without a wall, numbered from `first` on."""
    found: list[Opening] = []
    for i, a in enumerate(outlines):
        for b in outlines[i + 1 :]:
            if a.polygon.distance(b.polygon) > TOUCHING:
                continue
            shared = a.polygon.exterior.intersection(b.polygon.buffer(TOUCHING))
            shared = shapely.line_merge(shared) if shared.geom_type == "MultiLineString" else shared
            lines = [p for p in shapely.get_parts(shared) if isinstance(p, LineString)]
            edges = [e for line in lines for e in _straight_parts(line)]
            longest = max(edges, key=lambda e: float(np.hypot(*(e[1] - e[0]))), default=None)
            if longest is None or np.hypot(*(longest[1] - longest[0])) < 0.6:
                continue
            ends = np.round(longest[np.lexsort((longest[:, 1], longest[:, 0]))], 4)
            rooms = tuple(sorted((a.room_id, b.room_id)))
            found.append(Opening(f"opening_{first + len(found)}", "open", rooms, ends, height))
    return found


def _straight_parts(line: LineString) -> list[Floats]:
    points = np.asarray(line.coords)
    return [np.array([a, b]) for a, b in itertools.pairwise(points)]
