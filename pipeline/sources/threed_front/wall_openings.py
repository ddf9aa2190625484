"""Doors and windows of a 3D-FRONT house from geometry: the file's own lists do not say which rooms they join.

What the evidence gives (`opening_evidence`, `reveals`) is put between rooms: on each side of the wall, the first outline met
within `reach` of the opening's centre.
"""

import itertools
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np
import shapely
from shapely.geometry import LineString, Polygon

from pipeline.arrays import Floats
from pipeline.entities.plan import Opening, OpeningKind
from pipeline.sources.threed_front.opening_evidence import DOOR_HEIGHT, LEAST, SAME, OpeningEvidence
from pipeline.sources.threed_front.reveals import bays, group_evidence

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


Rooms = Mapping[str, Polygon]  # in plan, by id


def sides(hole: OpeningEvidence, rooms: Rooms, reach: float) -> tuple[set[str], Floats]:
    """Return the rooms that the hole joins (0 to 2) and its direction.

    A leaf without reveal takes the direction of the nearest wall, for its own yaw may be a swing. A floor that reaches
    under a door lies on both sides of it at first: the room behind counts. A hole within one room joins nothing.
    """
    along = hole.along
    if hole.origin == "record" and (wall := _wall(hole, rooms, reach)) is not None:
        along = (wall[1] - wall[0]) / _length(wall)
    normal = np.array([-along[1], along[0]])
    steps = np.arange(STEP, reach + STEP / 2, STEP)
    left, right = ([_room_at(hole.centre + side * step * normal, rooms) for step in steps] for side in (1.0, -1.0))
    first, second = (next(filter(None, met), "") for met in (left, right))
    if first != second or not first:
        return {first, second} - {""}, along
    behind = next((room for met in zip(left, right, strict=True) for room in met if room not in {"", first}), "")
    return set() if left[-1] == right[-1] == first and not behind else {first, behind} - {""}, along


def _room_at(point: Floats, rooms: Rooms) -> str:
    """Return the room in which a point (2,) lies, "" where it is in none."""
    return next((room for room, polygon in rooms.items() if polygon.contains(shapely.Point(point))), "")


def _wall(hole: OpeningEvidence, rooms: Rooms, reach: float) -> Floats | None:
    """Return the nearest wall (2, 2) within `reach` that is long enough for such an opening, None where there is none."""
    walls = [wall for polygon in rooms.values() for wall in _straight_parts(polygon.exterior) if _length(wall) > LEAST[hole.evidence]]
    gaps = [LineString(wall).distance(shapely.Point(hole.centre)) for wall in walls]
    nearest = int(np.argmin(gaps)) if gaps else -1
    return walls[nearest] if gaps and gaps[nearest] < reach else None


def openings(
    evidence: Iterable[OpeningEvidence], rooms: Rooms, height: float, reach: float, walls: Callable[[], shapely.Geometry]
) -> tuple[list[Opening], dict[int, list[float]], list[OpeningEvidence]]:
    """Return the openings, how deep their reveals are by the number of rooms they join [m], and the evidence that is no opening.

    `height` [m] is that of open fronts, `reach` [m] how far from an opening's middle its rooms begin; `walls` gives the walls' faces in plan.
    """
    known, rest = group_evidence([_in_wall(h, rooms, reach) for h in evidence])
    room_openings: list[Opening] = []
    depths: dict[int, list[float]] = {1: [], 2: []}
    lost: list[OpeningEvidence] = []

    def take(holes: Iterable[OpeningEvidence], left: list[OpeningEvidence]) -> None:
        for hole in holes:
            # A leaf that nothing but itself tells of, and that stands in a room, is drawn open.
            ajar = hole.origin == "record" and hole.evidence == "door" and _in_room(hole, rooms)
            opening = None if ajar else resolve(hole, rooms, f"opening_{len(room_openings)}", reach)
            if opening is None:
                left.append(hole)
                continue
            room_openings.append(opening)
            if 0.05 <= hole.depth <= 0.5:
                depths[len(opening.rooms)].append(hole.depth)

    take(known, lost)
    panes, odd = ([h for h in lost if (h.evidence == "window") is is_pane] for is_pane in (True, False))
    around = bays(panes)
    take(around, odd)
    odd += [pane for pane in panes if not any(bay.reaches(pane.centre) for bay in around)]
    return [*room_openings, *passages_between(rooms, height, room_openings, walls)], depths, [*odd, *rest]


def _in_wall(hole: OpeningEvidence, rooms: Rooms, reach: float) -> OpeningEvidence:
    """Return evidence as the walls let it be read.

    A record without a size takes the direction of the nearest wall and is no wider than it; a mesh of type Door that stands in a
    room, or aslant in its wall, is a leaf that is drawn open, and tells no more than a record does.
    """
    if hole.evidence == "door" and hole.origin == "reveal" and not hole.flat and _is_leaf(hole, rooms, reach):
        return replace(hole, origin="record", depth=0.0)
    if hole.origin != "record" or hole.sized or (wall := _wall(hole, rooms, reach)) is None:
        return hole
    turned = replace(hole, along=(wall[1] - wall[0]) / _length(wall))
    low, high = (float((end - hole.centre) @ turned.along) for end in wall)
    low, high = max(low, -hole.width / 2), min(high, hole.width / 2)
    return turned.between(low, high) if high - low >= LEAST_DOOR or hole.evidence == "window" else turned


def _is_leaf(hole: OpeningEvidence, rooms: Rooms, reach: float) -> bool:
    """Whether a door's mesh is no reveal: it stands in a room, or is thin and aslant to the nearest wall."""
    wall = _wall(hole, rooms, reach) if hole.depth < LEAF_DEPTH else None
    aslant = wall is not None and abs(float(hole.along @ (wall[1] - wall[0]))) < ASLANT * _length(wall)
    return aslant or _in_room(hole, rooms)


def _in_room(hole: OpeningEvidence, rooms: Rooms) -> bool:
    """Whether the middle of a hole lies in a room and not in its wall, nor on a threshold as deep as the hole."""
    place = shapely.Point(hole.centre)
    return any(p.contains(place) and p.exterior.distance(place) > IN_ROOM + hole.depth / 2 for p in rooms.values())


def resolve(hole: OpeningEvidence, rooms: Rooms, opening_id: str, reach: float) -> Opening | None:
    """Return the opening, or None where no room lies at it, or nobody could pass it upright."""
    joined, along = sides(hole, rooms, reach + max(0.0, hole.depth - USUAL_DEPTH) / 2)
    if not joined:
        return None
    kind = _kind(hole, len(joined))
    if kind != "window" and hole.top - max(hole.sill, 0.0) < LOWEST:
        return None
    ends = np.round(replace(hole, along=along).ends, 4) + 0.0
    sill = round(max(hole.sill, 0.0), 4) if kind == "window" else 0.0
    return Opening(opening_id, kind, tuple(sorted(joined)), _in_order(ends), round(hole.top - sill, 4), sill)


def _kind(hole: OpeningEvidence, rooms: int) -> OpeningKind:
    if hole.evidence == "window" or (hole.evidence == "hole" and hole.sill > WINDOW_SILL):
        return "window"
    if rooms == 1:
        return "entrance"
    if hole.evidence == "door":
        return "door"
    return "open" if hole.width > OPEN_WIDTH else "portal"


def passages_between(
    rooms: Rooms, height: float, known: Sequence[Opening], walls: Callable[[], shapely.Geometry] = shapely.MultiLineString
) -> list[Opening]:
    """Return the opening of each pair of rooms whose floors meet without a wall: `open`, or `portal` on a doorway's width.

    Floors may meet in the middle of a wall: there is none where one of the `walls` (their faces in plan) stands, nor where an
    opening is `known` already, for it has a wall around it. Ids go on from `known`.
    """
    passages: list[Opening] = []
    for (a, floor), (b, other) in itertools.combinations(rooms.items(), 2):
        if floor.distance(other) > TOUCHING:
            continue
        pair = tuple(sorted((a, b)))
        # An opening that is known has a wall around it.
        middles = shapely.MultiPoint([o.segment.mean(axis=0) for o in known if o.rooms == pair and o.kind != "window"])
        edges = [e for e in _shared_edges(floor, other) if _length(e) >= LEAST_FRONT and not LineString(e).distance(middles) < SAME]
        edges = [e for e in edges if _wall_share(e, walls()) < 0.5] if edges else []
        if not edges:
            continue
        longest = max(edges, key=_length)
        kind: OpeningKind = "portal" if _length(longest) <= DOORWAY else "open"
        top = min(DOOR_HEIGHT, height) if kind == "portal" else height
        passages.append(Opening(f"opening_{len(known) + len(passages)}", kind, pair, np.round(_in_order(longest), 4), top))
    return passages


def _shared_edges(a: Polygon, b: Polygon) -> list[Floats]:
    """Return the straight parts (2, 2) of the outline of `a` that `b` touches."""
    shared = a.exterior.intersection(b.buffer(TOUCHING))
    shared = shapely.line_merge(shared) if shared.geom_type == "MultiLineString" else shared
    return [edge for part in shapely.get_parts(shared) if isinstance(part, LineString) for edge in _straight_parts(part)]


def _wall_share(edge: Floats, walls: shapely.Geometry) -> float:
    """Return the share of an edge (2, 2) along which a wall stands."""
    line = LineString(edge)
    return float(line.intersection(walls.buffer(WALL_NEAR, cap_style="flat")).length / line.length)


def _in_order(edge: Floats) -> Floats:
    return np.asarray(edge[np.lexsort((edge[:, 1], edge[:, 0]))])


def _length(edge: Floats) -> float:
    return float(np.hypot(*(edge[1] - edge[0])))


def _straight_parts(line: LineString) -> list[Floats]:
    return [np.array(ends) for ends in itertools.pairwise(np.asarray(line.coords))]
