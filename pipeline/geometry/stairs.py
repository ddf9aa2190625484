"""The flights in a staircase: winding steps about its middle, from the opening on one storey to the opening on the next.

A staircase is one room with a shaft through all its storeys. Where each storey has exactly one opening to it, a landing lies before each
opening, and steps of equal rise and equal share of the shaft's wall wind from landing to landing, the longer way round. A staircase that
several rooms of a storey open to, that a leaf turns into, or whose outline is not convex, stays without steps: they would stand in the way.
"""

from dataclasses import dataclass
from math import ceil
from typing import Literal

import numpy as np
import shapely

from pipeline.arrays import Floats
from pipeline.entities.plan import Plan, Room

RISE = 0.2  # of a step, at most [m]
BODY = 0.25  # thickness of steps and landings [m]
LANDING = 0.15  # how far landings reach beside their opening [m]
NEWEL = 0.12  # side of the post that steps wind about [m]
RAIL, RAIL_HEIGHT = 0.05, 0.95  # thickness and height of the balustrade beside a landing [m]


@dataclass(frozen=True, slots=True)
class Step:
    """A convex upright solid of a staircase: `polygon` (n, 2) [m] counter-clockwise, z from `bottom` to `top` above its storey's floor."""

    kind: Literal["step", "landing", "rail", "newel"]
    polygon: Floats
    bottom: float
    top: float


def steps(plan: Plan, level: int) -> tuple[Step, ...]:
    """Return the landings on a storey with their balustrades, and the flights that lead up from it."""
    staircases = [room for room in plan.rooms if room.type == "staircase" and level in plan.levels_of(room)]
    return tuple(step for room in staircases for step in _storey(plan, room, level))


def visible_steps(plan: Plan, level: int) -> tuple[Step, ...]:
    """Return the steps that one sees on a storey: its own, and the flights that arrive from below; heights above its floor."""
    below = (Step(s.kind, s.polygon, s.bottom - plan.storey_height, s.top - plan.storey_height) for s in steps(plan, level - 1))
    return (*below, *steps(plan, level))


def _storey(plan: Plan, room: Room, level: int) -> list[Step]:
    storeys = list(plan.levels_of(room))
    mouths = [[o for o in plan.openings if room.room_id in o.rooms and o.level == k and o.kind != "window"] for k in storeys]
    shape = shapely.Polygon(room.polygon)
    if any(o.swing and o.swing.room_id == room.room_id for m in mouths for o in m):
        return []
    if len(storeys) < 2 or any(len(m) != 1 for m in mouths) or shape.convex_hull.area > shape.area + 1e-6:
        return []
    well = _Well(room.polygon)
    at = [well.project(m[0].segment.mean(axis=0)) for m in mouths]
    half = [min(m[0].width / 2 + LANDING, well.length / 4) for m in mouths]
    turn = 1 if well.way(at[0], half[0], at[1], half[1], 1) >= well.way(at[0], half[0], at[1], half[1], -1) else -1
    k = storeys.index(level)
    pieces = []
    if k > 0:
        pieces.append(Step("landing", well.sector(at[k] - half[k], at[k] + half[k]), -BODY, 0.0))
        if k == len(storeys) - 1:
            pieces.append(Step("rail", well.rail(at[k] + turn * half[k]), 0.0, RAIL_HEIGHT))
    if k < len(storeys) - 1:
        count = ceil(plan.storey_height / RISE)
        rise = plan.storey_height / count
        going = well.way(at[k], half[k], at[k + 1], half[k + 1], turn) / (count - 1)
        start = at[k] + turn * half[k]
        for i in range(count - 1):
            low, high = sorted((start + turn * i * going, start + turn * (i + 1) * going))
            top = (i + 1) * rise
            pieces.append(Step("step", well.sector(low, high), max(0.0, top - BODY), top))
        post = well.middle + NEWEL / 2 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
        pieces.append(Step("newel", post, 0.0, plan.storey_height + RAIL_HEIGHT))
    return pieces


class _Well:
    """A convex shaft, measured along its wall: a place is a length from its first corner, counter-clockwise, modulo the whole."""

    def __init__(self, polygon: Floats) -> None:
        self.corners = polygon
        self.ring = shapely.LinearRing(polygon)
        self.length = float(self.ring.length)
        self.middle = np.asarray(shapely.Polygon(polygon).centroid.coords)[0]
        sides = np.linalg.norm(np.roll(polygon, -1, axis=0) - polygon, axis=1)
        self.places = np.concatenate([[0.0], np.cumsum(sides)[:-1]])

    def project(self, point: Floats) -> float:
        return float(self.ring.project(shapely.Point(point)))

    def point(self, place: float) -> Floats:
        return np.asarray(np.asarray(self.ring.interpolate(place % self.length).coords)[0])

    def way(self, a: float, half_a: float, b: float, half_b: float, turn: int) -> float:
        """Return the length of wall from the landing at a to the one at b, turning that way; landings may lie above each other."""
        apart = (turn * (b - a)) % self.length
        ends = half_a + half_b
        return apart - ends if apart >= ends else apart + self.length - ends

    def sector(self, low: float, high: float) -> Floats:
        """Return the piece of the shaft between the middle and the wall from `low` to `high`."""
        between = sorted(
            (p + n * self.length, i)
            for n in range(-2, 3)
            for i, p in enumerate(self.places)
            if low + 1e-6 < p + n * self.length < high - 1e-6
        )
        return np.array([self.middle, self.point(low), *(self.corners[i] for _, i in between), self.point(high)])

    def rail(self, place: float) -> Floats:
        """Return the balustrade from the wall at a place to the middle, upright on both."""
        line = shapely.LineString([self.point(place), self.middle]).buffer(RAIL / 2, cap_style="flat")
        inside = shapely.geometry.polygon.orient(line.intersection(shapely.Polygon(self.corners)))
        return np.asarray(inside.exterior.coords)[:-1]
