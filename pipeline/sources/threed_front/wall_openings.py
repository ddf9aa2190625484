"""Doors and windows of a 3D-FRONT house from geometry: the file's own lists do not say which rooms they join.

What the evidence gives (`opening_evidence`, `reveals`) is put between rooms: on each side of the wall, the first outline met
within `reach` of the opening's centre.
"""

import itertools
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from shapely.geometry import LineString, Polygon

from pipeline.entities.plan import Opening, OpeningKind
from pipeline.sources.threed_front.opening_evidence import DOOR_HEIGHT, MIN_PANE, MIN_WIDTH, Floats, OpeningEvidence
from pipeline.sources.threed_front.reveals import SAME, bays, group_evidence

DOORWAY = 1.2  # [m] floors that meet on no more than this meet under a doorway
USUAL_DEPTH = 0.3  # [m] of the thickest usual wall; an opening that is deeper, a bay, reaches as much farther
WINDOW_SILL = 0.3  # [m] a hole that starts above this is a window
OPEN_WIDTH = 1.8  # [m] a hole without a leaf that is wider is an open front
LEAST_FRONT = 0.6  # [m] rooms that meet on less are not open to each other
WALL_NEAR = 0.16  # [m] from where floors meet to the faces of the wall between them
TOUCHING = 0.03  # [m] rooms nearer than this have no wall between them
STEP = 0.04  # [m] of the walk from an opening's centre to the rooms
LEAST_DOOR = 0.5  # [m] a default width is not cut down to less
LOWEST = 1.2  # [m] a door or hole that is lower is none
LEAF_DEPTH, ASLANT = 0.1, 0.95  # [m] of a leaf, and the cosine from which it stands along its wall
IN_ROOM = 0.15  # [m] a leaf that stands deeper in a room than this is open, and no sign of a door where it stands


@dataclass(frozen=True, slots=True)
class Outline:
    """A room as the openings see it: its id and its polygon in plan."""

    room_id: str
    polygon: Polygon


def sides(hole: OpeningEvidence, outlines: Sequence[Outline], reach: float) -> tuple[list[str], Floats]:
    """Return the rooms that the hole joins (0 to 2, left side first) and its direction.

    A leaf without reveal takes the direction of the nearest wall, for its own yaw may be a swing. A floor that reaches
    under a door lies on both sides of it at first: the room behind counts. A hole within one room joins nothing.
    """
    along = hole.along
    if hole.origin == "record" and (wall := _wall(hole, outlines, reach)) is not None:
        along = (wall[1] - wall[0]) / _length(wall)
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


def _wall(hole: OpeningEvidence, outlines: Sequence[Outline], reach: float) -> Floats | None:
    """Return the nearest wall (2, 2) within `reach` that is long enough for such an opening, None where there is none."""
    least, centre = MIN_PANE if hole.evidence == "window" else MIN_WIDTH, hole.centre
    best: tuple[float, Floats] | None = None
    for outline in outlines:
        for a, b in itertools.pairwise(np.asarray(outline.polygon.exterior.coords)):
            length = float(np.hypot(*(b - a)))
            t = min(1.0, max(0.0, float((centre - a) @ (b - a)) / length**2))
            gap = float(np.hypot(*(a + t * (b - a) - centre)))
            if length > least and gap < reach and (best is None or gap < best[0]):
                best = (gap, np.array([a, b]))
    return None if best is None else best[1]


def openings(
    evidence: Iterable[OpeningEvidence], outlines: Sequence[Outline], height: float, reach: float, walls: Callable[[], shapely.Geometry]
) -> tuple[list[Opening], dict[int, list[float]], list[OpeningEvidence]]:
    """Return the openings, how deep their reveals are by the number of rooms they join [m], and the evidence that is no opening.

    `height` [m] is that of open fronts, `reach` [m] how far from an opening's middle its rooms begin; `walls` gives the walls' faces in plan.
    """
    known = group_evidence(_in_wall(h, outlines, reach) for h in evidence)
    room_openings: list[Opening] = []
    depths: dict[int, list[float]] = {1: [], 2: []}
    lost: list[OpeningEvidence] = []

    def take(holes: Iterable[OpeningEvidence], left: list[OpeningEvidence]) -> None:
        for hole in holes:
            opening = None if _ajar(hole, outlines) else resolve(hole, outlines, f"opening_{len(room_openings)}", reach)
            if opening is None:
                left.append(hole)
                continue
            room_openings.append(opening)
            if 0.05 <= hole.depth <= 0.5:
                depths[len(opening.rooms)].append(hole.depth)

    take(known.holes, lost)
    panes = [h for h in lost if h.evidence == "window"]
    rest = [h for h in lost if h.evidence != "window"]
    around = bays(panes)
    take(around, rest)
    rest += [p for p in panes if not any(_holds(bay, p) for bay in around)]
    return [*room_openings, *touching(outlines, height, room_openings, walls)], depths, [*rest, *known.rest]


def _in_wall(hole: OpeningEvidence, outlines: Sequence[Outline], reach: float) -> OpeningEvidence:
    """Return evidence as the walls let it be read.

    A record without a size takes the direction of the nearest wall and is no wider than it; a mesh of type Door that stands in a
    room, or aslant in its wall, is a leaf that is drawn open, and tells no more than a record does.
    """
    if hole.evidence == "door" and hole.origin == "reveal" and not hole.flat and _is_leaf(hole, outlines, reach):
        return replace(hole, origin="record", depth=0.0)
    wall = None if hole.origin != "record" or hole.sized else _wall(hole, outlines, reach)
    if wall is None:
        return hole
    turned = replace(hole, along=(wall[1] - wall[0]) / _length(wall))
    low, high = (float((end - hole.centre) @ turned.along) for end in wall)
    low, high = max(low, -hole.width / 2), min(high, hole.width / 2)
    return turned.between(low, high) if high - low >= LEAST_DOOR or hole.evidence == "window" else turned


def _is_leaf(hole: OpeningEvidence, outlines: Sequence[Outline], reach: float) -> bool:
    """Whether a door's mesh is no reveal: it stands in a room, or is thin and aslant to the nearest wall."""
    wall = _wall(hole, outlines, reach) if hole.depth < LEAF_DEPTH else None
    aslant = wall is not None and abs(float(hole.along @ (wall[1] - wall[0]))) < ASLANT * _length(wall)
    return aslant or _in_room(hole, outlines)


def _in_room(hole: OpeningEvidence, outlines: Sequence[Outline]) -> bool:
    """Whether the middle of a hole lies in a room and not in its wall, nor on a threshold as deep as the hole."""
    place = shapely.Point(hole.centre)
    return any(o.polygon.contains(place) and o.polygon.exterior.distance(place) > IN_ROOM + hole.depth / 2 for o in outlines)


def _ajar(hole: OpeningEvidence, outlines: Sequence[Outline]) -> bool:
    """Whether it is a leaf that nothing but itself tells of, and that stands in a room."""
    return hole.origin == "record" and hole.evidence == "door" and _in_room(hole, outlines)


def _holds(bay: OpeningEvidence, pane: OpeningEvidence) -> bool:
    apart = pane.centre - bay.centre
    return bool(abs(apart @ bay.along) <= bay.width / 2 + SAME and abs(apart @ bay.across) <= bay.depth / 2 + SAME)


def resolve(hole: OpeningEvidence, outlines: Sequence[Outline], opening_id: str, reach: float) -> Opening | None:
    """Return the opening, or None where no room lies at it, or nobody could pass it upright."""
    rooms, along = sides(hole, outlines, reach + max(0.0, hole.depth - USUAL_DEPTH) / 2)
    if not rooms:
        return None
    kind = _kind(hole, len(rooms))
    if kind != "window" and hole.top - max(hole.sill, 0.0) < LOWEST:
        return None
    half = along * hole.width / 2
    ends = np.round(np.array([hole.centre - half, hole.centre + half]), 4) + 0.0
    ends = ends[np.lexsort((ends[:, 1], ends[:, 0]))]
    sill = round(max(hole.sill, 0.0), 4) if kind == "window" else 0.0
    return Opening(opening_id, kind, tuple(sorted(rooms)), ends, round(hole.top - sill, 4), sill)


def _kind(hole: OpeningEvidence, rooms: int) -> OpeningKind:
    if hole.evidence == "window" or (hole.evidence == "hole" and hole.sill > WINDOW_SILL):
        return "window"
    if rooms == 1:
        return "entrance"
    if hole.evidence == "door":
        return "door"
    return "open" if hole.width > OPEN_WIDTH else "portal"


def touching(
    outlines: Sequence[Outline], height: float, known: Sequence[Opening], walls: Callable[[], shapely.Geometry] = shapely.MultiLineString
) -> list[Opening]:
    """Return the opening of each pair of rooms whose floors meet without a wall: `open`, or `portal` on a doorway's width.

    Floors may meet in the middle of a wall: there is none where one of the `walls` (their faces in plan) stands, nor where an
    opening is `known` already, for it has a wall around it. Ids go on from `known`.
    """
    passages: list[Opening] = []
    for i, a in enumerate(outlines):
        for b in outlines[i + 1 :]:
            if a.polygon.distance(b.polygon) > TOUCHING:
                continue
            rooms = tuple(sorted((a.room_id, b.room_id)))
            edges = [e for e in _shared_edges(a.polygon, b.polygon) if _length(e) >= LEAST_FRONT and not _is_known(e, rooms, known)]
            edges = [e for e in edges if _wall_share(e, walls()) < 0.5] if edges else []
            longest = max(edges, key=_length, default=None)
            if longest is None:
                continue
            ends = np.round(longest[np.lexsort((longest[:, 1], longest[:, 0]))], 4)
            doorway = _length(longest) <= DOORWAY
            kind: OpeningKind = "portal" if doorway else "open"
            top = min(DOOR_HEIGHT, height) if doorway else height
            passages.append(Opening(f"opening_{len(known) + len(passages)}", kind, rooms, ends, top))
    return passages


def _shared_edges(a: Polygon, b: Polygon) -> list[Floats]:
    """Return the straight parts (2, 2) of the outline of `a` that `b` touches."""
    shared = a.exterior.intersection(b.buffer(TOUCHING))
    shared = shapely.line_merge(shared) if shared.geom_type == "MultiLineString" else shared
    return [edge for part in shapely.get_parts(shared) if isinstance(part, LineString) for edge in _straight_parts(part)]


def _is_known(edge: Floats, rooms: tuple[str, ...], known: Sequence[Opening]) -> bool:
    """Return whether an opening between the same rooms lies on this edge (2, 2): then there is a wall, or it is open already."""
    line = LineString(edge)
    middles = (shapely.Point(o.segment.mean(axis=0)) for o in known if o.rooms == rooms and o.kind != "window")
    return any(line.distance(middle) < SAME for middle in middles)


def _wall_share(edge: Floats, walls: shapely.Geometry) -> float:
    """Return the share of an edge (2, 2) along which a wall stands."""
    line = LineString(edge)
    return float(line.intersection(walls.buffer(WALL_NEAR, cap_style="flat")).length / line.length)


def _length(edge: Floats) -> float:
    return float(np.hypot(*(edge[1] - edge[0])))


def _straight_parts(line: LineString) -> list[Floats]:
    points = np.asarray(line.coords)
    return [np.array([a, b]) for a, b in itertools.pairwise(points)]
