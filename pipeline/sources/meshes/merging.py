"""Fewer convex pieces: neighbours whose common hull holds next to nothing but themselves become one piece.

Two rules, both blind to what the pieces are. A pair is merged where the common hull adds almost no volume: boards in
line, a bevelled edge and its panel. A slab, pieces between the same two planes such as the frame and the filling of a
door, is merged where its hull has but shallow pockets, into which no finger goes. What is hollow stays hollow.
"""

import heapq
from collections.abc import Sequence

import numpy as np
from scipy.spatial import ConvexHull

from pipeline.arrays import Bools, Floats, Ints
from pipeline.sources.meshes.mesh_solids import MAX_HULL, Part, combine_parts, normals, qhull_of

GAIN = 0.02  # share of a merged piece that may be filled without having been matter
NEAR = 1e-3  # share of the link's diagonal within which boxes count as touching
POCKET = 0.008  # the same for the depth of a slab's pockets: 8 mm of a door of 1 m
SLAB = 0.06  # the same for the thickness of a slab
MOST = 1500  # pieces; beyond that a link is left as it is, for pairs grow with the square
HULLS = 9000  # that are tried at first, about: where hundreds of pieces touch each other, each is offered to the likeliest few
ALL = 40  # pieces of a slab up to which what lies between any two is looked at
SAMPLES = (8, 40)  # a side, of the grids on which a slab's pockets are looked for


def merge_pieces(pieces: Sequence[Part]) -> tuple[Part, ...]:
    """Return the pieces with neighbours merged: pairs, cheapest first, until each further one would fill more than GAIN; then slabs."""
    if not 2 <= len(pieces) <= MOST:
        return tuple(pieces)
    state = _State(list(pieces))
    _pairs(state)
    for axis in range(3):
        _slabs(state, axis)
    return tuple(state.pieces[k] for k in state.living())


class _State:
    """Pieces under way.

    `matter` is what each holds for certain, kept through all merges (a lower bound of the volume of the union of its
    originals: their sum less the common volume of their boxes), so that many small fillings cannot add up to a cavity.
    `boxes` (P, 2, 3) are the boxes; `planes` per piece normals (F, 3), twice the faces' area long, and offsets (F,).
    """

    def __init__(self, pieces: list[Part]) -> None:
        self.pieces = pieces
        self.alive = [True] * len(pieces)
        self.matter = [p.hull_volume for p in pieces]
        self.planes = [_planes(p) for p in pieces]
        self.boxes: Floats = np.array([[p.hull.min(axis=0), p.hull.max(axis=0)] for p in pieces])
        self.few = max(4, HULLS // len(pieces))
        self.span = float(np.linalg.norm(self.boxes[:, 1].max(axis=0) - self.boxes[:, 0].min(axis=0)))

    def living(self) -> list[int]:
        """Return the indices of the pieces that have not become part of another."""
        return [k for k, alive in enumerate(self.alive) if alive]

    def touching(self, low: Floats, high: Floats) -> Bools:
        """Return (P,) whether the pieces' boxes touch the box from `low` to `high`."""
        near = NEAR * self.span
        return np.asarray(((self.boxes[:, 0] <= high + near) & (self.boxes[:, 1] >= low - near)).all(axis=1))

    def union(self, members: Sequence[int]) -> float:
        """Return a lower bound of the volume of the union of pieces."""
        volume = self.matter[members[0]]
        box = self.boxes[members[0]]
        for k in members[1:]:
            common = np.maximum(np.minimum(box[1], self.boxes[k, 1]) - np.maximum(box[0], self.boxes[k, 0]), 0.0)
            volume = max(volume, self.matter[k], volume + self.matter[k] - float(common.prod()))
            box = np.array([np.minimum(box[0], self.boxes[k, 0]), np.maximum(box[1], self.boxes[k, 1])])
        return volume

    def offers(self, i: int, others: Sequence[int]) -> list[tuple[float, int, int]]:
        """Return the offers of piece i to pieces that touch it: bounds for all at once, hulls for the likeliest few that pass."""
        if not others:
            return []
        js = np.asarray(others)
        common = np.minimum(self.boxes[i, 1], self.boxes[js, 1]) - np.maximum(self.boxes[i, 0], self.boxes[js, 0])
        matter = np.array([self.matter[j] for j in others])
        least = np.maximum(np.maximum(matter, self.matter[i]), matter + self.matter[i] - np.maximum(common, 0.0).prod(axis=1))
        hulls = [self.pieces[j].hull for j in others]
        starts = np.cumsum([0, *(len(h) for h in hulls[:-1])])
        ways, offsets = self.planes[i]
        above = np.maximum(np.concatenate(hulls) @ ways.T - offsets, 0.0).sum(axis=1) / 6
        grown = self.pieces[i].hull_volume + np.maximum.reduceat(above, starts)
        passed = np.flatnonzero((least > 0) & (grown <= least / (1 - GAIN) * (1 + 1e-9)))
        likely = passed[np.argsort((grown[passed] / least[passed]).round(9), kind="stable")[: self.few]]
        return [entry for j in np.sort(js[likely]).tolist() if (entry := self.offer(min(i, j), max(i, j)))]

    def offer(self, i: int, j: int) -> tuple[float, int, int] | None:
        """Return (share that the common hull fills, i, j), or None where it is more than GAIN."""
        least = self.union((i, j))
        most = least / (1 - GAIN)
        if least <= 0 or self._grown_volume(i, j) > most or self._grown_volume(j, i) > most:
            return None
        hull = _hull([self.pieces[i], self.pieces[j]])
        if hull is None or hull.volume > most:
            return None
        return 1 - least / float(hull.volume), i, j

    def merge(self, members: Sequence[int], volume: float) -> int:
        """Replace pieces by one that holds `volume` for certain; return its index."""
        part = combine_parts([self.pieces[k] for k in members])
        self.pieces.append(part)
        self.matter.append(volume)
        self.planes.append(_planes(part))
        pair = self.boxes[list(members)]
        self.boxes = np.concatenate([self.boxes, [[pair[:, 0].min(axis=0), pair[:, 1].max(axis=0)]]])
        for k in members:
            self.alive[k] = False
        self.alive.append(True)
        return len(self.pieces) - 1

    def _grown_volume(self, i: int, j: int) -> float:
        """Return the volume of the hull of piece i and the point of piece j that adds most: a bound that needs no hull.

        A point adds a pyramid over each face that it sees.
        """
        ways, offsets = self.planes[i]
        above = ways @ self.pieces[j].hull.T - offsets[:, None]
        return self.pieces[i].hull_volume + float(np.maximum(above, 0.0).sum(axis=0).max()) / 6


def _pairs(state: _State) -> None:
    near = NEAR * state.span
    boxes = state.boxes
    touching = (boxes[:, None, 0] <= boxes[None, :, 1] + near).all(axis=2)
    first, second = np.nonzero(np.triu(touching & touching.T, 1))
    neighbours = np.split(second, np.searchsorted(first, np.arange(1, len(boxes))))
    heap = [entry for i, js in enumerate(neighbours) for entry in state.offers(i, js.tolist())]
    heapq.heapify(heap)
    while heap:
        _, i, j = heapq.heappop(heap)
        if not (state.alive[i] and state.alive[j]):
            continue
        new = state.merge((i, j), state.union((i, j)))
        near_it = np.flatnonzero(state.touching(*state.boxes[new])[:new] & np.array(state.alive)[:new])
        for entry in state.offers(new, near_it.tolist()):
            heapq.heappush(heap, entry)


def _slabs(state: _State, axis: int) -> None:
    """Merge the connected pieces that lie between the planes of a thin one of them, across `axis`, where pockets are shallow."""
    pocket = POCKET * state.span
    extent = np.ptp(state.boxes, axis=1)
    thin = (extent[:, axis] <= SLAB * state.span) & (extent[:, axis] <= extent.min(axis=1))
    tried: set[tuple[int, ...]] = set()
    for seed in sorted((k for k in state.living() if thin[k]), key=lambda k: -extent[k, axis]):
        low, high = state.boxes[seed, :, axis]
        inside = np.array(state.alive) & (state.boxes[:, 0, axis] >= low - pocket) & (state.boxes[:, 1, axis] <= high + pocket)
        members = _connected_pieces(state, inside, seed)
        if len(members) < 2 or members in tried or not state.alive[seed]:
            continue
        tried.add(members)
        if _shallow(state, members, axis, pocket):
            state.merge(members, state.union(members))


def _connected_pieces(state: _State, among: Bools, seed: int) -> tuple[int, ...]:
    """Return the pieces that hang together with `seed` through pieces of the mask `among` (P,), itself included."""
    component, queue = {seed}, [seed]
    while queue:
        for k in np.flatnonzero(among & state.touching(*state.boxes[queue.pop()])).tolist():
            if k not in component:
                component.add(k)
                queue.append(k)
    return tuple(sorted(component))


def _shallow(state: _State, members: Sequence[int], axis: int, pocket: float) -> bool:
    """Whether no point in the pieces' common hull is further than `pocket` from them, seen on a grid, coarse then fine."""
    centres = np.array([state.pieces[k].centre for k in members])
    first, second = _between(centres)
    if _away(state, members, (centres[first] + centres[second]) / 2) > pocket:  # what lies between two of them is in the hull
        return False
    hull = _hull([state.pieces[k] for k in members])
    if hull is None:
        return False
    low, high = hull.points.min(axis=0), hull.points.max(axis=0)
    face = float(np.delete(high - low, axis).prod())
    if hull.volume - sum(state.pieces[k].hull_volume for k in members) > 2 * pocket * face:
        return False
    for samples in SAMPLES:
        steps = (np.arange(samples) + 0.5) / samples
        grid = np.stack(np.meshgrid(*((0.02, 0.5, 0.98) if k == axis else steps for k in range(3)), indexing="ij"), axis=-1).reshape(-1, 3)
        points = low + grid * (high - low)
        points = points[(points @ hull.equations[:, :3].T + hull.equations[:, 3] <= 0).all(axis=1)]
        if len(points) and _away(state, members, points) > pocket:
            return False
    return True


def _between(centres: Floats) -> tuple[Ints, Ints]:
    """Return pairs of pieces: all of a few, of many each with the next along every axis, lest they grow with the square."""
    if len(centres) <= ALL:
        first, second = np.triu_indices(len(centres), 1)
        return first, second
    order = [np.argsort(centres[:, axis], kind="stable") for axis in range(3)]
    return np.concatenate([o[:-1] for o in order]), np.concatenate([o[1:] for o in order])


def _away(state: _State, members: Sequence[int], points: Floats) -> float:
    """Return how far the worst of points (N, 3) is from the nearest piece, by the planes of its faces."""
    away = np.full(len(points), np.inf)
    for k in members:
        ways, offsets = state.planes[k]
        lengths = np.maximum(np.sqrt((ways**2).sum(axis=1)), 1e-15)
        np.minimum(away, ((ways @ points.T - offsets[:, None]) / lengths[:, None]).max(axis=0), out=away)
    return float(away.max())


def _planes(part: Part) -> tuple[Floats, Floats]:
    ways = normals(part.hull, part.faces)
    return ways, (ways * part.hull[part.faces[:, 0]]).sum(axis=1)


def _hull(pieces: Sequence[Part]) -> ConvexHull | None:
    hull = qhull_of(np.concatenate([p.hull for p in pieces]))
    return hull if hull is not None and len(hull.vertices) <= MAX_HULL else None
