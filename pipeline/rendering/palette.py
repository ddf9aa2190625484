"""Colours of room types and of the building, linear RGB; what USD, previews and path-traced views agree on."""

from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from pipeline import taxonomy, yaml_text
from pipeline.entities.asset import Material
from pipeline.entities.plan import Opening, Plan

Number = TypeVar("Number", np.float32, np.float64)

PATH = Path(__file__).resolve().parents[2] / "manifests" / "materials.yaml"
LOOKS = yaml_text.parse(PATH.read_text(encoding="utf-8"))


def _materials(section: str, title: str) -> dict[str, Material]:
    looks = LOOKS[section].items()
    return {name: Material(title.format(name), **{**look, "base_color": tuple(look["base_color"])}) for name, look in looks}


FLOORS, WALLS, FIXED = _materials("floors", "{}_floor"), _materials("walls", "wall_{}"), _materials("fixed", "{}")
OAK, PLASTER = FLOORS["oak"], WALLS["plaster"]
STEP, FACADE, CEILING, JAMB = (FIXED[name] for name in ("step", "facade", "ceiling", "jamb"))
LEAF, ENTRANCE_LEAF, METAL = (FIXED[name] for name in ("door_leaf", "entrance_leaf", "handle_metal"))
WINDOW_FRAME, GLASS = FIXED["window_frame"], FIXED["window_glass"]


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
