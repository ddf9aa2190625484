"""Openings of a sketch put into its walls: each on a stretch that is long enough, none upon another, leaves that can swing."""

import dataclasses
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from pipeline.arrays import Floats
from pipeline.entities.plan import Opening, Room, Swing
from pipeline.floorplan.imports.sketch import OwnPlanError, Sketch, SketchOpening, refuse
from pipeline.floorplan.imports.wall_stretches import TOUCH, Stretch
from pipeline.floorplan.program.defaults import DOOR, DOOR_HEIGHT

EDGE = 0.02  # [m] least wall beside an opening
JAMBS = 0.15  # [m] that an opening as wide as its wall is narrowed by at most; an open front, and a house of a dataset, by more
POST = 0.15  # [m] that an opening which meets another one is narrowed by at most; in a house of a dataset by half of it
REACH = 0.25  # [m] beyond the wall's faces, from which an opening is still moved onto it
SLIDE = 0.5  # [m] along the wall, by which an opening that sticks out at its end is moved
SLANT = 0.94  # cosine: segments within 20 degrees of their wall
STATED = 0.02  # [m] moves that are worth a word
NARROWEST = {"door": 0.3, "entrance": 0.3, "portal": 0.3, "open": 0.3, "window": 0.2}  # [m]; a robot may be wider than a door
ANGLE = 1.5  # [rad] how far leaves open where the file does not say
WIDEST_LEAF = 1.3  # [m] a wider door slides, or is a gate
LEAF_GAP = 0.03  # [m] between a leaf's sweep and other leaves or openings
CORNER = 0.10  # [m] of wall that a door gets beside it where the plan leaves its place open


@dataclass(slots=True)
class Fitted:
    """An opening in its wall."""

    opening: Opening
    stretch: Stretch


def fit_openings(sketch: Sketch, rooms: Sequence[Room], walls: Sequence[Stretch]) -> list[Fitted]:
    """Put every opening of the sketch into a wall. Raises RefusedError for one that has none; in a house of a dataset it is left out."""
    known = {r.room_id: r for r in rooms}
    placed: list[Fitted] = []
    # those whose place is stated go first: the others take what is left; in houses of datasets windows give way to doors
    for wish in sorted(sketch.openings, key=lambda o: (o.segment is None and o.at is None, sketch.foreign and o.kind == "window")):
        try:
            placed.append(_fit(sketch, wish, known, walls, placed))
        except OwnPlanError as error:
            if not sketch.foreign:
                raise
            sketch.repair("left_out", wish.opening_id, f"left out: {error.why}")
    order = {o.opening_id: k for k, o in enumerate(sketch.openings)}
    return sorted(placed, key=lambda f: order[f.opening.opening_id])


def put_door(name: str, pair: Iterable[str], walls: Sequence[Stretch], placed: Sequence[Fitted], width: float = DOOR) -> Fitted | None:
    """Return a new door (or an entrance for a single room) on the longest stretch with room for it, None where there is none."""
    wanted = tuple(pair)
    for stretch in sorted((s for s in walls if set(s.rooms) == set(wanted)), key=lambda s: -round(s.length, 3)):
        low = _free_place(stretch, width, placed)
        if low is not None and (stretch.thickness >= TOUCH or len(wanted) == 1):
            kind = "entrance" if len(wanted) == 1 else "door"
            opening = Opening(name, kind, stretch.rooms, stretch.at(low, low + width), DOOR_HEIGHT, 0.0, None, stretch.level)  # type: ignore[arg-type]
            return Fitted(opening, stretch)
    return None


def _fit(sketch: Sketch, wish: SketchOpening, rooms: dict[str, Room], walls: Sequence[Stretch], placed: Sequence[Fitted]) -> Fitted:
    name = wish.opening_id
    width = wish.width if wish.segment is None else float(np.linalg.norm(wish.segment[1] - wish.segment[0]))
    if width is None:
        width = {"window": 1.2, "entrance": 0.9, "portal": 1.2}.get(wish.kind, DOOR)
    if width < NARROWEST[wish.kind]:
        raise refuse(f"{name} is {width:.2f} m wide; a {wish.kind} has {NARROWEST[wish.kind]:g} m or more")
    mine = [s for s in walls if s.level == wish.level and _may_stand_in(wish, s, sketch.foreign)]
    if not mine and wish.rooms:
        between = " and ".join(wish.rooms)
        joined = len(wish.rooms) == 2
        raise refuse(f"{name} is to join {between}, which share no wall" if joined else f"{between} has no outside wall for {name}")
    if wish.segment is None and wish.at is None:
        stretch, low = _any_place(wish, width, mine, placed)
        width = stretch.length - 2 * EDGE if wish.kind == "open" and wish.width is None else width
    else:
        stretch, low, width = _stated_place(sketch, wish, width, mine)
    if wish.kind in {"door", "entrance", "window"} and len(stretch.rooms) == 2 and stretch.thickness < TOUCH:
        message = f"{name} has no wall to stand in: {' and '.join(stretch.rooms)} touch"
        raise refuse(message, "leave walls between the rooms, or state `faces: centre`")
    low, width = _narrowed(sketch, wish, stretch, (low, width), placed)
    kind = wish.kind
    if kind == "entrance" and len(stretch.rooms) == 2:
        kind = "door"
        sketch.repair("entrance", name, f"it lies between {' and '.join(stretch.rooms)}: taken as a door")
    height, sill = _heights(sketch, wish, min(rooms[r].height for r in stretch.rooms))
    segment = stretch.at(low, low + width)
    swing = wish.swing
    if wish.segment is not None and float((wish.segment[1] - wish.segment[0]) @ stretch.along) < 0:
        segment = segment[::-1].copy()
    if swing is not None and (swing.room_id not in stretch.rooms or kind not in {"door", "entrance"}):
        raise refuse(f"the leaf of {name} swings into {swing.room_id}, which it does not lead to")
    rooms_said = wish.rooms if len(wish.rooms) == len(stretch.rooms) else stretch.rooms
    return Fitted(Opening(name, kind, rooms_said, segment, height, sill, swing, stretch.level), stretch)


def _may_stand_in(wish: SketchOpening, stretch: Stretch, foreign: bool) -> bool:
    """Whether an opening may stand in a stretch of its storey: between its rooms; an entrance leads outside.

    In a dataset's house, where one of its rooms is known, another may lie behind a thick wall.
    """
    if not wish.rooms:
        return wish.kind not in {"open", "portal"} or len(stretch.rooms) == 2
    return set(stretch.rooms) == set(wish.rooms) or (foreign and len(wish.rooms) == 1 and wish.rooms[0] in stretch.rooms)


def _narrowed(
    sketch: Sketch, wish: SketchOpening, stretch: Stretch, place: tuple[float, float], placed: Sequence[Fitted]
) -> tuple[float, float]:
    """Return from where and how wide [m] an opening is that adjoins others, as the panes of a bay do: narrowed for a post between them."""
    low, width = place
    most = width / 2 if sketch.foreign else POST
    for other in placed:
        if other.stretch.level != stretch.level or _line(other).distance(_line(stretch, low, width)) >= 1e-6:
            continue
        taken = sorted(float(v) for v in (other.opening.segment - stretch.start) @ stretch.along)
        post = 2 * EDGE if other.stretch is stretch else 2 * EDGE + other.stretch.thickness / 2
        start, end = max(((low, taken[0] - post), (taken[1] + post, low + width)), key=lambda s: s[1] - s[0])
        if end - start < max(NARROWEST[wish.kind], place[1] - most):
            raise refuse(f"{wish.opening_id} and {other.opening.opening_id} are in one place")
        text = f"it meets {other.opening.opening_id}: {width - end + start:.2f} m of it become the post between them"
        sketch.repair("narrowed", wish.opening_id, text)
        low, width = start, end - start
    return low, width


def _any_place(wish: SketchOpening, width: float, walls: Sequence[Stretch], placed: Sequence[Fitted]) -> tuple[Stretch, float]:
    """Return a place for an opening of which only the rooms are stated; an open front takes the whole wall."""
    longest = max(walls, key=lambda s: s.length)
    if wish.kind == "open" and wish.width is None:
        return longest, EDGE
    for stretch in sorted(walls, key=lambda s: -round(s.length, 3)):
        low = _free_place(stretch, width, placed)
        if low is not None:
            return stretch, low
    raise refuse(f"{wish.opening_id} is {width:.2f} m wide and its wall {longest.length:.2f} m, other openings included")


def _stated_place(sketch: Sketch, wish: SketchOpening, width: float, walls: Sequence[Stretch]) -> tuple[Stretch, float, float]:
    """Return the nearest stretch to where the opening is stated, its place on it, and its width, less what its jambs need."""
    middle = wish.segment.mean(axis=0) if wish.segment is not None else wish.at
    assert middle is not None
    best: tuple[float, Stretch, float] | None = None
    for stretch in walls:
        if wish.segment is not None and abs(float((wish.segment[1] - wish.segment[0]) @ stretch.along)) < SLANT * width:
            continue
        across = abs(float((middle - stretch.start) @ stretch.left))
        along = float((middle - stretch.start) @ stretch.along)
        key = across + max(0.0, width / 2 - along, along + width / 2 - stretch.length)
        near = across <= stretch.thickness / 2 + REACH and -SLIDE <= along <= stretch.length + SLIDE
        if near and (best is None or key < best[0] - 1e-9):
            best = (key, stretch, along - width / 2)
    if best is None:
        at = f"({middle[0]:.2f}, {middle[1]:.2f})"
        where = f" between {' and '.join(wish.rooms)}" if len(wish.rooms) == 2 else f" of {wish.rooms[0]}" if wish.rooms else ""
        raise refuse(f"{wish.opening_id} at {at} lies on no wall{where}")
    _, stretch, low = best
    clear = stretch.length - 2 * EDGE
    if width > clear + 1e-6:
        spare = 2 * SLIDE if wish.kind == "open" else JAMBS
        if clear < NARROWEST[wish.kind] or width - clear > (max(width / 2, spare) if sketch.foreign else spare):
            raise refuse(f"{wish.opening_id} is {width:.2f} m wide and its wall {stretch.length:.2f} m")
        text = f"{width:.2f} m wide in a wall of {stretch.length:.2f} m, no wall is left for its jambs: narrowed to {clear:.2f} m"
        sketch.repair("narrowed", wish.opening_id, text)
        low, width = EDGE, clear
    moved = float(np.clip(low, EDGE, stretch.length - width - EDGE))
    slide = abs(moved - low)
    if slide > SLIDE:
        raise refuse(f"{wish.opening_id} sticks out {slide:.2f} m at the end of its wall")
    shift = float(np.hypot(slide, abs(float((middle - stretch.start) @ stretch.left))))
    if shift > max(STATED, stretch.thickness / 2 + 1e-3):  # on the wall's face is where many files have them
        sketch.repair("moved", wish.opening_id, f"moved {shift:.2f} m onto the wall of {' and '.join(stretch.rooms)}")
    return stretch, moved, width


def _free_place(stretch: Stretch, width: float, placed: Sequence[Fitted]) -> float | None:
    """Return where an opening of `width` finds wall: near an end, else in any gap."""
    slack = stretch.length - width
    if slack < 2 * EDGE:
        return None
    margin = min(CORNER, slack / 2)
    steps = np.arange(margin, slack - margin + 1e-9, 0.05) if slack > 2 * margin else np.array([slack / 2])
    for low in steps:
        line = _line(stretch, float(low) - EDGE, width + 2 * EDGE)
        if all(f.stretch.level != stretch.level or _line(f).distance(line) > TOUCH for f in placed):
            return float(low)
    return None


def _line(of: Fitted | Stretch, low: float = 0.0, width: float = 0.0) -> shapely.LineString:
    return shapely.LineString(of.opening.segment if isinstance(of, Fitted) else of.at(low, low + width))


def _heights(sketch: Sketch, wish: SketchOpening, ceiling: float) -> tuple[float, float]:
    """Return height and sill [m], kept under the ceiling."""
    usual = {"window": 1.3, "open": 2.4, "portal": 2.2}.get(wish.kind, DOOR_HEIGHT)
    sill = (0.9 if wish.sill is None else wish.sill) if wish.kind == "window" else 0.0
    height = min(usual, ceiling - sill - 0.05) if wish.height is None else wish.height
    if sill + height > ceiling:
        sketch.repair("height", wish.opening_id, f"its top at {sill + height:.2f} m is lowered to the ceiling at {ceiling:.2f} m")
        height = ceiling - sill
    if height < 0.2:
        raise refuse(f"{wish.opening_id} begins {sill:.2f} m above the floor under a ceiling at {ceiling:.2f} m")
    if wish.kind != "window" and height < 1.6:
        raise refuse(f"{wish.opening_id} is {height:.2f} m high; nobody walks through it")
    return round(height, 4), round(sill, 4)


def hang_leaves(sketch: Sketch, fitted: list[Fitted], rooms: Sequence[Room], depth: dict[str, int], thickness: float) -> list[Opening]:
    """Give every door a leaf that swings freely: as the file states it, else into the room farther from the entrance."""
    floors = {r.room_id: shapely.Polygon(r.polygon) for r in rooms}
    kinds = {r.room_id: r.type for r in rooms}
    swept: list[tuple[tuple[str, int], shapely.Polygon]] = []
    done: dict[str, Opening] = {}
    leaves = [f for f in fitted if f.opening.kind in {"door", "entrance"}]
    for item in sorted(leaves, key=lambda f: f.opening.swing is None):
        stated, o = item.opening.swing, item.opening
        if stated is None and o.width > WIDEST_LEAF:
            sketch.repair("no_leaf", o.opening_id, f"{o.width:.2f} m is too wide for a leaf that swings; the door has none")
            continue
        order = sorted(o.rooms, key=lambda r: (kinds[r] in {"wc", "balcony"}, -depth.get(r, 0)))
        wished = [] if stated is None else [stated]
        for swing in [*wished, *(Swing(room, end, ANGLE) for room in order for end in _ends(floors[room], o.segment))]:
            sweep = sweep_of(o.segment, swing, floors[swing.room_id])
            if _clear(sweep, swing.room_id, o, floors, swept, fitted, thickness):
                swept.append(((swing.room_id, o.level), sweep))
                done[o.opening_id] = dataclasses.replace(o, swing=swing)
                if stated is not None and swing != stated:
                    sketch.repair("swing", o.opening_id, f"its leaf cannot turn as stated and swings into {swing.room_id}")
                break
        else:
            done[o.opening_id] = dataclasses.replace(o, swing=None)
            sketch.repair("no_leaf", o.opening_id, "a leaf finds no room to swing; the door has none")
    return [done.get(f.opening.opening_id, f.opening) for f in fitted]


def sweep_of(segment: Floats, swing: Swing, floor: shapely.Polygon) -> shapely.Polygon:
    """Return what a leaf sweeps on the side of its room: a sector about the hinge."""
    pivot, tip = segment[swing.hinge], segment[1 - swing.hinge]
    closed = tip - pivot
    turned = np.array([-closed[1], closed[0]])
    middle = segment.mean(axis=0)
    one, other = (floor.distance(shapely.Point(middle + side * turned)) for side in (0.5, -0.5))
    inward = turned if one <= other else -turned
    angles = np.linspace(0.0, swing.angle, 9)
    return shapely.Polygon(np.vstack([pivot, pivot + np.cos(angles)[:, None] * closed + np.sin(angles)[:, None] * inward]))


def _ends(floor: shapely.Polygon, segment: Floats) -> tuple[int, int]:
    """Return the hinge ends, the one nearer to a corner of the room first."""
    corners = np.asarray(floor.exterior.coords)
    near = [float(np.linalg.norm(corners - end, axis=1).min()) for end in segment]
    return (0, 1) if near[0] <= near[1] else (1, 0)


def _clear(
    sweep: shapely.Polygon,
    room: str,
    own: Opening,
    floors: dict[str, shapely.Polygon],
    swept: Sequence[tuple[tuple[str, int], shapely.Polygon]],
    fitted: Sequence[Fitted],
    thickness: float,
) -> bool:
    beyond = sweep.difference(floors[room])
    # what lies in the wall is a strip of half its thickness along the segment
    jamb = shapely.LineString(own.segment).buffer(thickness / 2 + 0.01, cap_style="flat")
    if beyond.difference(jamb).area > 1e-3:
        return False
    if any(where == (room, own.level) and other.distance(sweep) < LEAF_GAP for where, other in swept):
        return False
    others = (f.opening for f in fitted if f.opening.opening_id != own.opening_id and f.opening.kind != "window")
    lines = [shapely.LineString(o.segment) for o in others if room in o.rooms and o.level == own.level]
    return all(line.distance(sweep.intersection(floors[room])) >= LEAF_GAP for line in lines)
