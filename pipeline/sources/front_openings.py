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
WINDOW_WIDTH, WINDOW_HEIGHT = 1.5, 1.4  # [m] the same
JAMB_HEIGHT = 1.5  # [m] a lower reveal is no jamb of a door
JAMBS_APART = (0.5, 2.5)  # [m] widths of what two jambs may enclose
DOORWAY = 1.2  # [m] floors that meet on no more than this meet under a doorway
USUAL_DEPTH = 0.3  # [m] of the thickest usual wall; an opening that is deeper, a bay, reaches as much farther
WINDOW_SILL = 0.3  # [m] a hole that starts above this is a window
OPEN_WIDTH = 1.8  # [m] a hole without a leaf that is wider is an open front
LEAST_FRONT = 0.6  # [m] rooms that meet on less are not open to each other
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
    """Return the hole of a reveal mesh (V, 3) in the file's frame, or None where it has no extent in plan.

    One that is narrower than MIN_WIDTH is a jamb at most, see `jambs`. The wall runs along the longer side of the smallest rectangle around it, unless that rectangle is nearly square.
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
    if lengths[long] < 1e-3:
        return None
    sill, top = float(points[:, 2].min()), float(points[:, 2].max())
    return Hole(evidence, centre, sides[long] / lengths[long], float(lengths[long]), sill, top, float(lengths[1 - long]))


def from_furniture(title: str, position: Floats, yaw: float, box: tuple[float, float, float] | None) -> Hole | None:
    """Return the hole of a built-in door or window at `position` (3,) in the file's frame, or None for other titles."""
    kind = title.split("/", 1)[0].strip()
    if kind not in {"door", "window"}:
        return None
    point = to_ours(position)
    usual = (DOOR_WIDTH, 0.0, DOOR_HEIGHT) if kind == "door" else (WINDOW_WIDTH, 0.0, WINDOW_HEIGHT)
    width, _, height = box or usual
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
                merged[k] = _joined(other, hole)
                break
        else:
            merged.append(hole)
    return merged


def _joined(first: Hole, second: Hole) -> Hole:
    """Return both as one: where the first says nothing of its kind the second does; the depths of reveals are united."""
    evidence = first.evidence if first.evidence != "hole" else second.evidence
    made = replace(first, evidence=evidence, leaf=first.leaf or second.leaf)
    if second.depth == 0.0:
        return made
    across = np.array([-first.along[1], first.along[0]])
    shift = float((second.centre - first.centre) @ across)
    low, high = min(-first.depth, 2 * shift - second.depth) / 2, max(first.depth, 2 * shift + second.depth) / 2
    return replace(made, centre=first.centre + across * (low + high) / 2, depth=high - low)


def jambs(narrow: Sequence[Hole], wide: Sequence[Hole]) -> tuple[list[Hole], list[Hole]]:
    """Return (holes, rest): door jambs that face each other make a hole, where no wider reveal is there already.

    Two narrow reveals of one kind and height are a pair when each is the other's nearest.
    """
    tall = [h for h in narrow if h.evidence != "window" and h.top - h.sill >= JAMB_HEIGHT and not covered(h.centre, wide)]
    nearest = [min(((_gap(a, b), k) for k, b in enumerate(tall) if b is not a), default=(math.inf, i))[1] for i, a in enumerate(tall)]
    made: list[Hole] = []
    used: set[int] = set()
    for i, k in enumerate(nearest):
        a, b = tall[i], tall[k]
        if i >= k or nearest[k] != i or not JAMBS_APART[0] <= _gap(a, b) <= JAMBS_APART[1]:
            continue
        along = (b.centre - a.centre) / _gap(a, b)
        made.append(
            Hole(a.evidence, (a.centre + b.centre) / 2, along, _gap(a, b), max(a.sill, b.sill), min(a.top, b.top), max(a.width, b.width))
        )
        used |= {id(a), id(b)}
    return made, [h for h in narrow if id(h) not in used]


def _gap(a: Hole, b: Hole) -> float:
    """Return how far two jambs are apart in plan [m]; infinite where they are not of one kind and height."""
    alike = a.evidence == b.evidence and abs(a.sill - b.sill) < 0.1 and abs(a.top - b.top) < 0.1
    return float(np.hypot(*(a.centre - b.centre))) if alike else math.inf


def covered(point: Floats, holes: Iterable[Hole]) -> bool:
    """Return whether a point (2,) lies at one of the holes, give or take SAME."""
    for hole in holes:
        apart = point - hole.centre
        along, across = abs(float(apart @ hole.along)), abs(float(apart @ np.array([-hole.along[1], hole.along[0]])))
        if along < hole.width / 2 + SAME and across < hole.depth / 2 + SAME:
            return True
    return False


def sides(hole: Hole, outlines: Sequence[Outline], reach: float) -> tuple[list[str], Floats]:
    """Return the rooms that the hole joins (0 to 2, left side first) and its direction, squared to a room's wall.

    A leaf without reveal takes the direction of the nearest wall, for its own yaw may be a swing. A floor that reaches
    under a door lies on both sides of it at first: the room behind counts. A hole within one room joins nothing.
    """
    along = hole.along
    if hole.depth == 0.0:
        wall = _wall_direction(hole.centre, outlines, reach)
        along = hole.along if wall is None else wall
    normal = np.array([-along[1], along[0]])
    steps = np.arange(STEP, reach + STEP / 2, STEP)
    left, right = ([_room_at(hole.centre + side * step * normal, outlines) for step in steps] for side in (1.0, -1.0))
    first = [next((room for room in met if room), None) for met in (left, right)]
    if first[0] is None or first[0] != first[1]:
        return [room for room in first if room], along
    same = first[0]
    others = [(k, side, room) for side, met in enumerate((left, right)) for k, room in enumerate(met) if room not in {None, same}]
    if others:
        _, side, room = min(others)
        return ([str(room), same] if side == 0 else [same, str(room)]), along
    return ([] if left[-1] == right[-1] == same else [same]), along


def _room_at(point: Floats, outlines: Sequence[Outline]) -> str | None:
    place = shapely.Point(point)
    return next((o.room_id for o in outlines if o.polygon.contains(place)), None)


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
    rooms, along = sides(hole, outlines, reach + max(0.0, hole.depth - USUAL_DEPTH) / 2)
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


def touching(outlines: Sequence[Outline], height: float, known: Sequence[Opening]) -> list[Opening]:
    """Return the opening of each pair of rooms whose floors meet without a wall: `open`, or `portal` on a doorway's width.

    One that is `known` already, as a door whose threshold both floors share, is left out; ids go on from `known`.
    """
    found: list[Opening] = []
    for i, a in enumerate(outlines):
        for b in outlines[i + 1 :]:
            if a.polygon.distance(b.polygon) > TOUCHING:
                continue
            rooms = tuple(sorted((a.room_id, b.room_id)))
            edges = [e for e in _shared(a.polygon, b.polygon) if not _is_known(e, rooms, known)]
            longest = max(edges, key=_length, default=None)
            if longest is None or _length(longest) < LEAST_FRONT:
                continue
            ends = np.round(longest[np.lexsort((longest[:, 1], longest[:, 0]))], 4)
            doorway = _length(longest) <= DOORWAY
            kind: OpeningKind = "portal" if doorway else "open"
            top = min(DOOR_HEIGHT, height) if doorway else height
            found.append(Opening(f"opening_{len(known) + len(found)}", kind, rooms, ends, top))
    return found


def _shared(a: Polygon, b: Polygon) -> list[Floats]:
    """Return the straight parts (2, 2) of the outline of `a` that `b` touches."""
    shared = a.exterior.intersection(b.buffer(TOUCHING))
    shared = shapely.line_merge(shared) if shared.geom_type == "MultiLineString" else shared
    return [edge for part in shapely.get_parts(shared) if isinstance(part, LineString) for edge in _straight_parts(part)]


def _is_known(edge: Floats, rooms: tuple[str, ...], known: Sequence[Opening]) -> bool:
    """Return whether an opening between the same rooms takes up this edge (2, 2)."""
    middle = shapely.Point(edge.mean(axis=0))
    return any(
        o.rooms == rooms and o.kind != "window" and o.width > _length(edge) - SAME and LineString(o.segment).distance(middle) < SAME
        for o in known
    )


def _length(edge: Floats) -> float:
    return float(np.hypot(*(edge[1] - edge[0])))


def _straight_parts(line: LineString) -> list[Floats]:
    points = np.asarray(line.coords)
    return [np.array([a, b]) for a, b in itertools.pairwise(points)]
