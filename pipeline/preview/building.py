"""The building as the top view shows it: patterned floors, walls cut through, windows in them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from shapely.geometry import Polygon

from pipeline import taxonomy
from pipeline.entities.asset import Material
from pipeline.entities.home import Placement
from pipeline.entities.plan import Plan
from pipeline.geometry.stairs import visible_steps
from pipeline.geometry.walls import Shell, floor_pieces
from pipeline.rendering import palette

WALL = (0.20, 0.21, 0.24)
WINDOW = (0.62, 0.76, 0.86)
WALL_TOP = 2.4  # depth at which cut walls are drawn: above furniture [m]
WOOD = frozenset(palette.FLOORS[name].name for name in ("oak", "light_oak", "walnut"))
PLANK = (1.35, 0.19)  # length, width [m]
TILE = (0.45, 0.45)
GRAIN = 0.03  # how much planks and tiles differ
STEP_GRAIN = 0.08  # how much a step differs from the next
PALENESS = 0.42  # floors are mixed with white, so that furniture stands out


@dataclass(frozen=True, slots=True)
class Triangles:
    """Coloured triangles: `faces` (T, 3, 3) [m], `colours` (T, 3) sRGB, `items` (T,): 0 for the building."""

    faces: NDArray[np.float64]
    colours: NDArray[np.float32]
    items: NDArray[np.int32]


def building(plan: Plan, level: int, shell: Shell) -> Triangles:
    """Return one storey's floors, thresholds, cut walls and windows as triangles; heights above the storey's floor."""
    paved = [
        _floor_triangles(piece, palette.floor(room.type)) for room in plan.rooms if room.level == level for piece in floor_pieces(room)
    ]
    quads: list[tuple[NDArray[np.float64], tuple[float, float, float], float]] = []
    parts = sum(len(faces) for faces, _ in paved)
    for step in visible_steps(plan, level):
        grey = np.interp(step.top, (-plan.storey_height, 0.0, plan.storey_height), (0.45, 0.95, 1.05))
        odd = (parts + len(quads)) % 2
        quads.append((step.polygon, scale_colour(lighten(palette.STEP), float(grey) + STEP_GRAIN * odd), min(step.top, WALL_TOP - 0.1)))
    for cut in shell.cuts:
        walled = cut.bottom > 0.05 or cut.opening.kind == "window"
        quads.append((cut.quad, WINDOW, WALL_TOP) if walled else (cut.quad, lighten(palette.threshold(plan, cut.opening)), 0.0))
    quads.extend((prism.polygon, WALL, WALL_TOP) for prism in shell.prisms if prism.kind == "wall")
    for ring, colour, z in quads:
        faces = fans(ring[None], z)
        paved.append((faces, np.tile(np.array(colour, np.float32), (len(faces), 1))))
    faces, colours = (np.concatenate(column) for column in zip(*paved, strict=True))
    return Triangles(faces, colours, np.zeros(len(faces), np.int32))


def is_hanging(placement: Placement) -> bool:
    """Whether a thing hangs under the ceiling, which views from above leave off."""
    known = taxonomy.load().categories.get(placement.category)
    return known is not None and known.mount == "ceiling"


def _floor_triangles(piece: NDArray[np.float64], material: Material) -> tuple[NDArray[np.float64], NDArray[np.float32]]:
    """Return a piece of floor as triangles (T, 3, 3) and their colours (T, 3)."""
    rings, shades = pattern(piece, material)
    colours = np.minimum(1.0, np.array(lighten(material)) * (1 + GRAIN * shades[:, None])).astype(np.float32)
    return fans(rings, 0.0), np.repeat(colours, rings.shape[1] - 2, axis=0)


def fans(rings: NDArray[np.float64], height: float) -> NDArray[np.float64]:
    """Triangulate convex rings (K, n, 2) at a height [m]: triangles (K (n - 2), 3, 3), n - 2 for each, in their order."""
    points = np.full((*rings.shape[:2], 3), height)
    points[..., :2] = rings
    corners = [(0, k, k + 1) for k in range(1, rings.shape[1] - 1)]
    return points[:, corners].reshape(-1, 3, 3)


def lighten(material: Material) -> tuple[float, float, float]:
    """Return the display colour of a floor material."""
    red, green, blue = ((1 - PALENESS) * c + PALENESS for c in palette.display(np.array(material.base_color)).tolist())
    return red, green, blue


def pattern(piece: NDArray[np.float64], material: Material) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Cut an axis-parallel rectangle into planks or tiles: rings (K, n, 2) and their shades (K,) in [-1, 1]; other shapes stay whole."""
    (x0, y0), (x1, y1) = piece.min(axis=0), piece.max(axis=0)
    rectangle = len(piece) == 4 and abs((x1 - x0) * (y1 - y0) - Polygon(piece).area) < 1e-6
    if not rectangle or material.name == palette.FLOORS["concrete"].name:
        return piece[None], np.zeros(1)
    length, width = PLANK if material.name in WOOD else TILE
    rows = np.arange(int(np.floor(y0 / width)), int(np.ceil(y1 / width)))[:, None]
    shift = length * ((rows * 7) % 5) / 5 if material.name in WOOD else np.zeros((len(rows), 1))
    columns = np.arange(int(np.floor((x0 - length) / length)), int(np.ceil(x1 / length)))[None]
    a, b = np.maximum(x0, columns * length + shift), np.minimum(x1, (columns + 1) * length + shift)
    c, d = (v + np.zeros_like(a) for v in (np.maximum(y0, rows * width), np.minimum(y1, (rows + 1) * width)))
    # A fixed scramble of (row, column): planks differ, runs do not.
    shades = ((rows * 73856093) ^ (columns * 19349663)) % 9 / 4 - 1
    real = (b - a > 1e-6) & (d - c > 1e-6)
    return np.stack([a, c, b, c, b, d, a, d], axis=-1)[real].reshape(-1, 4, 2), shades[real]


def scale_colour(colour: tuple[float, float, float], factor: float) -> tuple[float, float, float]:
    """Scale a colour, within [0, 1]."""
    red, green, blue = (min(1.0, v * factor) for v in colour)
    return red, green, blue
