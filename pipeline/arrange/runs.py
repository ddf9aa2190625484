"""Kitchens: base units stand side by side under one front line, as one body along their wall; wall units hang flush above them.

Which wall is the draft's choice. Doors and their swing stay free, whatever is tall stands at an end, a unit stands between sink and cooker.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from pipeline.arrange.edges import Edge
from pipeline.arrange.item import Item, yaw_difference
from pipeline.arrange.site import Site

Floats = NDArray[np.float64]

KINDS = frozenset({"kitchen", "appliance"})  # super-categories of what may stand in a run; one of them at least is a kitchen's own
SINK, COOKER = "sink_cabinet", "oven"
TALL = 1.2  # what is higher stands at an end [m]
SEAM = 0.002  # between neighbours [m]
BACK = 0.004  # between the deepest unit and the wall [m]
STRAY = 1.5  # a unit farther than this from every wall is no part of a run [m]
DOORWAY = 0.05  # left free beside doors [m]
CORNER = 0.6  # a gap to a corner that is narrower is closed [m]: half of all real kitchen cabinets stand there
AHEAD = 0.65  # of a run is kept free for its own doors where another meets it in a corner [m]
HUNG_AT = 1.45  # usual underside of wall units above the floor [m]
LEAST_AIR = 0.4  # from base units to wall units [m]
NEXT, IN_LINE = 0.1, 0.12  # units of a run are no farther apart, and their fronts no farther out of line [m]


@dataclass(frozen=True, slots=True)
class Stretch:
    """A free piece of a wall, from `low` to `high` along it [m], and the units that stand there, in their order."""

    edge: Edge
    low: float
    high: float
    units: list[int] = field(default_factory=list)

    def room(self, items: Sequence[Item]) -> float:
        """Return the length that is left [m]."""
        return self.high - self.low - sum(2 * float(items[i].half[0]) + SEAM for i in self.units)


def lay_runs(items: Sequence[Item], walls: Sequence[Edge], site: Site) -> tuple[list[list[int]], dict[int, Floats]]:
    """Return the runs of a room, each as the indices of its units, and the pose (4,) of each unit."""
    floor = base_units(items)
    if len(floor) < 2 or not any(items[i].habit.kind == "kitchen" for i in floor):
        return [], {}
    runs: list[list[int]] = []
    poses: dict[int, Floats] = {}
    taken: list[Floats] = []
    waiting = floor
    wall = {i: _wall_of(items[i], walls) for i in floor}
    depth = max(2 * float(items[i].half[1]) for i in floor) + BACK
    wall = _join_lone_units(wall, items, _by_use(wall, items, walls), depth, site)
    ordered = _by_use(wall, items, walls)
    for edge in ordered:
        own = [i for i in waiting if wall[i] is edge]
        left = _fill(own, items, _stretches(edge, depth, site, taken), poses, runs, taken, site)
        waiting = [i for i in waiting if i not in own] + left
    for edge in ordered:  # who found no room at the wall of the draft goes to another
        waiting = _fill(waiting, items, _stretches(edge, depth, site, taken), poses, runs, taken, site) if waiting else []
    _hang(items, walls, runs, poses, site)
    return runs, poses


def stray_units(runs: Sequence[Sequence[int]], items: Sequence[Item], poses: Floats, there: NDArray[np.bool_]) -> list[int]:
    """Return the units of runs of several, and those that no run had room for, that stand at `poses` (N, 4), and beside no other unit."""
    units = [i for i in base_units(items) if there[i]] if runs else []
    alone = {run[0] for run in runs if len(run) == 1}  # as drafted
    return [i for i in units if i not in alone and not any(k != i and _beside(items, poses, i, k) for k in units)]


def base_units(items: Sequence[Item]) -> list[int]:
    """Return what may stand in a run."""
    return [i for i, item in enumerate(items) if item.habit.kind in KINDS and item.mount == "floor"]


def _beside(items: Sequence[Item], poses: Floats, i: int, k: int) -> bool:
    """Whether unit k stands beside unit i under the same front line."""
    c, s = math.cos(poses[i, 3]), math.sin(poses[i, 3])
    dx, dy = poses[k, :2] - poses[i, :2]
    gap = abs(c * dx + s * dy) - float(items[i].half[0] + items[k].half[0])
    line = s * dx - c * dy + float(items[k].half[1] - items[i].half[1])
    return bool(gap <= NEXT and abs(line) <= IN_LINE and yaw_difference(poses[k, 3], float(poses[i, 3])) < 0.01)


def _by_use(wall: Mapping[int, Edge | None], items: Sequence[Item], walls: Sequence[Edge]) -> list[Edge]:
    """Return the walls at which units are drafted, the one with most of them first."""
    length = [sum(float(items[i].half[0]) for i in wall if wall[i] is edge) for edge in walls]
    return [walls[k] for k in sorted(range(len(walls)), key=lambda k: (-round(length[k], 6), k)) if length[k] > 0]


def _join_lone_units(
    wall: Mapping[int, Edge | None], items: Sequence[Item], ordered: Sequence[Edge], depth: float, site: Site
) -> dict[int, Edge | None]:
    """Return the walls with each unit that is alone at its own sent to others with room beside them, where most are first."""
    at = dict(wall)
    for i in sorted(at, key=lambda i: (items[i].area, i)):
        if at[i] is None or sum(edge is at[i] for edge in at.values()) > 1:
            continue
        for edge in ordered:
            units = [k for k in at if at[k] is edge]
            if edge is not at[i] and units and any(st.room(items) >= 0.0 for st in _stretches(edge, depth, site, (), [*units, i])):
                at[i] = edge
                break
    return at


def _wall_of(item: Item, walls: Sequence[Edge]) -> Edge | None:
    """Return the wall at which a unit is drafted."""
    best: tuple[float, Edge] | None = None
    for edge in walls:
        s, off = float(edge.along_of(item.wished[:2])), float(edge.off(item.wished[:2]))
        beyond = max(0.0, -s, s - edge.length)
        cost = abs(off - float(item.half[1])) + beyond + 0.5 * float(yaw_difference(edge.yaw, float(item.wished[3])))
        if edge.length > 2 * item.half[0] and cost < (best[0] if best else STRAY):
            best = cost, edge
    return best[1] if best else None


def _stretches(edge: Edge, depth: float, site: Site, taken: Sequence[Floats], units: Sequence[int] = ()) -> list[Stretch]:
    """Return the free pieces of a wall for units of this depth, each with `units`: without doors, their swing, and what stands in the corners."""
    cuts = [(opening.start - DOORWAY, opening.end + DOORWAY) for opening in edge.openings if not opening.window]
    swung = [site.swung.polygon(k) for k in range(len(site.swung))]
    for outline, margin in [*((o, DOORWAY) for o in swung), *((o, SEAM) for o in taken)]:
        s, off = edge.along_of(outline), edge.off(outline)
        if off.min() < depth and off.max() > 0.02:
            cuts.append((float(s.min()) - margin, float(s.max()) + margin))
    return _between(edge, cuts, BACK, edge.length - BACK, 0.3, units)


def _between(
    edge: Edge, cuts: Sequence[tuple[float, float]], low: float, high: float, least: float, units: Sequence[int] = ()
) -> list[Stretch]:
    """Return what cuts leave of a wall from `low` to `high`, each piece longer than `least` [m]."""
    stretches, at = [], low
    for first, last in [*sorted(cuts), (high, math.inf)]:
        if min(first, high) - at > least:
            stretches.append(Stretch(edge, at, min(first, high), list(units)))
        at = max(at, last)
    return stretches


def _fill(
    units: Sequence[int],
    items: Sequence[Item],
    stretches: Sequence[Stretch],
    poses: dict[int, Floats],
    runs: list[list[int]],
    taken: list[Floats],
    site: Site,
) -> list[int]:
    """Lay units out in the stretches of a wall, each in the one that is nearest to its draft and has room; return who found none."""
    left = _assign(sorted(units, key=lambda i: (items[i].placement.category not in {SINK, COOKER}, -items[i].area, i)), items, stretches)
    for stretch in stretches:
        if stretch.units:
            runs.append(_lay(stretch, items, poses, site))
            taken.append(_before(stretch, runs[-1], items, poses))
    return left


def _assign(units: Sequence[int], items: Sequence[Item], stretches: Sequence[Stretch]) -> list[int]:
    """Give units, the first first, to the stretch that is nearest to their draft and has room; return who found none."""
    left = []
    for i in units:
        fitting = [st for st in stretches if st.room(items) >= 2 * float(items[i].half[0]) + SEAM]
        if fitting:
            min(fitting, key=lambda st: round(_apart(st, items[i]), 6)).units.append(i)
        else:
            left.append(i)
    return left


def _apart(stretch: Stretch, item: Item) -> float:
    s = _along(stretch.edge, item.wished)
    return max(0.0, stretch.low - s, s - stretch.high)


def _lay(stretch: Stretch, items: Sequence[Item], poses: dict[int, Floats], site: Site) -> list[int]:
    """Lay the units of a stretch side by side under one front line, as near to the draft as order and ends allow."""
    edge = stretch.edge
    order = _unit_order(stretch, items)
    first, last = (min(_play(items[order[k]]), stretch.room(items) / 2) for k in (0, -1))
    widths, wished = [2 * float(items[i].half[0]) for i in order], [_along(edge, items[i].wished) for i in order]
    places = _pack_units(widths, wished, stretch.low + first, stretch.high - last)
    line = BACK + max(2 * float(items[i].half[1]) for i in order if not _tall(items[i])) if not all(_tall(items[i]) for i in order) else 0.0
    for i, s in zip(order, places, strict=True):
        depth = float(items[i].half[1])
        poses[i] = edge.pose(s, max(line - depth, BACK + depth), site.elevation)
    return order


def _play(item: Item) -> float:
    """Return how far what opens reaches beyond the sides of a unit [m]: the handle of a refrigerator's door, into the wall of a corner."""
    across = np.abs(item.shape.keep.boxes()[:, [0, 2]]) if len(item.shape.keep) else np.zeros((1, 2))
    return max(0.0, float(across.max() - item.half[0]))


def _along(edge: Edge, pose: Floats) -> float:
    return float(edge.along_of(pose[:2]))


def _tall(item: Item) -> bool:
    return float(item.placement.size[2]) > TALL


def _unit_order(stretch: Stretch, items: Sequence[Item]) -> list[int]:
    """Return the units in the order of the draft, what is tall at the nearer end, and a unit between sink and cooker."""
    by_place = sorted(stretch.units, key=lambda i: (round(_along(stretch.edge, items[i].wished), 6), i))
    base = [i for i in by_place if not _tall(items[i])]
    middle = (stretch.low + stretch.high) / 2
    if base:
        middle = float(np.mean([_along(stretch.edge, items[i].wished) for i in base]))
    tall = [i for i in by_place if _tall(items[i])]
    low = [i for i in tall if _along(stretch.edge, items[i].wished) < middle]
    return [*low, *_part_sink_cooker(base, items), *(i for i in tall if i not in low)]


def _part_sink_cooker(base: list[int], items: Sequence[Item]) -> list[int]:
    """Put a unit between a sink and a cooker that are neighbours, the nearest other one."""
    for k in range(len(base) - 1):
        if {items[base[k]].placement.category, items[base[k + 1]].placement.category} == {SINK, COOKER}:
            others = [m for m, i in enumerate(base) if items[i].placement.category not in {SINK, COOKER}]
            if not others:
                return base
            m = min(others, key=lambda m: (abs(m - k - 0.5), m))
            rest = [i for i in base if i != base[m]]
            at = k + 1 if m > k else k
            return [*rest[:at], base[m], *rest[at:]]
    return base


def _pack_units(widths: Sequence[float], wished: Sequence[float], low: float, high: float) -> list[float]:
    """Return the middles of units side by side, between `low` and `high`, nearest to the wished ones; small gaps to the ends are closed."""
    steps = np.array(widths) + SEAM
    middles = np.cumsum(steps) - steps / 2
    total = float(steps.sum())
    start = min(max(float(np.mean(np.array(wished) - middles)), low), high - total)
    if start - low < CORNER:
        start = low
    elif high - total - start < CORNER:
        start = high - total
    return [float(start + m) for m in middles]


def _before(stretch: Stretch, order: Sequence[int], items: Sequence[Item], poses: dict[int, Floats]) -> Floats:
    """Return the outline (4, 2) of a run and the floor that its doors need."""
    edge = stretch.edge
    s = [_along(edge, poses[i]) for i in order]
    low, high = s[0] - float(items[order[0]].half[0]), s[-1] + float(items[order[-1]].half[0])
    deep = max(2 * float(items[i].half[1]) for i in order) + BACK + AHEAD
    return np.array([edge.start + a * edge.along + b * edge.inward for a, b in ((low, 0.0), (high, 0.0), (high, deep), (low, deep))])


def _hang(items: Sequence[Item], walls: Sequence[Edge], runs: list[list[int]], poses: dict[int, Floats], site: Site) -> None:
    """Hang wall units flush above the base units of their wall, clear of windows, doors and what is tall."""
    hung = {i: _wall_of(item, walls) for i, item in enumerate(items) if item.habit.kind == "kitchen" and item.mount == "wall"}
    for edge in walls:
        own = [i for i in hung if hung[i] is edge]
        base = [
            i for run in runs for i in run if abs(float(yaw_difference(poses[i][3], edge.yaw))) < 0.01 and _at(poses[i], edge, items[i])
        ]
        if not own or not base:
            continue
        bottom = float(np.median([items[i].wished[2] for i in own])) - site.elevation
        top = max(float(items[i].placement.size[2]) for i in base if not _tall(items[i])) if any(not _tall(items[i]) for i in base) else 0.9
        highest = site.ceiling - site.elevation - max(float(items[i].placement.size[2]) for i in own) - 0.02
        bottom = min(bottom if abs(bottom - HUNG_AT) < 0.1 else HUNG_AT, highest)
        if bottom < top + LEAST_AIR:
            continue
        cuts = [(opening.start - SEAM, opening.end + SEAM) for opening in edge.openings]
        ends = []
        for i in base:
            at, wide = _along(edge, poses[i]), float(items[i].half[0])
            if _tall(items[i]):
                cuts.append((at - wide - SEAM, at + wide + SEAM))
            else:
                ends.append((at - wide, at + wide))
        low, high = (min(a for a, _ in ends), max(b for _, b in ends)) if ends else (BACK, edge.length - BACK)
        _hang_in(own, items, _between(edge, cuts, low, high, 0.2), poses, site.elevation + bottom)


def _at(pose: Floats, edge: Edge, item: Item) -> bool:
    off = float(edge.off(pose[:2]))
    return abs(off - float(item.half[1])) < 0.2 and 0.0 < _along(edge, pose) < edge.length


def _hang_in(own: Sequence[int], items: Sequence[Item], stretches: Sequence[Stretch], poses: dict[int, Floats], z: float) -> None:
    """Lay wall units out in stretches, flush; who finds no room is left to be placed by itself."""
    _assign(sorted(own, key=lambda i: (-float(items[i].half[0]), i)), items, stretches)
    for stretch in stretches:
        if stretch.units:
            order = sorted(stretch.units, key=lambda i: (round(_along(stretch.edge, items[i].wished), 6), i))
            wide, wished = [2 * float(items[i].half[0]) for i in order], [_along(stretch.edge, items[i].wished) for i in order]
            for i, s in zip(order, _pack_units(wide, wished, stretch.low, stretch.high), strict=True):
                poses[i] = stretch.edge.pose(s, BACK + float(items[i].half[1]), z)
