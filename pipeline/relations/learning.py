"""Relations from furnished rooms: every ordered pair of categories that often share a room, and every category's walls."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from pipeline import taxonomy
from pipeline.arrays import Floats
from pipeline.relations.arrangement import Arrangement
from pipeline.relations.frames import ALONG, NORMAL, OVER, SIDES, Boxes, Frames, offset_along, relate, wrap_angle
from pipeline.relations.model import METRES, RADIANS, Mode, PairRelation, Relations, Span, WallRelation, in_any_mode, relations
from pipeline.relations.walls import AROUND, measure

Indices = NDArray[np.intp]

LEAST_CASES = 30  # members that must share a room with an anchor; things of a category that must stand at walls
MOST_CASES = 3000  # members that are looked at, spread over the rooms: more say no more
LEAST_MODE = 0.03  # share of the members, and
LEAST_IN_MODE = 8  # number of them that make a mode
LEAST_STRENGTH = 0.3  # relations weaker than this are not kept
ALIKE = ("bed", "chair", "sofa")  # super-categories whose members stand to other things as each other do; tables and cabinets do not
WALK = (0.3, 0.8)  # a gap that nearly all things of two kinds keep says nothing when it is narrower, and no more when it is wider [m]
LEAST_SHARE = 0.1  # of the things of a category that must stand at a wall alike
FAR = 0.6  # a wall farther off than this is no neighbour [m]
TAILS = (5.0, 50.0, 95.0)  # percentiles of a span
DIGITS = 4  # of what is learnt
STRAYS, STRAY = 3.0, 0.5  # who is farther off than most by so many times the quartiles' distance, and by no less than this, is a stray [m]


WIDTH = 0.05  # narrowest kernel
FINE = 5  # grid points to a kernel's width
VALLEY = 0.6  # a valley is no deeper split than this share of the lower of its two peaks
RANGE = 8.0  # values farther out than this are counted at the end of the grid


@dataclass(frozen=True, slots=True)
class _Things:
    """All things of all rooms: box, class (T,), the rooms' middles (T, 2); how many are in each room."""

    boxes: Boxes
    kind: Indices
    middle: Floats
    counts: Indices
    names: tuple[str, ...]


def alike() -> dict[str, str]:
    """Return the kind of each category whose relations may be learnt from others of its kind."""
    return {name: entry.super for name, entry in taxonomy.load().categories.items() if entry.super in ALIKE}


def fit(rooms: Sequence[Arrangement], kinds: Mapping[str, str] | None = None) -> Relations:
    """Learn the relations of furnished rooms.

    `kinds` names the kind of a category, see `alike`, which is what stands for None: a pair that shares too few rooms to be learnt by itself takes what its
    anchor has with all members of the kind, else what all anchors of the kind have with the member, as far as its own few are so.
    """
    things, kinds = _collect_things(rooms), alike() if kinds is None else kinds
    anchor, member = _together(things)
    learnt = {pair: _relation(things, *case) for pair, case in _cases(anchor, member, things.kind, things.kind)}
    if kinds:
        group = np.unique([kinds.get(name, name) for name in things.names], return_inverse=True)[1]
        rare = {(a, m) for a, m in zip(things.kind[anchor].tolist(), things.kind[member].tolist(), strict=True)} - learnt.keys()
        for anchors, members in ((np.arange(len(group)), group), (group, np.arange(len(group)))):
            for pair, case in _cases(anchor, member, anchors[things.kind], members[things.kind]):
                own = sorted((a, m) for a, m in rare if (anchors[a], members[m]) == pair and not learnt.get((a, m)))
                kind = _relation(things, *case) if own else None
                learnt |= {(a, m): kind and _held_by(kind, things, *case, (a, m)) for a, m in own}
    names = things.names
    kept = [r._replace(anchor=names[a], member=names[m]) for (a, m), r in learnt.items() if r is not None and r.strength >= LEAST_STRENGTH]
    return relations(kept, _wall_relations(rooms, kinds), _distances(things, anchor, member))


def _distances(things: _Things, anchor: Indices, member: Indices) -> dict[tuple[str, str], float]:
    """Return how far things that stand on the floor keep from each other, where that is far enough to walk between them."""
    known = taxonomy.load().categories
    floor = np.array([name in known and known[name].mount == "floor" for name in things.names], np.bool_)
    there = floor[things.kind[anchor]] & floor[things.kind[member]]
    distances: dict[tuple[str, str], float] = {}
    for (a, m), case in _cases(anchor[there], member[there], things.kind, things.kind):
        if a != m:
            pair = things.names[min(a, m)], things.names[max(a, m)]
            kept = round(float(np.percentile(_nearest(things, *case, (1, 1)).apart(), TAILS[0])), 3)
            distances[pair] = min(kept, distances.get(pair, kept))
    return {pair: min(distance, WALK[1]) for pair, distance in distances.items() if distance >= WALK[0]}


def _collect_things(rooms: Sequence[Arrangement]) -> _Things:
    names = tuple(sorted({name for room in rooms for name in room.categories}))
    code = {name: k for k, name in enumerate(names)}
    filled = [room for room in rooms if room.categories]
    counts = [len(room.categories) for room in filled]
    middles = [(room.polygon.min(0) + room.polygon.max(0)) / 2 for room in filled]
    parts = [np.concatenate([getattr(room, name) for room in filled] or [np.zeros(0)]) for name in ("position", "yaw", "size")]
    kind = np.array([code[name] for room in filled for name in room.categories], np.intp)
    middle = np.repeat(np.reshape(middles, (-1, 2)), counts, axis=0)
    return _Things(Boxes(*parts), kind, middle, np.array(counts, np.intp), names)


def _together(things: _Things) -> tuple[Indices, Indices]:
    """Return anchors and members (P,): every ordered pair of things that share a room."""
    first = np.cumsum(things.counts) - things.counts
    pairs = [start + np.argwhere(~np.eye(count, dtype=bool)) for start, count in zip(first, things.counts, strict=True)]
    member, anchor = np.concatenate([*pairs, np.zeros((0, 2), np.intp)]).T
    return anchor, member


def _cases(
    anchor: Indices, member: Indices, anchors: Indices, members: Indices
) -> Iterator[tuple[tuple[int, int], tuple[Indices, Indices]]]:
    """Yield each ordered pair of classes with enough cases, and the indices of its anchors and members (P,), in a fixed order.

    `anchors` and `members` (T,) are the classes of things as anchors and as members.
    """
    code = anchors[anchor] * (members.max(initial=0) + 1) + members[member]
    order = np.argsort(code, kind="stable")
    bounds = np.flatnonzero(np.diff(code[order], prepend=-1))
    for chosen in np.split(order, bounds[1:]):
        own = np.unique(member[chosen])
        if len(own) >= LEAST_CASES:
            looked = own[np.linspace(0, len(own) - 1, min(len(own), MOST_CASES)).astype(int)]
            kept = chosen[np.isin(member[chosen], looked)]
            pair = int(anchors[anchor[kept[0]]]), int(members[member[kept[0]]])
            yield pair, (anchor[kept], member[kept])


def _relation(things: _Things, anchor: Indices, member: Indices) -> PairRelation | None:
    """Return how these members stand to these anchors, without names; None where they stand anyhow."""
    own = _nearest(things, anchor, member, (1, 1))
    modes = _modes(own)
    if not modes:
        return None
    chances = [in_any_mode(modes, _nearest(things, anchor, member, mirror)).mean() for mirror in ((-1, 1), (1, -1), (-1, -1))]
    share, chance = _rounded((in_any_mode(modes, own).mean(), np.mean(chances)))
    return PairRelation("", "", len(own.turn), share, chance, modes)


def _held_by(relation: PairRelation, things: _Things, anchor: Indices, member: Indices, pair: tuple[int, int]) -> PairRelation:
    """Return a kind's relation without the modes in which none of the members of this pair of classes stands, where they are enough to tell: no sofa sits beside its screen, as armchairs do."""
    those = (things.kind[anchor] == pair[0]) & (things.kind[member] == pair[1])
    own = _nearest(things, anchor[those], member[those], (1, 1))
    modes = tuple(mode for mode in relation.modes if in_any_mode((mode,), own).any())
    return relation._replace(modes=modes) if modes and len(own.turn) >= LEAST_IN_MODE else relation


def _nearest(things: _Things, anchor: Indices, member: Indices, mirror: tuple[int, int]) -> Frames:
    """Return each member in the frame of the anchor that is nearest; the members mirrored about the middle of their rooms."""
    frames = relate(things.boxes[anchor], _mirror_boxes(things, member, mirror))
    order = np.lexsort((frames.distance(), member))
    return frames[order[np.flatnonzero(np.diff(member[order], prepend=-1))]]


def _mirror_boxes(things: _Things, member: Indices, mirror: tuple[int, int]) -> Boxes:
    """Mirror things: a mirror image of a thing about a line of its own is itself, so its yaw is that of its front's image."""
    boxes, middle = things.boxes[member], things.middle[member]
    position = boxes.position.copy()
    position[:, :2] = middle + np.array(mirror) * (position[:, :2] - middle)
    yaw = np.arctan2(mirror[0] * np.sin(boxes.yaw), mirror[1] * np.cos(boxes.yaw))
    return Boxes(position, yaw, boxes.size)


def _modes(frames: Frames) -> tuple[Mode, ...]:
    """Return the modes of members in their anchors' frames, likeliest first."""
    count = len(frames.turn)
    least = max(LEAST_IN_MODE, int(np.ceil(LEAST_MODE * count)))
    sides, quarters = frames.sides(), np.mod(np.rint(frames.turn / (np.pi / 2)).astype(int), 4)
    modes = []
    for side in range(len(SIDES)):
        for quarter in range(4):
            group = np.flatnonzero((sides == side) & (quarters == quarter))
            if len(group) >= least:
                modes += [_mode(frames[leaf], side, count) for leaf in _leaves(frames, group, side, least)]
    return tuple(sorted(modes, key=lambda mode: -mode.weight))


def _leaves(frames: Frames, group: Indices, side: int, least: int) -> Iterator[Indices]:
    """Split the members on one side, by their places along it and outwards, until no place has a valley."""
    waiting = [group]
    while waiting:
        leaf = waiting.pop()
        for direction, references in _directions(side):
            values = [offset_along(frames[leaf], direction, r) * _unit(frames, leaf, direction, r) for r in references]
            parts = split(values[int(np.argmin([entropy(v) for v in values]))], least)
            if len(parts) > 1:
                waiting += [leaf[part] for part in parts]
                break
        else:
            yield leaf


def _directions(side: int) -> Iterable[tuple[Floats, tuple[str, ...]]]:
    """Yield the two directions of a side, and what a place in each may be measured from."""
    yield ALONG[side], ("middle", "low", "high", "share")
    yield NORMAL[side], ("middle", "low", "high") if side == OVER else ("outside",)


def _unit(frames: Frames, leaf: Indices, direction: Floats, reference: str) -> float:
    """Return how many metres a unit is, typically: shares become comparable with metres."""
    return float(np.median(frames.anchor[leaf] @ np.abs(direction))) if reference == "share" else 1.0


def _mode(frames: Frames, side: int, count: int) -> Mode:
    spans = []
    for direction, references in _directions(side):
        options = [
            _span(r, offset_along(frames, direction, r), _unit(frames, np.arange(len(frames.turn)), direction, r)) for r in references
        ]
        spans.append(min(options, key=lambda o: o[0])[1])
    turns = [_turn("anchor", frames.turn), _turn("facing", frames.facing)]
    turn = min(turns, key=lambda t: t.high - t.low - (0.02 if t.reference == "anchor" else 0))
    return Mode(SIDES[side], round(len(frames.turn) / count, DIGITS), spans[1], spans[0], turn)


def _span(reference: str, values: Floats, unit: float) -> tuple[float, Span]:
    """Return how wide a span is [m], and the span; a reference of fewer parts wins where it is hardly wider."""
    low, middle, high = np.percentile(values[_close(values)] if reference == "outside" else values, TAILS)
    handicap = {"middle": 0.0, "outside": 0.0, "share": 0.02}.get(reference, 0.005)
    return float((high - low) * unit + handicap), Span(reference, *_rounded((low, middle, high)))


def _close(gaps: Floats) -> NDArray[np.bool_]:
    """Tell which gaps (N,) [m] are like the others: a few strays, too few to make a mode, would stretch the one they are counted to all over the room."""
    first, third = np.percentile(gaps, (25, 75))
    return np.asarray(gaps <= third + max(STRAYS * float(third - first), STRAY))


def _turn(reference: str, values: Floats) -> Span:
    """Return the span of angles: percentiles around their mean direction."""
    mean = float(np.arctan2(np.sin(values).mean(), np.cos(values).mean()))
    low, middle, high = mean + np.percentile(wrap_angle(values - mean), TAILS)
    return Span(reference, *_rounded((low, middle, high)))


def _wall_relations(rooms: Sequence[Arrangement], kinds: Mapping[str, str]) -> Iterator[WallRelation]:
    """Yield for each category the sides that stand at a wall more often than others do.

    `kinds` names the kind of a category: one of which there are too few to tell stands to walls as all of its kind do together.
    """
    names = np.array([name for room in rooms for name in room.categories])
    measures = [measure(room) for room in rooms if room.categories]
    if not measures:
        return
    gaps, turns = np.concatenate([g for g, _ in measures]), np.concatenate([t for _, t in measures])
    kind = np.array([kinds.get(name, "") for name in names.tolist()])
    for name in sorted(set(names.tolist())):
        own = names == name
        if own.sum() < LEAST_CASES and name in kinds:
            own = kind == kinds[name]
        if own.sum() >= LEAST_CASES:
            for side in range(4):
                relation = _wall_relation(name, side, gaps[own], turns[own])
                if relation is not None and relation.share >= LEAST_SHARE and relation.strength > 0:
                    yield relation


def _wall_relation(name: str, side: int, gaps: Floats, turns: Floats) -> WallRelation | None:
    near = np.flatnonzero(gaps[:, side] < FAR)
    if len(near) < LEAST_CASES / 3:
        return None
    parts = [near[part] for part in split(gaps[near, side], max(8, len(gaps) // 33))]
    best = max(parts, key=len)
    gap = Span("outside", *_rounded(np.percentile(gaps[best, side], TAILS)))
    turn = Span("wall", *_rounded(np.percentile(turns[best, side], TAILS)))
    holds = (gaps > gap.low - METRES) & (gaps < gap.high + METRES) & (turns > turn.low - RADIANS) & (turns < turn.high + RADIANS)
    shares = holds.mean(0)
    share, chance = _rounded((shares[side], np.delete(shares, side).mean()))
    return WallRelation(name, AROUND[side], len(gaps), share, chance, gap, turn)


def _density(values: Floats) -> tuple[Floats, Floats]:
    """Return a kernel estimate over a regular grid: the grid (G,), and its density (G,)."""
    spread = float(np.std(values))
    width = max(WIDTH, 0.3 * spread * (len(values) / 100) ** -0.2)
    step = width / FINE
    low = max(-RANGE, float(values.min())) - 4 * width
    high = min(RANGE, float(values.max())) + 4 * width
    count = int(np.ceil((high - low) / step)) + 1
    cells = np.bincount(np.clip(((values - low) / step).astype(int), 0, count - 1), minlength=count)
    smooth = gaussian_filter1d(cells.astype(float), FINE, mode="constant")
    return low + step * (np.arange(count) + 0.5), smooth / (len(values) * step)


def entropy(values: Floats) -> float:
    """Return minus the mean log density [nats]: the lower, the better the values keep together."""
    grid, densities = _density(values)
    return -float(np.mean(np.log(np.interp(values, grid, densities) + 1e-9)))


def split(values: Floats, least: int) -> list[Indices]:
    """Return the clusters, left to right, as indices; those of fewer than `least` values go with a neighbour."""
    if len(values) < 2 * least:
        return [np.arange(len(values))]
    grid, densities = _density(values)
    cuts = grid[_valleys(densities)]
    order = np.digitize(values, cuts)
    clusters = [np.flatnonzero(order == k) for k in range(len(cuts) + 1)]
    while len(clusters) > 1 and min(map(len, clusters)) < least:
        k = min(range(len(clusters)), key=lambda i: len(clusters[i]))
        other = k - 1 if k and (k == len(clusters) - 1 or _apart(values, clusters, k - 1) < _apart(values, clusters, k)) else k + 1
        first = min(k, other)
        clusters[first : first + 2] = [np.concatenate(clusters[first : first + 2])]
    return clusters


def _apart(values: Floats, clusters: list[Indices], k: int) -> float:
    left, right = values[clusters[k]], values[clusters[k + 1]]
    return float(right.min() - left.max()) if len(left) and len(right) else 0.0


def _valleys(densities: Floats) -> list[int]:
    """Return the grid points at which to cut: the lowest between two peaks, where it is low enough."""
    rise = np.flatnonzero((densities[1:-1] > densities[:-2]) & (densities[1:-1] >= densities[2:])) + 1
    peaks = [int(p) for p in rise]
    cuts: list[int] = []
    while len(peaks) > 1:
        lows = [a + int(np.argmin(densities[a:b])) for a, b in pairwise(peaks)]
        worth = [densities[v] / min(densities[a], densities[b]) for v, a, b in zip(lows, peaks[:-1], peaks[1:], strict=True)]
        k = int(np.argmax(worth))
        if worth[k] <= VALLEY:
            cuts = lows
            break
        del peaks[k if densities[peaks[k]] < densities[peaks[k + 1]] else k + 1]
    return cuts


def _rounded(values: Iterable[float]) -> Iterator[float]:
    return (round(float(value), DIGITS) for value in values)
