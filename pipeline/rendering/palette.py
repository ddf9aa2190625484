"""Colours of room types and of the building, linear RGB; what USD, previews and path-traced views agree on."""

from __future__ import annotations

from types import MappingProxyType

from pipeline.entities.asset import Material
from pipeline.entities.plan import Opening, Plan

OAK = Material("oak_floor", (0.42, 0.27, 0.15), 0.45)
LIGHT_OAK = Material("light_oak_floor", (0.55, 0.40, 0.25), 0.5)
WALNUT = Material("walnut_floor", (0.24, 0.14, 0.08), 0.4)
TILE = Material("tile_floor", (0.52, 0.55, 0.56), 0.25)
SLATE = Material("slate_floor", (0.25, 0.27, 0.29), 0.35)
STONE = Material("stone_floor", (0.48, 0.44, 0.38), 0.4)
STEP = Material("step", (0.50, 0.36, 0.22), 0.5)
CONCRETE = Material("concrete_floor", (0.36, 0.36, 0.35), 0.7)

FLOORS = MappingProxyType(
    {
        "bedroom": LIGHT_OAK,
        "kids_room": LIGHT_OAK,
        "playroom": LIGHT_OAK,
        "studio_room": LIGHT_OAK,
        "kitchen": TILE,
        "bathroom": SLATE,
        "wc": SLATE,
        "hallway": STONE,
        "entry": STONE,
        "staircase": STONE,
        "office": WALNUT,
        "study": WALNUT,
        "library": WALNUT,
        "media_room": WALNUT,
        "balcony": CONCRETE,
        "garage": CONCRETE,
        "utility": CONCRETE,
        "workshop": CONCRETE,
        "storage": CONCRETE,
        "closet": LIGHT_OAK,
    }
)
WALLS = MappingProxyType(
    {
        "bedroom": Material("wall_bedroom", (0.70, 0.74, 0.78), 0.9),
        "kids_room": Material("wall_kids_room", (0.72, 0.80, 0.72), 0.9),
        "playroom": Material("wall_kids_room", (0.72, 0.80, 0.72), 0.9),
        "kitchen": Material("wall_kitchen", (0.82, 0.78, 0.66), 0.7),
        "bathroom": Material("wall_bathroom", (0.68, 0.80, 0.84), 0.3),
        "wc": Material("wall_bathroom", (0.68, 0.80, 0.84), 0.3),
        "office": Material("wall_study", (0.66, 0.70, 0.62), 0.9),
        "study": Material("wall_study", (0.66, 0.70, 0.62), 0.9),
    }
)
PLASTER = Material("wall_plaster", (0.83, 0.81, 0.77), 0.9)
FACADE = Material("facade", (0.62, 0.58, 0.52), 0.95)
CEILING = Material("ceiling", (0.88, 0.88, 0.86), 0.95)
JAMB = Material("jamb", (0.80, 0.79, 0.76), 0.6)
LEAF = Material("door_leaf", (0.58, 0.42, 0.27), 0.5)
ENTRANCE_LEAF = Material("entrance_leaf", (0.16, 0.20, 0.22), 0.4)
METAL = Material("handle_metal", (0.60, 0.60, 0.58), 0.25, 1.0)
WINDOW_FRAME = Material("window_frame", (0.86, 0.86, 0.86), 0.4)
GLASS = Material("window_glass", (0.85, 0.93, 0.95), 0.02, 0.0, 0.18)


def floor(room_type: str) -> Material:
    """Return the floor of a room type; oak where nothing else is usual."""
    return FLOORS.get(room_type, OAK)


def threshold(plan: Plan, opening: Opening) -> Material:
    """Return the floor between the two sides of an opening: that of the first room it joins."""
    types = {room.room_id: room.type for room in plan.rooms}
    return floor(types.get(opening.rooms[0], "")) if opening.rooms else OAK


def wall(room_type: str) -> Material:
    """Return the walls' material of a room type."""
    return WALLS.get(room_type, PLASTER)


def to_srgb(linear: tuple[float, float, float]) -> tuple[float, float, float]:
    """Encode linear RGB for display (IEC 61966-2-1)."""

    def encode(value: float) -> float:
        return 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055

    return encode(linear[0]), encode(linear[1]), encode(linear[2])
