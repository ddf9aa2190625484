"""The building as the top view shows it: patterned floors, walls cut through, windows in them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from shapely.geometry import Polygon

from pipeline.entities.asset import Material
from pipeline.entities.plan import Plan
from pipeline.geometry.stairs import seen
from pipeline.geometry.tiling import convex_pieces
from pipeline.geometry.walls import Shell
from pipeline.rendering import palette

WALL = (0.20, 0.21, 0.24)
WINDOW = (0.62, 0.76, 0.86)
WALL_TOP = 2.4  # depth at which cut walls are drawn: above furniture [m]
WOOD = frozenset(m.name for m in (palette.OAK, palette.LIGHT_OAK, palette.WALNUT))
PLANK = (1.35, 0.19)  # length, width [m]
TILE = (0.45, 0.45)
GRAIN = 0.03  # how much planks and tiles differ
STEP_GRAIN = 0.08  # how much a step differs from the next
PALENESS = 0.42  # floors are mixed with white, so that furniture stands out


@dataclass(frozen=True, slots=True)
class Soup:
    """Coloured triangles: `faces` (T, 3, 3) [m], `colours` (T, 3) sRGB, `items` (T,): 0 for the building."""

    faces: NDArray[np.float64]
    colours: NDArray[np.float32]
    items: NDArray[np.int32]


def building(plan: Plan, level: int, shell: Shell) -> Soup:
    """Return one storey's floors, thresholds, cut walls and windows as triangles; heights above the storey's floor."""
    quads: list[tuple[NDArray[np.float64], tuple[float, float, float], float]] = []
    for room in plan.rooms:
        if room.level == level:
            material = palette.floor(room.type)
            for piece in convex_pieces(Polygon(room.polygon)):
                base = pale(material)
                quads.extend((ring, shaded(base, 1 + GRAIN * shade), 0.0) for ring, shade in pattern(piece, material))
    for step in seen(plan, level):
        grey = np.interp(step.top, (-plan.storey_height, 0.0, plan.storey_height), (0.45, 0.95, 1.05))
        quads.append((step.polygon, shaded(pale(palette.STEP), float(grey) + STEP_GRAIN * (len(quads) % 2)), min(step.top, WALL_TOP - 0.1)))
    for cut in shell.cuts:
        if cut.bottom > 0.05 or cut.opening.kind == "window":
            quads.append((cut.quad, WINDOW, WALL_TOP))
        else:
            quads.append((cut.quad, pale(palette.threshold(plan, cut.opening)), 0.0))
    quads.extend((prism.polygon, WALL, WALL_TOP) for prism in shell.prisms if prism.kind == "wall")
    corners = np.array([len(ring) - 2 for ring, *_ in quads])
    colours = np.repeat(np.array([colour for _, colour, _ in quads], np.float32), corners, axis=0)
    faces = fans([ring for ring, *_ in quads], np.array([z for *_, z in quads]))
    return Soup(faces, colours, np.zeros(len(faces), np.int32))


def fans(rings: Sequence[NDArray[np.float64]], heights: NDArray[np.float64]) -> NDArray[np.float64]:
    """Triangulate convex rings (n, 2), each at its height [m]: triangles (T, 3, 3), n - 2 for each, in their order."""
    size = np.array([len(ring) for ring in rings])
    first = np.repeat(np.cumsum(size) - size, size - 2)  # of each triangle's ring
    number = np.arange(len(first)) - np.repeat(np.cumsum(size - 2) - (size - 2), size - 2) + 1
    points = np.column_stack([np.concatenate(rings), np.repeat(heights, size)])
    return np.stack([points[first], points[first + number], points[first + number + 1]], axis=1)


def pale(material: Material) -> tuple[float, float, float]:
    """Return the display colour of a floor material."""
    red, green, blue = ((1 - PALENESS) * c + PALENESS for c in palette.to_srgb(material.base_color))
    return red, green, blue


def pattern(piece: NDArray[np.float64], material: Material) -> list[tuple[NDArray[np.float64], float]]:
    """Cut an axis-parallel rectangle into planks or tiles, each with a shade in [-1, 1]; other shapes stay whole."""
    (x0, y0), (x1, y1) = piece.min(axis=0), piece.max(axis=0)
    rectangle = len(piece) == 4 and abs((x1 - x0) * (y1 - y0) - Polygon(piece).area) < 1e-6
    if not rectangle or material.name == palette.CONCRETE.name:
        return [(piece, 0.0)]
    length, width = PLANK if material.name in WOOD else TILE
    out = []
    for row in range(int(np.floor(y0 / width)), int(np.ceil(y1 / width))):
        shift = length * ((row * 7) % 5) / 5 if material.name in WOOD else 0.0
        for column in range(int(np.floor((x0 - shift) / length)), int(np.ceil((x1 - shift) / length))):
            a, b = max(x0, column * length + shift), min(x1, (column + 1) * length + shift)
            c, d = max(y0, row * width), min(y1, (row + 1) * width)
            if b - a > 1e-6 and d - c > 1e-6:
                # A fixed scramble of (row, column): planks differ, runs do not.
                shade = ((row * 73856093) ^ (column * 19349663)) % 9 / 4 - 1
                out.append((np.array([[a, c], [b, c], [b, d], [a, d]]), shade))
    return out


def shaded(colour: tuple[float, float, float], factor: float) -> tuple[float, float, float]:
    """Scale a colour, within [0, 1]."""
    red, green, blue = (min(1.0, v * factor) for v in colour)
    return red, green, blue
