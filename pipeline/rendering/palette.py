"""Colours of room types and of the building, linear RGB; what USD, previews and path-traced views agree on."""

from collections.abc import Iterable
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from pipeline import taxonomy
from pipeline.entities.asset import Material
from pipeline.entities.plan import Opening, Plan

Number = TypeVar("Number", np.float32, np.float64)

Look = tuple[str, tuple[float, float, float], float]  # name, linear colour, roughness


def _materials(title: str, looks: Iterable[Look]) -> dict[str, Material]:
    return {name: Material(title.format(name), color, roughness) for name, color, roughness in looks}


FLOORS = _materials(
    "{}_floor",
    (
        ("oak", (0.42, 0.27, 0.15), 0.45),
        ("light_oak", (0.55, 0.40, 0.25), 0.5),
        ("walnut", (0.24, 0.14, 0.08), 0.4),
        ("tile", (0.52, 0.55, 0.56), 0.25),
        ("slate", (0.25, 0.27, 0.29), 0.35),
        ("stone", (0.48, 0.44, 0.38), 0.4),
        ("concrete", (0.36, 0.36, 0.35), 0.7),
    ),
)
WALLS = _materials(
    "wall_{}",
    (
        ("bedroom", (0.70, 0.74, 0.78), 0.9),
        ("kids_room", (0.72, 0.80, 0.72), 0.9),
        ("kitchen", (0.82, 0.78, 0.66), 0.7),
        ("bathroom", (0.68, 0.80, 0.84), 0.3),
        ("study", (0.66, 0.70, 0.62), 0.9),
        ("plaster", (0.83, 0.81, 0.77), 0.9),
    ),
)
OAK, PLASTER = FLOORS["oak"], WALLS["plaster"]
STEP = Material("step", (0.50, 0.36, 0.22), 0.5)
FACADE = Material("facade", (0.62, 0.58, 0.52), 0.95)
CEILING = Material("ceiling", (0.88, 0.88, 0.86), 0.95)
JAMB = Material("jamb", (0.80, 0.79, 0.76), 0.6)
LEAF = Material("door_leaf", (0.58, 0.42, 0.27), 0.5)
ENTRANCE_LEAF = Material("entrance_leaf", (0.16, 0.20, 0.22), 0.4)
METAL = Material("handle_metal", (0.60, 0.60, 0.58), 0.25, 1.0)
WINDOW_FRAME = Material("window_frame", (0.86, 0.86, 0.86), 0.4)
GLASS = Material("window_glass", (0.85, 0.93, 0.95), 0.02, 0.0, 0.18)


def floor(room_type: str) -> Material:
    """Return the floor of a type of room; oak where nothing else is usual."""
    return FLOORS[taxonomy.load().types[room_type].floor] if room_type in taxonomy.load().types else OAK


def threshold(plan: Plan, opening: Opening) -> Material:
    """Return the floor between the two sides of an opening: that of the first room it joins."""
    types = {room.room_id: room.type for room in plan.rooms}
    return floor(types.get(opening.rooms[0], "")) if opening.rooms else OAK


def wall(room_type: str) -> Material:
    """Return the walls' material of a type of room."""
    return WALLS[taxonomy.load().types[room_type].wall] if room_type in taxonomy.load().types else PLASTER


def display(linear: NDArray[Number]) -> NDArray[Number]:
    """Encode linear values from 0 to 1 as sRGB (IEC 61966-2-1)."""
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-6) ** (1 / 2.4) - 0.055)
