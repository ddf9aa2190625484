"""Lights: a dome for the sky, a flat lamp under every ceiling."""

from __future__ import annotations

import functools

import numpy as np
from pxr import Gf, Sdf
from shapely.geometry import Polygon

from pipeline.entities.plan import Room
from pipeline.usd.layer import attribute, prim
from pipeline.usd.text import cast, mould, placed

DOME_INTENSITY = 600.0
LAMP_INTENSITY = 4000.0
LAMP_GAP = 0.03  # below the ceiling [m]


@functools.cache
def sky() -> str:
    """Return the mould of the sky."""

    def convert(layer: Sdf.Layer) -> None:
        spec = prim(layer, "Mould", "DomeLight")
        attribute(spec, "inputs:intensity", "float", DOME_INTENSITY)
        attribute(spec, "inputs:color", "color3f", Gf.Vec3f(0.86, 0.92, 1.0))

    return mould(convert)


def lamp(path: str, room: Room, elevation: float) -> str:
    """Return a room's lamp, a square just below the ceiling that shines down (-Z, as rect lights do); larger rooms get more light."""
    x, y = _inside(Polygon(room.polygon))
    side = float(np.clip(0.16 * np.sqrt(room.area), 0.25, 0.9))
    size = f"float inputs:width = {side!r}\nfloat inputs:height = {side!r}\n"
    return cast(_lamp(), path, placed((x, y, elevation + room.height - LAMP_GAP)) + size)


@functools.cache
def _lamp() -> str:
    def convert(layer: Sdf.Layer) -> None:
        spec = prim(layer, "Mould", "RectLight")
        attribute(spec, "inputs:intensity", "float", LAMP_INTENSITY)
        attribute(spec, "inputs:color", "color3f", Gf.Vec3f(1.0, 0.93, 0.82))

    return mould(convert)


def _inside(polygon: Polygon) -> tuple[float, float]:
    """Return the centroid, or where that lies outside (L-shaped rooms) a point well inside."""
    point = polygon.centroid if polygon.buffer(-0.3).contains(polygon.centroid) else polygon.representative_point()
    return float(point.x), float(point.y)
