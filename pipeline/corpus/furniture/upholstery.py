"""Upholstery: seat and back cushions with piping or tufts, bolsters, throw pillows, duvets. Lengths in metres."""

import itertools

import numpy as np

from pipeline.corpus.furniture.finishes import Finish, Scheme
from pipeline.corpus.furniture.intervals import Interval, around, inset
from pipeline.corpus.furniture.shape import Pieces, pieces
from pipeline.corpus.furniture.solids import Solid, cushion, pillow, rod, rounded_rectangle, slab

SEAM = 0.007  # height of a piping


def piping(rng: np.random.Generator, scheme: Scheme) -> Finish | None:
    """Draw what a cushion's seams are piped with, if they are."""
    return scheme.second if rng.random() < scheme.manner.piping else None


def seat_cushion(
    x: Interval, y: Interval, z: Interval, radius: float, cloth: Finish, piping: Finish | None = None, crown: float = 0.02
) -> Pieces:
    """Return a seat cushion with a swelling top; with `piping` a cord of that finish runs around its upper edge."""
    crown = min(crown, 0.3 * (z[1] - z[0]))
    if piping is None:
        return pieces("cushion", cushion(x, y, z, radius, 3, crown), cloth)
    cut = z[0] + 0.62 * (z[1] - crown - z[0])
    r = min(radius, 0.4 * (z[1] - crown - cut))
    inner_x, inner_y = inset(x, 0.004), inset(y, 0.004)
    cord = slab(rounded_rectangle(x, y, radius, 3), (cut, cut + SEAM), 0.002)
    lower = slab(rounded_rectangle(inner_x, inner_y, radius, 3), (z[0], cut), 0.006)
    upper = cushion(inner_x, inner_y, (cut + SEAM, z[1]), min(r, 0.03), 2, crown)
    return pieces("cushion", [lower, upper], cloth) + pieces("piping", cord, piping)


def tufted_panel(x: Interval, y: Interval, z: Interval, across: int, rows: int) -> list[Solid]:
    """Return an upright buttoned panel facing -y: a board behind a grid of small pads."""
    deep = y[1] - y[0]
    solids: list[Solid] = [cushion(x, (y[0] + 0.5 * deep, y[1]), z, 0.2 * deep, 1)]
    xs, zs = np.linspace(x[0] + 0.01, x[1] - 0.01, across + 1), np.linspace(z[0] + 0.01, z[1] - 0.01, rows + 1)
    for a, b in itertools.pairwise(xs):
        for c, e in itertools.pairwise(zs):
            solids.append(cushion((a + 0.001, b - 0.001), (y[0], y[0] + 0.5 * deep), (c + 0.001, e - 0.001), 0.45 * 0.5 * deep, 1))
    return solids


def upright_pad(rng: np.random.Generator, scheme: Scheme, x: Interval, y: Interval, z: Interval) -> list[Solid]:
    """Return an upright pad facing -y: plain, in channels, or buttoned, as the style likes."""
    wide, tall = x[1] - x[0], z[1] - z[0]
    u = rng.random()
    if u < 0.6 * scheme.manner.tufts and wide > 0.3:
        return tufted_panel(x, y, z, max(2, round(wide / 0.17)), max(2, round(tall / 0.17)))
    if u < 0.9 * scheme.manner.tufts + 0.08 and wide > 0.3:
        return channels(x, y, z, max(3, round(wide / 0.09)))
    radius = min(0.45 * (y[1] - y[0]), scheme.manner.soft)
    return [cushion(x, y, z, radius, 3)]


def channels(x: Interval, y: Interval, z: Interval, count: int) -> list[Solid]:
    """Return an upright pad sewn in upright channels."""
    xs = np.linspace(x[0], x[1], count + 1)
    deep = y[1] - y[0]
    return [cushion((a + 0.0005, b - 0.0005), y, z, 0.42 * min(deep, float(b - a)), 2) for a, b in itertools.pairwise(xs)]


def bolster(x: Interval, y: float, z: float, radius: float) -> Solid:
    """Return a roll along x."""
    return rod((x[0], y, z), (x[1], y, z), radius, n=14)


def throw_pillow(at: tuple[float, float, float], size: float, tilt: float, yaw: float) -> Solid:
    """Return a pillow that stands on `at` and leans back by `tilt` [rad]; its lowest edge is at that height."""
    solid = pillow(around(size / 2), around(size / 2), around(0.15 * size), 2)
    solid = solid.turned("x", np.pi / 2 - tilt).turned("z", yaw)
    return solid.moved((at[0], at[1], at[2] - float(solid.vertices[:, 2].min())))


def duvet(x: Interval, y: Interval, z: float, thick: float, drop: float, cloth: Finish) -> Pieces:
    """Return a cover that lies on a mattress at `z` and hangs over its sides by `drop`; x, y are the mattress's."""
    side = 0.55 * thick
    solids = [cushion(inset(x, -side), y, (z, z + thick), 0.45 * thick, 3, 0.25 * thick)]
    hems = ((x[0] - side, x[0]), (x[1], x[1] + side))
    solids += [cushion(hem, (y[0], y[1] - 0.01), (z - drop, z), 0.45 * side, 1) for hem in hems]
    return pieces("duvet", solids, cloth)
