"""Fewer convex pieces by what a hand feels: neighbours become one piece while its surface stays close to theirs.

The measure is the way from the common hull's surface to the pieces as they were first, so that errors do not add up. A bowl
keeps its hollow, with fewer staves; bevels, beads and shallow frames go; a block that is closed all round becomes one piece.
"""

import heapq
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
from scipy.spatial import ConvexHull

from pipeline.arrays import Bools, Floats, Ints
from pipeline.card import Category
from pipeline.geometry.compiled import compiled
from pipeline.sources.meshes.mesh_solids import MAX_HULL, Part, combine_parts, extremes, qhull_of
from pipeline.sources.meshes.near_boxes import NEAR
from pipeline.sources.meshes.reach import make_reach_test
from pipeline.sources.meshes.rings import STAVES, is_ring, same_height, sectors
from pipeline.sources.meshes.small_parts import (
    UNDER,
    blocks_under,
    level_top,
    lie_flat,
    narrow_bars,
    without_feet,
)

Allowed = Callable[[Floats, Floats], Floats]  # points (P, 3), normals (P, 3) there -> how far each may be off (P,) [m]

ROOMY = 50.0  # boards across each other: their box holds so many times what they do, and no hull of theirs is looked at
MOST = 250  # pieces of a link beyond which it is left as it is
SAMPLES = (0, 2, 8)  # intervals along a side of the hull's triangles, coarse first; 0: their middles
SHARE = 0.15  # of the least extent of a link: what its touched surface may be off by at most, however small it is
UP = 0.7  # upward part of the normal of a face on which things lie
LEVEL = 0.95  # ... on which they lie on cushions: an edge that slopes more bears nothing
TOUCHED = 0.005  # [m] how far a collider's surface may be off where hands and things come
BUMPED = 0.02  # ... where a robot comes with its body at most: the sides of furniture that does not open
PADDED = 0.03  # ... the rounded edges of cushions and mattresses, whose boxes bear things on a level top
GIVES = 0.045  # ... what one sits and lies on
SOFT = 0.05  # ... a blanket with its fringe, what hangs on a wall
BETWEEN = 0.08  # ... from the spindles of a chair's back or a bed's end, between which nothing comes
LEFT_ALONE = 0.15  # ... from underneath, and leaves
HELD = 0.03  # ... the outside of small things that no hand goes into
ANY = 10.0  # [m]
HOLLOW, DEEP = 0.3, 0.55  # shares of a vessel's width and height that it may be off within
OUTWARD = 0.1  # of the normal of a floor within
OVER = 2.0  # [m] above the floor that furniture stands on, where nothing of a robot comes
SEAT = 0.4  # [m] above the floor below which legs are one block under a seat or a mattress: a robot stands before them
SAG = 0.05  # [m] under a bar which nothing is above, where nothing is felt: the hollow of a tap's arch
CUSHIONED = frozenset(("bed", "chair", "sofa", "stool"))  # super-categories on which one sits and lies: what things lie on there gives way
REACH = 0.05  # [m] between pieces that may become one across what lies between them: shelves on both sides of a board
POT = 0.4  # share of a plant's height up to which it is as hard as other things
Offer = tuple[float, tuple[int, ...]]  # how much changes, who becomes one


@dataclass(frozen=True, slots=True)
class TouchTolerances:
    """How far a surface may be off [m]: where things lie (faces upwards), at the sides, from below; `yielding` grows with height to LEFT_ALONE.

    What is `closed` is not reached into: the staves of a ring are one disc. Lower than `under` [m] only what faces upwards is felt, higher than `over` nothing.
    A `vessel` is felt from without; within it is but hollow. What is `soft` lies flat. What nobody touches is one piece, `whole`.
    Things lie on what faces upwards by `level`; what is less than `lift` [m] below the top of a piece is drawn up to it. Boxes may stand out by `box` [m] at their corners.
    Nothing comes through gaps narrower than `cell` [m]; see `make_reach_test`. Less than `sag` [m] under a bar nothing is felt.
    """

    up: float = TOUCHED
    sides: float = TOUCHED
    down: float = TOUCHED
    yielding: bool = False
    closed: bool = False
    under: float = 0.0
    over: float = ANY
    vessel: bool = False
    soft: bool = False
    whole: bool = False
    level: float = UP
    lift: float = 0.0
    box: float = NEAR
    cell: float = 0.01
    sag: float = 0.0


FELT = MappingProxyType(  # by what cards say
    {
        "seen": TouchTolerances(LEFT_ALONE, LEFT_ALONE, LEFT_ALONE, whole=True),
        "block": TouchTolerances(LEFT_ALONE, LEFT_ALONE, LEFT_ALONE, whole=True),
        "soft": TouchTolerances(SOFT, SOFT, SOFT, soft=True),
        "yielding": TouchTolerances(LEFT_ALONE, TOUCHED, LEFT_ALONE, yielding=True, closed=True),
        "closed": TouchTolerances(BUMPED, closed=True),
        "handled": TouchTolerances(BUMPED, closed=True),
    }
)
OFF = MappingProxyType({"closed": HELD, "handled": BUMPED})  # of small things


def touch_tolerances(category: Category, *, opens: bool) -> TouchTolerances:
    """Return how truly a thing of a category is felt: hands come to what is small and to what opens, bodies to other furniture."""
    if category.felt:
        felt = FELT[category.felt]
        if category.loose and category.felt in OFF:
            return replace(felt, sides=OFF[category.felt], down=OFF[category.felt])
        return replace(felt, sides=SOFT, down=LEFT_ALONE) if category.felt == "closed" and category.mount == "wall" else felt
    if category.loose:
        return TouchTolerances(vessel=True)
    if opens:
        return TouchTolerances()
    if category.super in CUSHIONED:  # under a sofa's arm the drawer of a side table comes out
        under = SEAT if category.tuck == "seat" or category.super == "bed" else UNDER
        return TouchTolerances(GIVES, BETWEEN, LEFT_ALONE, under=under, box=PADDED, cell=BUMPED, level=LEVEL, lift=PADDED)
    over = OVER if category.mount == "floor" else ANY
    return TouchTolerances(TOUCHED, BUMPED, LEFT_ALONE, under=UNDER, over=over, box=PADDED, cell=BUMPED)


def simplify_pieces(pieces: Sequence[Part], how: TouchTolerances) -> tuple[Part, ...]:
    """Return convex pieces [m] as few as they can be felt for the same by."""
    if not pieces:
        return ()
    if how.whole:
        return (combine_parts(pieces),)
    points = np.concatenate([p.hull for p in pieces])
    low = float(points[:, 2].min())
    pieces = blocks_under(pieces, low + how.under)
    if how.soft:
        pieces = [lie_flat(combine_parts(pieces))]
    if how.closed:  # the staves of each ring, all of them between the same heights, are one
        levels = [[pieces[k] for k in level] for level in same_height(pieces)]
        pieces = [disc for level in levels for disc in (level if len(level) < STAVES else [combine_parts(level)])]
    if how.sides <= TOUCHED:
        pieces = without_feet(pieces)
    allowed = _tolerance(pieces, how)
    fewer_pieces = drop_unfelt(merge_by_touch(pieces, allowed, max(how.up, how.sides, REACH), rings=how.up < SOFT, sag=how.sag), allowed)
    return tuple(level_top(p, how.lift) for p in fewer_pieces) if how.lift else fewer_pieces


def drop_unfelt(pieces: Sequence[Part], allowed: Allowed) -> tuple[Part, ...]:
    """Return the pieces without those that the others feel the same without: a basin's bottom close above its worktop.

    Less is allowed than for a hull, which bears something: what is deep in a vessel is its floor.
    """

    def least(at: Floats, normals: Floats) -> Floats:
        tolerance = allowed(at, normals)
        return np.where(tolerance < ANY, np.minimum(tolerance, BUMPED), ANY)

    planes = [_planes(p.hull) for p in pieces]
    kept = set(range(len(pieces)))
    for k in sorted(kept, key=lambda k: (round(pieces[k].hull_volume, 9), k)):
        others = [planes[i] for i in sorted(kept - {k})]
        if others and _deviation(pieces[k].hull, others, least) is not None:
            kept.discard(k)
    return tuple(pieces[k] for k in sorted(kept))


def _tolerance(pieces: Sequence[Part], how: TouchTolerances) -> Allowed:
    points = np.concatenate([p.hull for p in pieces])
    low, high = points.min(axis=0), points.max(axis=0)
    least = SHARE * float((high - low).min())
    hulls = [p.hull for p in pieces]
    comes = make_reach_test(hulls, [_planes(h) for h in hulls], how.cell) if how.up < SOFT else None
    hollows = _hollows(pieces, how)

    def tolerance_at(at: Floats, normals: Floats) -> Floats:
        tolerance = np.where(normals[:, 2] > how.level, how.up, np.where(normals[:, 2] < -UP, how.down, how.sides))
        if how.yielding:
            share = np.clip((at[:, 2] - low[2]) / (POT * (high[2] - low[2])), 0, 1)
            tolerance = np.maximum(tolerance, share * LEFT_ALONE)
        for hollow in hollows:
            tolerance = np.where(hollow.within(at, normals), np.maximum(tolerance, hollow.depth), tolerance)
        tolerance = np.where(tolerance <= TOUCHED, np.minimum(tolerance, least), tolerance)
        away = (at[:, 2] < low[2] + how.under) & (normals[:, 2] <= how.level) | (at[:, 2] > low[2] + how.over)
        return np.asarray(np.where(away if comes is None else away | ~comes(at), ANY, tolerance))

    return tolerance_at


@dataclass(frozen=True, slots=True)
class _Hollow:
    """The inside of a vessel: its middle (2,), the heights and the radius [m] that it is between, by how much its wall may be off."""

    middle: Floats
    heights: tuple[float, float]
    radius: float
    depth: float

    def within(self, at: Floats, normals: Floats) -> Bools:
        """Return (P,) whether points (P, 3) of faces with normals (P, 3) are of its inside."""
        away = at[:, :2] - self.middle
        inside = (np.linalg.norm(away, axis=1) < self.radius) & (at[:, 2] >= self.heights[0]) & (at[:, 2] <= self.heights[1])
        leans = (away * normals[:, :2]).sum(axis=1)  # outwards: a lid's knob is no inside, though its top looks up
        inwards = (normals[:, 2] > UP) & (leans <= OUTWARD * np.linalg.norm(away, axis=1)) | (leans < 0) & (normals[:, 2] > -UP)
        return np.asarray(inside & inwards)


def _hollows(pieces: Sequence[Part], how: TouchTolerances) -> list[_Hollow]:
    """Return the inside of a vessel, and those of the rings in other things: basins, drums."""
    rings = [list(pieces)] if how.vessel else [[pieces[k] for k in ring] for ring in same_height(pieces) if is_ring(pieces, ring)]
    hollows = []
    for ring in rings:
        points = np.concatenate([p.hull for p in ring])
        low, high = points.min(axis=0), points.max(axis=0)
        if how.vessel:
            stand = np.concatenate([p.hull for p in ring if p.hull[:, 2].min() < low[2] + TOUCHED])
            middle = (stand.min(axis=0) + stand.max(axis=0))[:2] / 2
        else:
            middle = (low + high)[:2] / 2
        depth = min(HOLLOW * float((high - low)[:2].min()), DEEP * float(high[2] - low[2]))
        hollows.append(
            _Hollow(middle, (low[2] - TOUCHED, high[2] + TOUCHED), np.inf if how.vessel else float(np.ptp(points[:, 0])) / 2, depth)
        )
    return hollows


def merge_by_touch(
    pieces: Sequence[Part], allowed: Allowed, apart: float = TOUCHED, *, rings: bool = True, sag: float = 0.0
) -> tuple[Part, ...]:
    """Return convex pieces [m] merged as long as no surface point goes further from where it was than is `allowed` there.

    All at once where that may be, else the staves of `rings` in sectors, then pairs, those that change least first. Pieces whose boxes are
    more than `apart` [m] from each other are no pair. What is less than `sag` [m] under a bar is as good as in it.
    """
    if not 2 <= len(pieces) <= MOST:
        return tuple(pieces)
    boxes = np.array([[p.hull.min(axis=0), p.hull.max(axis=0)] for p in pieces])
    hanging = narrow_bars(boxes) if sag else np.zeros(len(pieces), bool)
    planes = [
        _planes(np.concatenate([p.hull, p.hull - [0.0, 0.0, sag]]) if bar else p.hull) for p, bar in zip(pieces, hanging, strict=True)
    ]

    def share(group: Sequence[int], points: Floats) -> float | None:
        low, high = points.min(axis=0), points.max(axis=0)
        beside = ((boxes[:, 0] <= high + apart) & (boxes[:, 1] >= low - apart)).all(axis=1)  # what lies at those is not felt
        others = np.flatnonzero(beside).tolist()
        near = [planes[k] for k in (*group, *(k for k in others if k not in group))]
        return _deviation(points, near, allowed)

    def passes(group: Sequence[int]) -> bool:
        return share(group, np.concatenate([pieces[k].hull for k in group])) is not None

    if passes(range(len(pieces))):
        return (combine_parts(pieces),)
    groups = _merge_groups(pieces, sectors(pieces, passes) if rings else [], share, apart)
    return tuple(pieces[g[0]] if len(g) == 1 else combine_parts([pieces[k] for k in g]) for g in groups)


def _merge_groups(
    pieces: Sequence[Part], rings: Sequence[list[int]], share: Callable[[Sequence[int], Floats], float | None], apart: float
) -> list[list[int]]:
    """Return groups of pieces by index, merged from the `rings` and the single others; see `merge_by_touch`."""
    groups = [*rings, *([k] for k in range(len(pieces)) if not any(k in ring for ring in rings))]
    hulls, volumes = (list(v) for v in zip(*(_outer(np.concatenate([pieces[k].hull for k in group])) for group in groups), strict=True))
    boxes = [np.array([h.min(axis=0), h.max(axis=0)]) for h in hulls]
    alive = [True] * len(groups)
    looked: dict[tuple[int, ...], float | None] = {}

    def worst_of(members: tuple[int, ...]) -> float | None:
        if members not in looked:
            looked[members] = share([k for g in members for k in groups[g]], np.concatenate([hulls[g] for g in members]))
        return looked[members]

    def offer(i: int, j: int) -> Offer | None:
        if (boxes[i][0] > boxes[j][1] + apart).any() or (boxes[j][0] > boxes[i][1] + apart).any():
            return None
        low, high = np.minimum(boxes[i][0], boxes[j][0]), np.maximum(boxes[i][1], boxes[j][1])
        pair = (i, j)
        if (worst := None if _roomy(low, high, volumes[i] + volumes[j], apart) else worst_of(pair)) is not None:
            return round(worst, 5), pair
        all_boxes = np.array(boxes)  # a frame is no pair, but it is with what it holds
        within = (all_boxes[:, 0] >= low - TOUCHED).all(axis=1) & (all_boxes[:, 1] <= high + TOUCHED).all(axis=1) & np.array(alive)
        inside = tuple(np.flatnonzero(within).tolist())
        if len(inside) == len(pair) or _roomy(low, high, sum(volumes[g] for g in inside), apart) or (worst := worst_of(inside)) is None:
            return None
        return round(worst, 5), inside

    heap = [candidate for i in range(len(groups)) for j in range(i + 1, len(groups)) if (candidate := offer(i, j))]
    heapq.heapify(heap)
    while heap:
        _, members = heapq.heappop(heap)
        if not all(alive[g] for g in members):
            continue
        outer, volume = _outer(np.concatenate([hulls[g] for g in members]))
        for g in members:
            alive[g] = False
        groups.append([k for g in members for k in groups[g]])
        hulls.append(outer)
        volumes.append(volume)
        boxes.append(np.array([outer.min(axis=0), outer.max(axis=0)]))
        alive.append(True)
        new = len(groups) - 1
        for k in range(new):
            if alive[k] and (candidate := offer(k, new)):
                heapq.heappush(heap, candidate)
    return [g for g, lives in zip(groups, alive, strict=True) if lives]


def _roomy(low: Floats, high: Floats, volume: float, apart: float) -> bool:
    """Whether a box holds so little that no hull is looked at; what nobody touches may be as roomy as it likes."""
    return apart < LEFT_ALONE and float((high - low).prod()) > ROOMY * volume


def _outer(points: Floats) -> tuple[Floats, float]:
    """Return the corners (N, 3) of a hull and its volume."""
    hull = ConvexHull(points)
    return points[hull.vertices], float(hull.volume)


def _planes(points: Floats) -> Floats:
    """Return the planes (F, 4) of a hull."""
    return np.unique(ConvexHull(points).equations.round(9), axis=0)


def _deviation(points: Floats, planes: Sequence[Floats], allowed: Allowed) -> float | None:
    """Return how far the hull of points (N, 3) is from pieces (their planes), as a share of what is allowed; None beyond that."""
    hull = qhull_of(points)
    if hull is None:
        return None
    if len(hull.vertices) > MAX_HULL:
        kept = ConvexHull(extremes(points[hull.vertices]))
        left = points[hull.vertices]
        off = np.minimum(*(allowed(left, np.tile(way, (len(left), 1))) for way in ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0))))
        if _away(left, [kept.equations], np.clip(off, TOUCHED, BUMPED)) > 1.0:
            return None
        hull = kept
    worst = 0.0
    for count in SAMPLES:
        at, normals = sample_hull(hull, count)
        worst = _away(at, planes, allowed(at, normals))
        if worst > 1.0:
            return None
    return worst


def sample_hull(hull: ConvexHull, count: int) -> tuple[Floats, Floats]:
    """Return points (P, 3) spread over the triangles of a hull, `count` intervals along a side, 0: their middles; and the normals there."""
    corners, normals = hull.points[hull.simplices], hull.equations[:, :3]
    if not count:
        return corners.mean(axis=1), normals
    u, v = (k.ravel() for k in np.meshgrid(np.arange(count + 1), np.arange(count + 1), indexing="ij"))
    inside = u + v <= count
    weights = np.stack([u, v, count - u - v], axis=1)[inside] / count
    return np.einsum("pk,fkd->fpd", weights, corners).reshape(-1, 3), np.repeat(normals, len(weights), axis=0)


def _away(points: Floats, planes: Sequence[Floats], tolerance: Floats) -> float:
    """Return the worst of the ways of points (P, 3) to the nearest piece, by the planes of its faces, in tolerances (P,)."""
    start = np.cumsum([0, *map(len, planes)])
    return float(_worst(np.ascontiguousarray(points), np.ascontiguousarray(tolerance, np.float64), np.concatenate(planes), start))


@compiled
def _worst(points: Floats, tolerance: Floats, planes: Floats, start: Ints) -> float:
    """See `_away`: the planes (N, 4) of piece k are from start[k] on. A quarter is not looked at closely, nor what comes after a point beyond 1."""
    worst = 0.0
    for i in range(len(points)):
        x, y, z = points[i]
        best = np.inf
        for k in range(len(start) - 1):
            out = -np.inf
            for j in range(start[k], start[k + 1]):
                out = max(out, planes[j, 0] * x + planes[j, 1] * y + planes[j, 2] * z + planes[j, 3])
                if out >= best:
                    break
            best = min(best, out)
            if best <= tolerance[i] / 4:
                break
        worst = max(worst, best / tolerance[i])
        if worst > 1.0:
            break
    return worst
