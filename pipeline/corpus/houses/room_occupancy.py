"""A room while it is furnished: its walls, what stands in it, what must stay free, and where one can walk.

Everything that stands is kept as an axis-aligned box in plan with a range of heights; oblique pieces by their bounds.
"""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from pipeline.corpus.furniture.catalogue import Model, corpus_cards
from pipeline.corpus.houses.records import Item, Rect, wrap
from pipeline.entities.plan import Opening, Room

FAR = 50.0
LOW = 1.0  # boxes that start above this height do not stand in the way on the floor [m]
EPSILON = 1e-4
STEP = 0.5  # free floor before an opening [m]; less before a wide one in a room narrower than NARROW, such as a balcony
NARROW = 1.7
LEAF_TOP = 2.12  # nothing hangs lower than this where a door leaf swings [m]
LOW_PIECE = 0.65  # what is no higher than this may stand before any window [m]
CELL = 0.1
WAY = 0.3  # half the width that people leave for the ways through their rooms [m]
FILLER = 0.035  # beside what opens, and behind a lid that falls back: a door that stands open needs it for its handle [m]
LIDS = frozenset({"trash_can"})
Solid = tuple[Rect, float, float]
"""What stands or hangs: its rectangle, from one height to another [m]."""


@dataclass(frozen=True, slots=True)
class Side:
    """A wall of the room: from (x, y) along the unit vector (tx, ty); the room lies on its left, at (nx, ny) = (-ty, tx)."""

    x: float
    y: float
    tx: float
    ty: float
    length: float

    @property
    def yaw(self) -> float:
        """Yaw of a piece with its back to this wall [rad]: its front, (sin yaw, -cos yaw), is the wall's inward normal."""
        return wrap(math.atan2(-self.ty, -self.tx))

    def strip(self, low: float, high: float, near: float, far: float) -> Rect:
        """Return the rectangle from `low` to `high` along the wall and from `near` to `far` in front of it [m]."""
        xs, ys = zip(*(self.point(s, v) for s in (low, high) for v in (near, far)), strict=True)
        return (min(xs), min(ys), max(xs), max(ys))

    def along(self, box: Rect) -> tuple[float, float]:
        """Return the interval that a rectangle covers along the wall [m]."""
        s = [(x - self.x) * self.tx + (y - self.y) * self.ty for x, y in ((box[0], box[1]), (box[2], box[3]))]
        return min(s), max(s)

    def off(self, box: Rect) -> tuple[float, float]:
        """Return the nearest and farthest distance of a rectangle from the wall's line, inwards [m]."""
        v = [-(x - self.x) * self.ty + (y - self.y) * self.tx for x, y in ((box[0], box[1]), (box[2], box[3]))]
        return min(v), max(v)

    def away(self, x: float, y: float) -> float:
        """Return the distance of a point from the wall's segment [m]."""
        s = (x - self.x) * self.tx + (y - self.y) * self.ty
        v = -(x - self.x) * self.ty + (y - self.y) * self.tx
        return math.hypot(v, max(0.0, -s, s - self.length))

    def point(self, s: float, v: float) -> tuple[float, float]:
        """Return the point `s` along and `v` in front of the wall."""
        return self.x + s * self.tx - v * self.ty, self.y + s * self.ty + v * self.tx


def box_of(x: float, y: float, yaw: float, width: float, depth: float) -> Rect:
    """Return the bounds of a turned rectangle."""
    c, s = abs(math.cos(yaw)), abs(math.sin(yaw))
    w, d = (width * c + depth * s) / 2, (width * s + depth * c) / 2
    return (x - w, y - d, x + w, y + d)


@dataclass(frozen=True, slots=True)
class Spot:
    """A place for a piece: centre [m, world] and yaw."""

    x: float
    y: float
    yaw: float

    def box(self, width: float, depth: float) -> Rect:
        """Return the bounds of a piece of that width and depth there."""
        return box_of(self.x, self.y, self.yaw, width, depth)


def meets(a: Rect, b: Rect, by: float = EPSILON) -> bool:
    """Whether two rectangles overlap by more than a hair, or than `by` [m]."""
    return a[0] < b[2] - by and b[0] < a[2] - by and a[1] < b[3] - by and b[1] < a[3] - by


def ahead(spot: Spot, depth: float, reach: float, width: float) -> Rect:
    """Return the rectangle of `width` that reaches `reach` beyond the front of a piece of that depth, square to the axes."""
    fx, fy = math.sin(spot.yaw), -math.cos(spot.yaw)
    middle = depth / 2 + reach / 2
    return box_of(spot.x + fx * middle, spot.y + fy * middle, spot.yaw, width, reach)


def shift_spot(spot: Spot, right: float, front: float, turn: float = 0.0) -> Spot:
    """Return the spot moved in its own frame (x to the right as its width runs, front forwards) and turned."""
    c, s = math.cos(spot.yaw), math.sin(spot.yaw)
    return Spot(spot.x + c * right + s * front, spot.y + s * right - c * front, wrap(spot.yaw + turn))


class Space:
    """The state of one room while it is being furnished."""

    def __init__(self, number: int, room: Room, openings: Sequence[Opening]) -> None:
        self.number = number
        self.height = room.height
        self.area = room.area
        self.bounds: Rect = (*(float(v) for v in room.polygon.min(axis=0)), *(float(v) for v in room.polygon.max(axis=0)))  # type: ignore[assignment]
        self.sides = sides_of(room)
        self.solids: list[Solid] = [(r, -FAR, FAR) for r in outside_rects([(side.x, side.y) for side in self.sides])]
        self.clearances: list[Rect] = []
        self.swept: list[Solid] = []
        self.gaps: list[tuple[Rect, float]] = []
        self.panes: list[tuple[Rect, float]] = []
        self.doors: list[tuple[float, float]] = []
        self.items: list[Item] = []
        self.blind = False
        for opening in openings:
            self._open(room.room_id, opening)

    def _open(self, room_id: str, opening: Opening) -> None:
        """Keep free what an opening needs: the leaf's sweep, a step in front of it, the light of a window."""
        side, low, high = wall_of(self.sides, opening)
        if opening.kind == "window":
            self.panes.append((side.strip(low, high, 0.0, 0.65), max(opening.sill, LOW_PIECE)))
            return
        self.gaps.append((side.strip(low - 0.08, high + 0.08, 0.0, 0.15), opening.height))
        swings_here = opening.swing is not None and opening.swing.room_id == room_id
        narrow = min(self.bounds[2] - self.bounds[0], self.bounds[3] - self.bounds[1]) < NARROW
        step = 0.35 if narrow and opening.width > 1.0 else STEP
        self.clearances.append(side.strip(low - 0.03, high + 0.03, 0.0, max((high - low) + 0.05, step) if swings_here else step))
        if swings_here:
            self.swept.append((self.clearances[-1], 0.0, LEAF_TOP))
        self.doors.append(side.point((low + high) / 2, 0.36))

    def fits(self, box: Rect, low: float, high: float, under: Rect | None = None, slender: float = 0.0) -> bool:
        """Whether a box is inside the room and clear of everything that stands or must stay free.

        `under` is the rectangle of a table that the box may reach below; its top is so `slender` [m] that it takes no light from a window.
        """
        if any(meets(box, r) and low < z1 - EPSILON and z0 < high - EPSILON and r is not under for r, z0, z1 in self.solids):
            return False
        if low < LOW and any(meets(box, r) for r in self.clearances):
            return False
        if any(meets(box, r) and low < z1 and z0 < high for r, z0, z1 in self.swept):
            return False
        if any(low < top and meets(box, r) for r, top in self.gaps):  # nothing hangs in a doorway
            return False
        return self.blind or not any(high - slender > sill + 0.05 and meets(box, r) for r, sill in self.panes)

    def clear(self, box: Rect, margin: float = 0.0) -> bool:
        """Whether nothing stands on the floor of a rectangle."""
        grown = (box[0] - margin, box[1] - margin, box[2] + margin, box[3] + margin)
        return not any(z0 < LOW and meets(grown, r) for r, z0, _ in self.solids)

    def spans(self, side: Side, depth: float, front: float, low: float, high: float) -> list[tuple[float, float]]:
        """Return the free stretches of a wall for a box of that depth with `front` metres free before it."""
        body = side.strip(EPSILON, side.length - EPSILON, EPSILON, depth)
        whole = side.strip(EPSILON, side.length - EPSILON, EPSILON, depth + front)
        blocked = [side.along(r) for r, z0, z1 in self.solids if low < z1 and z0 < high and meets(body, r)]
        if low < LOW:
            blocked += [side.along(r) for r, z0, _ in self.solids if z0 < LOW and meets(whole, r)]
            blocked += [side.along(r) for r in self.clearances if meets(body, r)]
        blocked += [side.along(r) for r, top in self.gaps if low < top and meets(body, r)]
        if not self.blind:
            blocked += [side.along(r) for r, sill in self.panes if high > sill + 0.05 and meets(body, r)]
        stretches, at = [], 0.0
        for a, b in sorted(blocked):
            if a > at:
                stretches.append((at, min(a, side.length)))
            at = max(at, b)
        if at < side.length:
            stretches.append((at, side.length))
        return stretches

    def add(self, model: Model, spot: Spot, z: float = 0.0, *, clearances: Sequence[Rect] = ()) -> Item:
        """Put a piece down and keep the given rectangles free from now on."""
        item = Item(model, self.number, (spot.x, spot.y, z), wrap(spot.yaw))
        self.items.append(item)
        self.solids.append((item.rect(), z, z + model.size[2]))
        self.clearances.extend(clearances)
        return item

    def try_add(
        self, model: Model, spot: Spot, z: float = 0.0, *, clearances: Sequence[Rect] = (), under: Rect | None = None, slender: float = 0.0
    ) -> bool:
        """Put a piece down if it fits there (see `fits`) and its free rectangles are free; a chair may reach under its table."""
        if not self.fits(spot.box(*model.size[:2]), z, z + model.size[2], under, slender) or not all(self.clear(r) for r in clearances):
            return False
        self.add(model, spot, z, clearances=clearances)
        return True

    def take_back(self) -> None:
        """Take the piece away that was put down last; what was kept free for it stays so."""
        self.items.pop()
        self.solids.pop()

    def nestle(self, model: Model, spot: Spot, *, dry: bool = False) -> bool:
        """Put down a piece that may stand where others want floor for themselves, but not before a door; `dry`: only try."""
        wanted, self.clearances = self.clearances, self.clearances[: len(self.doors)]
        fits = self.fits(spot.box(*model.size[:2]), 0.0, model.size[2])
        self.clearances = wanted
        if fits and not dry:
            self.add(model, spot)
        return fits


def filler(model: Model) -> float:
    """Return what is left free on either side of a model [m]: a model that does not open may stand for one that does."""
    return FILLER if corpus_cards()[model.category].moving else 0.0


def against(rng: np.random.Generator, space: Space, model: Model, *, front: float, corner: float = 0.5, low: float = 0.0) -> Spot | None:
    """Return a place with the back to a wall, `front` metres free before it; with chance `corner` at a stretch's end."""
    w, d, h = model.size
    gap, aside = back_gap(rng), filler(model)
    if model.category in LIDS:
        gap = max(gap, FILLER)
    candidates: list[tuple[int, float, float]] = []
    for i, side in enumerate(space.sides):
        candidates += [(i, a, b) for a, b in space.spans(side, d + gap, front, low, low + h) if b - a >= w + max(0.02, 2 * aside)]
    if not candidates:
        return None
    if corner >= 0.95:  # the room's own corners first
        candidates = [f for f in candidates if f[1] < 0.01 or f[2] > space.sides[f[0]].length - 0.01] or candidates
    i, a, b = candidates[int(rng.integers(len(candidates)))]
    slack = b - a - w
    if rng.random() < corner:
        if corner >= 0.95 and (a < 0.01) != (b > space.sides[i].length - 0.01):
            into = min(slack, aside + 0.004)
            near = a + w / 2 + into if a < 0.01 else b - w / 2 - into
            return on_side(space, i, near, d, gap)
        into = min(slack - aside, max(aside, abs(float(rng.normal(0.0, 0.02))) + 0.005))
        s = a + w / 2 + into if rng.random() < 0.5 else b - w / 2 - into
    else:
        s = a + w / 2 + aside + (slack - 2 * aside) * float(np.clip(rng.normal(0.5, 0.22), 0.0, 1.0))
    return on_side(space, i, s, d, gap)


def on_side(space: Space, side: int, s: float, depth: float, gap: float) -> Spot:
    """Return the spot of a piece of that depth, `s` along a wall, `gap` off it [m]."""
    x, y = space.sides[side].point(s, gap + depth / 2)
    return Spot(x, y, space.sides[side].yaw)


def back_gap(rng: np.random.Generator) -> float:
    """Draw how far a back stands off the wall: a centimetre or so (medians of 12 real scenes: 0.00-0.04) [m]."""
    return float(np.clip(abs(rng.normal(0.0, 0.015)) + 0.003, 0.003, 0.06))


def outside_rects(polygon: Sequence[tuple[float, float]]) -> list[Rect]:
    """Return rectangles that cover the plane around a rectilinear polygon, out to FAR metres."""
    xs = sorted({x for x, _ in polygon})
    ys = sorted({y for _, y in polygon})
    x0, x1, y0, y1 = xs[0], xs[-1], ys[0], ys[-1]
    left, right, bottom, top = x0 - FAR, x1 + FAR, y0 - FAR, y1 + FAR
    around: list[Rect] = [(left, bottom, x0, top), (x1, bottom, right, top), (left, bottom, right, y0), (left, y1, right, top)]
    for a, b in itertools.pairwise(xs):
        inside = inside_intervals(polygon, (a + b) / 2)
        edges = [y0, *(v for span in inside for v in span), y1]
        around += [(a, low, b, high) for low, high in zip(edges[::2], edges[1::2], strict=True) if high - low > EPSILON]
    return around


def inside_intervals(polygon: Sequence[tuple[float, float]], x: float) -> list[tuple[float, float]]:
    """Return the intervals of y in which the vertical line at `x` runs inside a rectilinear polygon."""
    crossings = sorted(p[1] for p, q in zip(polygon, [*polygon[1:], polygon[0]], strict=True) if min(p[0], q[0]) < x < max(p[0], q[0]))
    return list(zip(crossings[::2], crossings[1::2], strict=True))


def wall_of(sides: Sequence[Side], opening: Opening) -> tuple[Side, float, float]:
    """Return the wall that holds an opening, and the opening's stretch along it [m]."""
    (ax, ay), (bx, by) = opening.segment.tolist()
    side = min(sides, key=lambda side: side.away((ax + bx) / 2, (ay + by) / 2))
    return side, *side.along((min(ax, bx), min(ay, by), max(ax, bx), max(ay, by)))


def sides_of(room: Room) -> list[Side]:
    """Return the walls of a room as directed sides, interior on the left."""
    points = [(float(x), float(y)) for x, y in room.polygon]
    sides = []
    for p, q in zip(points, points[1:] + points[:1], strict=True):
        length = math.hypot(q[0] - p[0], q[1] - p[1])
        sides.append(Side(p[0], p[1], round((q[0] - p[0]) / length), round((q[1] - p[1]) / length), length))
    return sides


def free_floor(space: Space, items: Sequence[Item]) -> NDArray[np.bool_]:
    """Return the cells (nx, ny) of the room's bounds whose centres are on the floor and under nothing that stands there."""
    x0, y0, x1, y1 = space.bounds
    xs = np.arange(x0 + CELL / 2, x1, CELL)
    ys = np.arange(y0 + CELL / 2, y1, CELL)
    free = np.ones((len(xs), len(ys)), bool)
    walls = [r for r, low, _ in space.solids if low < -1.0]
    for box in [*walls, *(i.rect() for i in items if i.position[2] < LOW)]:
        free[_cells(xs, box[0], box[2]), _cells(ys, box[1], box[3])] = False
    return free


def _cells(centres: NDArray[np.float64], low: float, high: float) -> slice:
    return slice(int(np.searchsorted(centres, low)), int(np.searchsorted(centres, high)))


def problems(space: Space) -> tuple[int, list[int]]:
    """Return how many doors are cut off from the main floor, and which items cannot be approached within arm's length."""
    free = free_floor(space, space.items)
    distance = ndimage.distance_transform_edt(np.pad(free, 1), sampling=CELL)[1:-1, 1:-1]
    labels, count = ndimage.label(distance >= WAY - CELL / 2)
    if count == 0:
        return len(space.doors), []
    main = 1 + int(np.argmax(np.bincount(labels.ravel())[1:]))
    reach = ndimage.distance_transform_edt(labels != main, sampling=CELL)
    x0, y0 = space.bounds[:2]

    def away(a: float, b: float, c: float, d: float) -> float:
        """Return how far the nearest cell of a rectangle is [m]."""
        part = reach[max(int((a - x0) / CELL), 0) : int((c - x0) / CELL) + 1, max(int((b - y0) / CELL), 0) : int((d - y0) / CELL) + 1]
        return float(part.min()) if part.size else 0.0

    cut_off = sum(away(*door, *door) > 0.25 for door in space.doors)
    far = [k for k, i in enumerate(space.items) if i.position[2] < LOW and away(*i.rect()) > _arm(i)]
    return cut_off, far


def _arm(item: Item) -> float:
    """Return how far from the walkable floor a piece may be [m]: chairs are pulled out, and stand around tables."""
    if item.model.category == "dining_table":
        return 1.5
    return 0.9 if item.model.category.endswith(("chair", "stool")) else 0.55
