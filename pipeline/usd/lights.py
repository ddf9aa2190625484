"""Lights: a dome for the sky, a flat lamp under every ceiling."""

import functools

import numpy as np
from pxr import Gf, Sdf
from shapely.geometry import Polygon

from pipeline.entities.plan import Room
from pipeline.usd.layer import attribute, prim
from pipeline.usd.prim_templates import instantiate, template_of, transform_ops

DOME_INTENSITY = 600.0
LAMP_INTENSITY = 4000.0
LAMP_GAP = 0.03  # below the ceiling [m]


def sky() -> str:
    """Return the template of the sky."""
    return _light("DomeLight", DOME_INTENSITY, (0.86, 0.92, 1.0))


def lamp(path: str, room: Room, elevation: float) -> str:
    """Return a room's lamp, a square just below the ceiling that shines down (-Z, as rect lights do); larger rooms get more light."""
    x, y = _inside(Polygon(room.polygon))
    side = float(np.clip(0.16 * np.sqrt(room.area), 0.25, 0.9))
    size = f"float inputs:width = {side!r}\nfloat inputs:height = {side!r}\n"
    where = transform_ops((x, y, elevation + room.height - LAMP_GAP))
    return instantiate(_light("RectLight", LAMP_INTENSITY, (1.0, 0.93, 0.82)), path, where + size)


@functools.cache
def _light(kind: str, intensity: float, colour: tuple[float, float, float]) -> str:
    """Return the template of a light of a USD type."""

    def convert(layer: Sdf.Layer) -> None:
        spec = prim(layer, "Template", kind)
        attribute(spec, "inputs:intensity", "float", intensity)
        attribute(spec, "inputs:color", "color3f", Gf.Vec3f(*colour))

    return template_of(convert)


def _inside(polygon: Polygon) -> tuple[float, float]:
    """Return the centroid, or where that lies outside (L-shaped rooms) a point well inside."""
    point = polygon.centroid if polygon.buffer(-0.3).contains(polygon.centroid) else polygon.representative_point()
    return float(point.x), float(point.y)
