"""Lights: a dome for the sky, a flat lamp under every ceiling."""

from __future__ import annotations

import numpy as np
from pxr import Gf, Sdf
from shapely.geometry import Polygon

from pipeline.entities.plan import Room
from pipeline.usd.layer import attribute, place, prim

DOME_INTENSITY = 600.0
LAMP_INTENSITY = 4000.0
LAMP_GAP = 0.03  # below the ceiling [m]


def convert_dome(parent: Sdf.PrimSpec) -> Sdf.PrimSpec:
    """Write the sky."""
    spec = prim(parent, "Sky", "DomeLight")
    attribute(spec, "inputs:intensity", "float", DOME_INTENSITY)
    attribute(spec, "inputs:color", "color3f", Gf.Vec3f(0.86, 0.92, 1.0))
    return spec


def convert_lamp(parent: Sdf.PrimSpec, room: Room, elevation: float) -> Sdf.PrimSpec:
    """Write a room's lamp, a square just below the ceiling that shines down (-Z, as rect lights do); larger rooms get more light."""
    spec = prim(parent, room.room_id, "RectLight")
    x, y = np.asarray(_inside(Polygon(room.polygon)))
    place(spec, (x, y, elevation + room.height - LAMP_GAP))
    side = float(np.clip(0.16 * np.sqrt(room.area), 0.25, 0.9))
    attribute(spec, "inputs:width", "float", side)
    attribute(spec, "inputs:height", "float", side)
    attribute(spec, "inputs:intensity", "float", LAMP_INTENSITY)
    attribute(spec, "inputs:color", "color3f", Gf.Vec3f(1.0, 0.93, 0.82))
    return spec


def _inside(polygon: Polygon) -> tuple[float, float]:
    """Return the centroid, or where that lies outside (L-shaped rooms) a point well inside."""
    point = polygon.centroid if polygon.buffer(-0.3).contains(polygon.centroid) else polygon.representative_point()
    return float(point.x), float(point.y)
