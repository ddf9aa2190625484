"""Intervals and points in the plane: what solids are cut from. Lengths in metres."""

import itertools
import math

import numpy as np

Interval = tuple[float, float]  # from, to
Spot = tuple[float, float]  # two coordinates


def around(half: float, at: float = 0.0) -> Interval:
    """Return the interval that reaches `half` to either side of `at`."""
    return (at - half, at + half)


def between(a: float, b: float) -> Interval:
    """Return the interval between two numbers in either order."""
    return (min(a, b), max(a, b))


def corners(x: float, y: float) -> list[Spot]:
    """Return the corners of a rectangle around the origin: (-x, -y), (-x, y), (x, -y), (x, y)."""
    return [(sx * x, sy * y) for sx in (-1, 1) for sy in (-1, 1)]


def edges(x: Interval, t: float) -> tuple[Interval, Interval]:
    """Return the first and the last `t` of an interval."""
    return (x[0], x[0] + t), (x[1] - t, x[1])


def inset(x: Interval, by: float) -> Interval:
    """Return the interval, `by` shorter at either end."""
    return (x[0] + by, x[1] - by)


def split(x: Interval, count: int, gap: float = 0.0) -> list[Interval]:
    """Return `count` equal parts of an interval, `gap` off either end of each."""
    return [(a + gap, b - gap) for a, b in itertools.pairwise(np.linspace(*x, count + 1).tolist())]


def polar(radius: float, angle: float, *height: float) -> tuple[float, ...]:
    """Return the point (2,) at an angle [rad] around the origin, or with a `height` (3,)."""
    return (radius * math.cos(angle), radius * math.sin(angle), *height)
