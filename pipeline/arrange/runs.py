"""Kitchens: base units stand side by side under one front line, as one body along their wall; wall units hang flush above them.

Which wall is the draft's choice. Doors and their swing stay free, whatever is tall stands at an end, a unit stands between sink and cooker.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from pipeline.arrange.candidates import hides
from pipeline.arrange.item import Item, yaw_difference
from pipeline.arrange.site import Site
from pipeline.arrange.walls import Edge
from pipeline.arrays import Floats

KINDS = frozenset({"kitchen", "appliance"})  # super-categories of what may stand in a run; one of them at least is a kitchen's own
SINK, COOKER = "sink_cabinet", "oven"
TALL = 1.2  # what is higher stands at an end [m]
SEAM = 0.002  # between neighbours [m]
BACK = 0.004  # between the deepest unit and the wall [m]
STRAY = 1.5  # a unit farther than this from every wall is no part of a run [m]
DOORWAY = 0.05  # left free beside doors [m]
CORNER = 0.6  # a gap to a corner that is narrower is closed [m]: half of all real kitchen cabinets stand there
HANGING = 0.1  # for wall units, which hang over those that they were drafted over [m]
AHEAD = 0.65  # of a run is kept free for its own doors where another meets it in a corner [m]
HUNG_AT = 1.45  # usual underside of wall units above the floor [m]
LEAST_AIR = 0.4  # from base units to wall units [m]
NEXT, IN_LINE = 0.1, 0.12  # units of a run are no farther apart, and their fronts no farther out of line [m]


def lay_runs(items: Sequence[Item], site: Site) -> tuple[list[list[int]], dict[int, Floats]]:
    """Return the runs of a room, each as the indices of its units, and the pose (4,) of each unit."""
    units = base_units(items)
    if len(units) < 2 or not any(items[i].habit.kind == "kitchen" for i in units):
        return [], {}
    kitchen = _Kitchen(items, site, max(items[i].depth for i in units) + BACK)
    wall = kitchen.joined({i: _wall_of(items[i], site.walls) for i in units})
    ordered, waiting = kitchen.by_use(wall), units
    for edge in ordered:
        own = [i for i in waiting if wall[i] is edge]
        waiting = [i for i in waiting if i not in own] + kitchen.fill(edge, own)
    for edge in ordered:  # who found no room at the wall of the draft goes to another
        waiting = kitchen.fill(edge, waiting)
    kitchen.hang()
    return kitchen.runs, kitchen.poses


def stray_units(runs: Sequence[Sequence[int]], items: Sequence[Item], poses: Floats, there: NDArray[np.bool_]) -> list[int]:
    """Return the units of runs of several, and those that no run had room for, that stand at `poses` (N, 4), and beside no other unit."""
    units = [i for i in base_units(items) if there[i]] if runs else []
    alone = {run[0] for run in runs if len(run) == 1}  # as drafted
    return [i for i in units if i not in alone and not any(k != i and _beside(items, poses, i, k) for k in units)]


def bare_units(items: Sequence[Item], poses: Floats, there: NDArray[np.bool_], site: Site) -> list[int]:
    """Return the wall units that hang at `poses` (N, 4), and over no base unit or before a window."""
    hung = [i for i, item in enumerate(items) if there[i] and item.habit.kind == "kitchen" and item.mount == "wall"]
    base = [i for i in base_units(items) if there[i]]
    return [i for i in hung if hides(items[i], poses[i], site) or not any(_over(items, poses, i, k) for k in base)]


def base_units(items: Sequence[Item]) -> list[int]:
    """Return what may stand in a run."""
    return [i for i, item in enumerate(items) if item.habit.kind in KINDS and item.mount == "floor"]


def _over(items: Sequence[Item], poses: Floats, i: int, k: int) -> bool:
    """Whether the middle of wall unit i is over base unit k, or at most a seam beside it."""
    c, s = math.cos(poses[k, 3]), math.sin(poses[k, 3])
    dx, dy = poses[i, :2] - poses[k, :2]
    return bool(abs(c * dx + s * dy) <= items[k].half[0] + NEXT and abs(c * dy - s * dx) <= items[k].half[1] + NEXT)


def _beside(items: Sequence[Item], poses: Floats, i: int, k: int) -> bool:
    """Whether unit k stands beside unit i under the same front line."""
    c, s = math.cos(poses[i, 3]), math.sin(poses[i, 3])
    dx, dy = poses[k, :2] - poses[i, :2]
    gap = abs(c * dx + s * dy) - float(items[i].half[0] + items[k].half[0])
    line = s * dx - c * dy + float(items[k].half[1] - items[i].half[1])
    in_line = abs(line) <= IN_LINE or _is_tall(items[i]) or _is_tall(items[k])  # a refrigerator's front stands out
    return bool(gap <= NEXT and in_line and yaw_difference(poses[k, 3], float(poses[i, 3])) < 0.01)


@dataclass(frozen=True, slots=True)
class _Stretch:
    """A free piece of a wall, from `low` to `high` along it [m], and the units that are to stand there."""

    edge: Edge
    low: float
    high: float
    units: list[int]


@dataclass(frozen=True, slots=True)
class _Kitchen:
    """The kitchen of a room while it is laid out for units of some `depth` [m]: the runs so far, the poses (4,) of their units, and what (4, 2) they take of the floor."""

    items: Sequence[Item]
    site: Site
    depth: float
    runs: list[list[int]] = field(default_factory=list)
    poses: dict[int, Floats] = field(default_factory=dict)
    taken: list[Floats] = field(default_factory=list)

    def by_use(self, wall: Mapping[int, Edge | None]) -> list[Edge]:
        """Return the walls at which units are drafted, the one with most of them first."""
        walls = self.site.walls
        length = [sum(float(self.items[i].half[0]) for i in wall if wall[i] is edge) for edge in walls]
        return [walls[k] for k in sorted(range(len(walls)), key=lambda k: (-round(length[k], 6), k)) if length[k] > 0]

    def joined(self, wall: Mapping[int, Edge | None]) -> dict[int, Edge | None]:
        """Return the walls with each unit that is alone at its own sent to others with room beside them, where most are first."""
        at = dict(wall)
        for i in sorted(at, key=lambda i: (self.items[i].area, i)):
            if at[i] is None or sum(edge is at[i] for edge in at.values()) > 1:
                continue
            for edge in self.by_use(wall):
                units = [k for k in at if at[k] is edge]
                if edge is not at[i] and units and any(self._room(st) >= 0.0 for st in self._stretches(edge, [*units, i])):
                    at[i] = edge
                    break
        return at

    def fill(self, edge: Edge, units: Sequence[int]) -> list[int]:
        """Lay units out along a wall, each in the stretch that is nearest to its draft and has room; return who found none."""
        items, stretches = self.items, self._stretches(edge)
        first = sorted(units, key=lambda i: (items[i].placement.category not in {SINK, COOKER}, -items[i].area, i))
        left = self._assign(first, stretches)
        for stretch in (st for st in stretches if st.units):
            order = self._order(stretch)
            first_end, last_end = (min(_play(items[order[k]]), self._room(stretch) / 2) for k in (0, -1))
            line = max((items[i].depth for i in order if not _is_tall(items[i])), default=-BACK) + BACK
            within = _Stretch(edge, stretch.low + first_end, stretch.high - last_end, order)
            self._lay(within, line, self.site.elevation)
            self.runs.append(order)
            self.taken.append(self._outline(edge, order))
        return left

    def hang(self) -> None:
        """Hang wall units flush above the base units of their wall, clear of windows, doors and what is tall; who finds no room is left to be placed by itself."""
        items, site = self.items, self.site
        hung = {i: _wall_of(item, site.walls) for i, item in enumerate(items) if item.habit.kind == "kitchen" and item.mount == "wall"}
        for edge in site.walls:
            own = [i for i in hung if hung[i] is edge]
            base = [i for run in self.runs for i in run if _at(self.poses[i], edge, items[i])]
            if not own or not base:
                continue
            bottom = float(np.median([items[i].wished[2] for i in own])) - site.elevation
            worktops = [i for i in base if not _is_tall(items[i]) and items[i].placement.category != SINK]  # a tap is no worktop
            top = max((float(items[i].placement.size[2]) for i in worktops), default=0.9)
            highest = site.ceiling - site.elevation - max(float(items[i].placement.size[2]) for i in own) - 0.02
            bottom = min(bottom if abs(bottom - HUNG_AT) < 0.1 else HUNG_AT, highest)
            if bottom < top + LEAST_AIR:
                continue
            spans = {i: self._span(edge, i) for i in base}
            low = min((a for i, (a, _) in spans.items() if not _is_tall(items[i])), default=BACK)
            high = max((b for i, (_, b) in spans.items() if not _is_tall(items[i])), default=edge.length - BACK)
            cuts = [(opening.start, opening.end) for opening in edge.openings] + [spans[i] for i in base if _is_tall(items[i])]
            stretches = _between(edge, [(a - SEAM, b + SEAM) for a, b in cuts], low, high, 0.2)
            self._assign(sorted(own, key=lambda i: (-float(items[i].half[0]), i)), stretches)
            for stretch in (st for st in stretches if st.units):
                stretch.units.sort(key=lambda i: (round(self._wished(edge, i), 6), i))
                self._lay(stretch, 0.0, site.elevation + bottom, HANGING)

    def _wished(self, edge: Edge, i: int) -> float:
        """Return where along a wall a unit is drafted [m]."""
        return float(edge.along_of(self.items[i].wished[:2]))

    def _span(self, edge: Edge, i: int) -> tuple[float, float]:
        """Return from where to where along its wall a unit stands [m]."""
        at, half = float(edge.along_of(self.poses[i][:2])), float(self.items[i].half[0])
        return at - half, at + half

    def _room(self, stretch: _Stretch) -> float:
        """Return the length that is left [m]."""
        return stretch.high - stretch.low - sum(self.items[i].width + SEAM for i in stretch.units)

    def _stretches(self, edge: Edge, units: Sequence[int] = ()) -> list[_Stretch]:
        """Return the free pieces of a wall, each with `units`: without doors, their swing, and what stands in the corners."""
        cuts = [(opening.start - DOORWAY, opening.end + DOORWAY) for opening in edge.openings if not opening.window]
        swung = [self.site.swung.polygon(k) for k in range(len(self.site.swung))]
        for outline, margin in [*((o, DOORWAY) for o in swung), *((o, SEAM) for o in self.taken)]:
            s, off = edge.along_of(outline), edge.off(outline)
            if off.min() < self.depth and off.max() > 0.02:
                cuts.append((float(s.min()) - margin, float(s.max()) + margin))
        return _between(edge, cuts, BACK, edge.length - BACK, 0.3, units)

    def _assign(self, units: Sequence[int], stretches: Sequence[_Stretch]) -> list[int]:
        """Give units, the first first, to the stretch that is nearest to their draft and has room; return who found none."""
        left = []
        for i in units:
            fitting = [st for st in stretches if self._room(st) >= self.items[i].width + SEAM]
            if fitting:
                s = self._wished(fitting[0].edge, i)
                min(fitting, key=lambda st: round(max(0.0, st.low - s, s - st.high), 6)).units.append(i)
            else:
                left.append(i)
        return left

    def _order(self, stretch: _Stretch) -> list[int]:
        """Return the units in the order of the draft, what is tall at the nearer end, and a unit between sink and cooker."""
        wished = {i: self._wished(stretch.edge, i) for i in stretch.units}
        by_place = sorted(wished, key=lambda i: (round(wished[i], 6), i))
        base, tall = ([i for i in by_place if _is_tall(self.items[i]) == high] for high in (False, True))
        middle = float(np.mean([wished[i] for i in base])) if base else (stretch.low + stretch.high) / 2
        low = [i for i in tall if wished[i] < middle]
        return [*low, *_part_sink_cooker(base, self.items), *(i for i in tall if i not in low)]

    def _lay(self, stretch: _Stretch, line: float, z: float, closed: float = CORNER) -> None:
        """Lay the units of a stretch side by side, their fronts on a `line` [m] before the wall, nearest to the draft; small gaps to the ends are closed."""
        steps = np.array([self.items[i].width for i in stretch.units]) + SEAM
        middles, total = np.cumsum(steps) - steps / 2, float(steps.sum())
        wished = np.array([self._wished(stretch.edge, i) for i in stretch.units])
        last = stretch.high - total
        start = min(max(float(np.mean(wished - middles)), stretch.low), last)
        end = min((stretch.low, last), key=lambda end: abs(start - end))
        if abs(start - end) < closed:
            start = end
        for i, middle in zip(stretch.units, middles, strict=True):
            half = float(self.items[i].half[1])
            self.poses[i] = stretch.edge.pose(float(start + middle), max(line - half, BACK + half), z)

    def _outline(self, edge: Edge, order: Sequence[int]) -> Floats:
        """Return the outline (4, 2) of a run and the floor that its doors need."""
        low, high = self._span(edge, order[0])[0], self._span(edge, order[-1])[1]
        deep = max(self.items[i].depth for i in order) + BACK + AHEAD
        return np.array([edge.start + a * edge.along + b * edge.inward for a, b in ((low, 0.0), (high, 0.0), (high, deep), (low, deep))])


def _wall_of(item: Item, walls: Sequence[Edge]) -> Edge | None:
    """Return the wall at which a unit is drafted."""
    best: tuple[float, Edge] | None = None
    for edge in walls:
        s, off = float(edge.along_of(item.wished[:2])), float(edge.off(item.wished[:2]))
        beyond = max(0.0, -s, s - edge.length)
        cost = abs(off - float(item.half[1])) + beyond + 0.5 * float(yaw_difference(edge.yaw, float(item.wished[3])))
        if edge.length > item.width and cost < (best[0] if best else STRAY):
            best = cost, edge
    return best[1] if best else None


def _between(
    edge: Edge, cuts: Sequence[tuple[float, float]], low: float, high: float, least: float, units: Sequence[int] = ()
) -> list[_Stretch]:
    """Return what cuts leave of a wall from `low` to `high`, each piece longer than `least` [m]."""
    stretches, at = [], low
    for first, last in [*sorted(cuts), (high, math.inf)]:
        if min(first, high) - at > least:
            stretches.append(_Stretch(edge, at, min(first, high), list(units)))
        at = max(at, last)
    return stretches


def _is_tall(item: Item) -> bool:
    return float(item.placement.size[2]) > TALL


def _play(item: Item) -> float:
    """Return how far what opens reaches beyond the sides of a unit [m]: the handle of a refrigerator's door, into the wall of a corner."""
    across = np.abs(item.shape.keep.boxes()[:, [0, 2]]) if len(item.shape.keep) else np.zeros((1, 2))
    return max(0.0, float(across.max() - item.half[0]))


def _part_sink_cooker(base: list[int], items: Sequence[Item]) -> list[int]:
    """Put a unit between a sink and a cooker that are neighbours, the nearest other one."""
    names = [items[i].placement.category for i in base]
    others = [m for m, name in enumerate(names) if name not in {SINK, COOKER}]
    k = next((k for k in range(len(base) - 1) if {names[k], names[k + 1]} == {SINK, COOKER}), None)
    if k is None or not others:
        return base
    m = min(others, key=lambda m: (abs(m - k - 0.5), m))
    rest, at = [i for i in base if i != base[m]], k + 1 if m > k else k
    return [*rest[:at], base[m], *rest[at:]]


def _at(pose: Floats, edge: Edge, item: Item) -> bool:
    """Whether a unit stands with its back to a wall, and beside it."""
    off, s = float(edge.off(pose[:2])), float(edge.along_of(pose[:2]))
    squarely = float(yaw_difference(pose[3], edge.yaw)) < 0.01
    return squarely and abs(off - float(item.half[1])) < 0.2 and 0.0 < s < edge.length
