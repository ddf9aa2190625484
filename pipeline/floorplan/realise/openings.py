"""Openings in the walls of a plan: doors with a leaf, open fronts, portals, windows and the entrance.

A door stands near a corner of the room that it opens into, hinged there, so that its leaf opens against the nearer side wall.
Leaves sweep free floor: no other leaf's sweep, no other opening, no wall. Nothing is opened that was not asked for.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import shapely
from numpy.typing import NDArray

from pipeline.entities.plan import Opening, OpeningKind, Room, Swing
from pipeline.floorplan.program.defaults import DEFAULTS, DOOR_HEIGHT
from pipeline.floorplan.program.floor_program import FloorProgram, RoomReq

FRAME = 0.10  # least wall beside an opening, from the inner faces of side walls [m]
TRIES = ((1.0, FRAME), (0.7, FRAME), (0.5, FRAME), (0.35, FRAME))  # windows: share of the wished width, distance from corners [m]
CUT_TRIES = ((1.0, 0.7), (0.7, 0.7))  # where the outline's corners are to be cut
LEAF_GAP = 0.03  # leaf tip to other leaves' sweeps [m]
ANGLE = 1.5  # how far leaves open [rad]
ENTRANCE_WIDTH, GATE_WIDTH, BALCONY_WIDTH = 0.9, 2.4, 0.85
KEPT_FREE = frozenset({"balcony", "wc", "staircase"})  # leaves open away from these
SILL, WINDOW_HEIGHT = 0.9, 1.3
HIGH_SILL, HIGH_WINDOW = 1.4, 0.8
LINTEL, LEAST_WINDOW = 0.1, 0.6  # between openings and ceilings; height of a window under a low one [m]
WIDEST_WINDOW, NARROWEST_WINDOW = 2.4, 0.6
WIDEST_HIGH = {"bathroom": 0.7, "wc": 0.7, "utility": 0.7}  # of rooms whose windows sit high [m]
WIDEST = WIDEST_HIGH | {"kitchen": 1.2}  # and of kitchens, whose walls carry units [m]
DAYLIGHT = 0.125  # glass that a room has, as a share of its floor: what building codes ask for
WIDEST_GLASS = 6.0  # of a balcony
STEP = 0.05  # raster of the places that are tried [m]

Point = NDArray[np.float64]


@dataclass(frozen=True)
class Run:
    """A straight stretch of wall that is clear on both sides, on the wall's centre line [m].

    It runs along y (`vertical`, x = `line`) or along x, upwards from `start`. Room `rooms[0]` lies on its side of larger coordinates if
    `way` is 1, of smaller ones if -1; `half` is half the wall's thickness [m].
    """

    rooms: tuple[str, ...]
    vertical: bool
    line: float
    start: float
    length: float
    way: float
    level: int
    half: float

    @property
    def inward(self) -> Point:
        """Unit vector into room `rooms[0]`."""
        return np.array([self.way, 0.0] if self.vertical else [0.0, self.way])

    def segment(self, offset: float, width: float) -> Point:
        """Return the end points of an opening of `width` that begins `offset` from the start, to 1 mm."""
        low = round(offset, 3)
        ends = (self.start + low, self.start + (low + round(width, 3)))
        return np.round(np.array([(self.line, y) if self.vertical else (y, self.line) for y in ends]), 3)


@dataclass
class Site:
    """What has been placed so far: openings with their runs and offsets, and the floor that leaves sweep per room."""

    rooms: dict[str, Room]
    thickness: float  # of the thickest wall [m]
    ceiling: float  # height of the rooms [m]
    openings: list[Opening] = field(default_factory=list)
    taken: list[tuple[Run, float, float]] = field(default_factory=list)  # from, to [m]
    swept: list[tuple[str, shapely.Geometry]] = field(default_factory=list)

    def free(self, run: Run, offset: float, width: float) -> bool:
        """Whether the stretch of wall overlaps no opening there is."""
        low, high = run.start + offset, run.start + (offset + width)
        for other, start, end in self.taken:
            near = (other.level, other.vertical) == (run.level, run.vertical) and abs(other.line - run.line) < self.thickness
            if near and low < end + FRAME and start < high + FRAME:
                return False
        return True

    def under(self, top: float) -> float:
        """Return the height of a top that stays under the ceiling [m]."""
        return round(min(top, self.ceiling - LINTEL), 3)

    def put(
        self, run: Run, kind: OpeningKind, offset: float, width: float, height: float, sill: float = 0.0, swing: Swing | None = None
    ) -> None:
        """Put an opening into a wall, `offset` from its start [m]."""
        name = f"{kind}_{sum(o.opening_id.startswith(kind + '_') for o in self.openings)}"
        opening = Opening(name, kind, run.rooms, run.segment(offset, width), height, sill, swing, run.level)
        self.openings.append(opening)
        self.taken.append((run, run.start + offset, run.start + (offset + opening.width)))


def leaf_sweep(segment: Point, hinge: int, inward: Point, radius: float) -> shapely.Polygon:
    """Return the quarter disc that a leaf sweeps, as a polygon of nine chords."""
    pivot, tip = segment[hinge], segment[1 - hinge]
    closed = (tip - pivot) / np.linalg.norm(tip - pivot)
    angles = np.linspace(0.0, np.pi / 2, 9)
    arc = pivot + radius * (np.cos(angles)[:, None] * closed + np.sin(angles)[:, None] * inward)
    return shapely.Polygon(np.vstack([pivot, arc]))


def place(
    program: FloorProgram, rooms: Sequence[Room], runs: Sequence[Run], depth: dict[str, int], rng: np.random.Generator
) -> tuple[Opening, ...] | None:
    """Return all openings of the plan, or None when a required one finds no place.

    `depth` is each room's distance from the entrance in openings: leaves swing into the farther room.
    """
    shell = program.shell
    site = Site({r.room_id: r for r in rooms}, max(shell.inner_wall, shell.outer_wall), shell.ceiling)
    requests = {r.id: r for r in program.rooms}
    wide = [k for k in program.links if k.kind in {"open", "portal"}]
    narrow = [k for k in program.links if k.kind == "door"]
    for link in wide:
        stairs = any(requests[i].type == "staircase" for i in link.ends)
        if not _wide(site, [r for r in runs if set(r.rooms) == link.ends], link.kind, stairs):
            return None
    if not _entrance(program, site, runs, rng):
        return None
    # the tightest walls first
    narrow.sort(key=lambda k: max((r.length for r in runs if set(r.rooms) == k.ends), default=0.0))
    for link in narrow:
        between = [r for r in runs if set(r.rooms) == link.ends]
        far, near = (link.a, link.b) if depth[link.a] >= depth[link.b] else (link.b, link.a)
        width = max(BALCONY_WIDTH if "balcony" in {requests[far].type, requests[near].type} else 0.0, program.accessibility.min_door)
        roomy = min(requests[far].area.target or 0, requests[near].area.target or 0) >= 9.0
        widths = ([0.9] if roomy and width < 0.9 else []) + [width]
        sides = (near, far) if requests[far].type in KEPT_FREE else (far, near)
        if not any(_door(site, between, "door", w, side, DOOR_HEIGHT, rng) for side in sides for w in widths):
            return None
    for room in program.rooms:
        tries = (CUT_TRIES if program.footprint.corners == "chamfered" else ()) + TRIES
        _windows(site, room, [r for r in runs if r.rooms == (room.id,)], tries)
    return tuple(site.openings)


def _wide(site: Site, between: Sequence[Run], kind: str, stairs: bool) -> bool:
    """Open the whole wall (`open`) or a leafless passage in its middle (`portal`). A staircase opens no wider than 1.2 m."""
    best = max(between, key=lambda r: r.length, default=None)
    if best is None:
        return False
    clear = best.length - 2 * FRAME
    width = min(clear if kind == "open" else min(clear, 1.6), 1.2 if stairs else np.inf)
    if width < 0.79:
        return False
    site.put(best, "open" if kind == "open" else "portal", (best.length - width) / 2, width, site.under(2.4 if kind == "open" else 2.2))
    return True


def _entrance(program: FloorProgram, site: Site, runs: Sequence[Run], rng: np.random.Generator) -> bool:
    """Place the entrance, a garage's gate, and outside doors of rooms that have one of their own."""
    into = program.entrance.into or ""
    own = {r.id for s in program.entrance.separate for r in program.select(s)}
    own |= {r.id for r in program.rooms if r.exterior == "door" and r.type != "garage"}
    width = max(ENTRANCE_WIDTH, program.accessibility.min_door)
    walls = [r for r in runs if r.rooms == (into,) and r.level == 0]
    if not _door(site, walls, "entrance", width, into, 2.1, rng):
        return False
    for room in program.rooms:
        walls = [r for r in runs if r.rooms == (room.id,)]
        if room.type == "garage":
            best = max(walls, key=lambda r: r.length, default=None)
            if best is None or best.length < GATE_WIDTH + 2 * FRAME:
                return False
            site.put(best, "door", (best.length - GATE_WIDTH) / 2, GATE_WIDTH, site.under(2.1))
        elif room.id in own and room.id != into and not _door(site, walls, "door", width, room.id, DOOR_HEIGHT, rng):
            return False
    return True


def _door(site: Site, walls: Sequence[Run], kind: OpeningKind, width: float, into: str, height: float, rng: np.random.Generator) -> bool:
    """Place a door with a leaf that swings into room `into`; the first free place of the preferred order is taken."""
    room = site.rooms[into]
    floor = shapely.Polygon(room.polygon)
    for run in sorted(walls, key=lambda r: -round(r.length, 3)):
        if run.length < width + 2 * FRAME - 1e-6:
            continue
        inward = run.inward if run.rooms[0] == into else -run.inward
        slack = run.length - width - 2 * FRAME
        offsets = [FRAME + min(k * STEP, slack) for k in range(int(np.ceil(slack / STEP - 1e-9)) + 1)]
        flip = rng.random() < 0.5
        # nearest to either end first, the end by a coin
        for offset in sorted(offsets, key=lambda o: (round(min(o, run.length - width - o), 4), (o > run.length / 2) != flip)):
            if not site.free(run, offset, width):
                continue
            segment = run.segment(offset, width)
            hinge = _near_corner(floor, segment, run.vertical)
            for end in (hinge, 1 - hinge):
                if _leaf_fits(site, floor, into, segment, end, inward, width, run.half):
                    site.put(run, kind, offset, width, site.under(height), swing=Swing(into, end, ANGLE))
                    site.swept.append((into, leaf_sweep(segment, end, inward, width)))
                    return True
    return False


def _near_corner(floor: shapely.Polygon, segment: Point, vertical: bool) -> int:
    """Return the end of the segment that lies nearer to a side wall of the room."""
    low, high = floor.bounds[vertical], floor.bounds[2 + vertical]
    return int(np.argmin([min(end - low, high - end) for end in segment[:, int(vertical)]]))


def _leaf_fits(site: Site, floor: shapely.Polygon, into: str, segment: Point, hinge: int, inward: Point, width: float, wall: float) -> bool:
    sweep = leaf_sweep(segment, hinge, inward, width)
    # the hinge stands on the wall's centre line: from there to the room's face the leaf turns inside its own reveal
    reveal = shapely.Polygon(np.vstack([segment, (segment + (wall + 1e-3) * inward)[::-1]]))
    if sweep.difference(floor).difference(reveal).area > 1e-3:
        return False
    if any(room == into and other.distance(sweep) < LEAF_GAP for room, other in site.swept):
        return False
    # no leaf may stand in another opening of the room
    return all(shapely.LineString(o.segment).distance(sweep) >= LEAF_GAP for o in site.openings if into in o.rooms)


def _windows(site: Site, room: RoomReq, walls: Sequence[Run], tries: Sequence[tuple[float, float]]) -> None:
    """Give a room its windows, the longest outside stretch first, until its floor has daylight: one per stretch, three at most.

    A wall more with a window is a wall less for a headboard, a wardrobe or a row of wall units.
    A balcony is a loggia: above its parapet it is glass from corner to corner and up to the ceiling.
    `tries` are shares of the wished width, and how far a window of it keeps from the ends of the wall [m].
    """
    wanted = room.window == "required" or (room.window == "auto" and DEFAULTS[room.type].window)
    if not wanted or room.window == "forbidden":
        return
    high = room.type in WIDEST_HIGH
    placed, glass = 0, 0.0
    enough = 0.0 if high else np.inf if room.type == "balcony" else DAYLIGHT * float(shapely.Polygon(site.rooms[room.id].polygon).area)
    for run in sorted(walls, key=lambda r: -round(r.length, 3)):
        if placed >= 3 or (placed and (glass >= enough or run.length < 1.6)):
            break
        width = min(0.55 * run.length, WIDEST.get(room.type, WIDEST_WINDOW))
        if room.type == "balcony":
            width = min(run.length - 2 * FRAME, WIDEST_GLASS)
        for share, margin in tries:
            size = round(max(width * share, NARROWEST_WINDOW), 2)
            offset = _window_place(site, run, size, margin)
            if offset is not None:
                sill, height = (HIGH_SILL, HIGH_WINDOW) if high else (SILL, site.ceiling if room.type == "balcony" else WINDOW_HEIGHT)
                sill = min(sill, site.ceiling - LINTEL - LEAST_WINDOW)
                height = site.under(sill + height) - sill
                site.put(run, "window", offset, size, round(height, 3), sill)
                placed, glass = placed + 1, glass + size * height
                break


def _window_place(site: Site, run: Run, width: float, margin: float) -> float | None:
    """Return the free place nearest to the middle of the wall, `margin` from its ends."""
    if run.length < width + 2 * margin:
        return None
    middle = (run.length - width) / 2
    for k in range(int(middle / STEP) + 1):
        for offset in (middle - k * STEP, middle + k * STEP):
            if margin <= offset <= run.length - width - margin and site.free(run, offset, width):
                return offset
    return None
