"""PartNet-Mobility's mobility_v2.json: what a joint is where the URDF does not say.

A list of {id, parent, joint, name, jointData}; entry k is link_k of the URDF. Degrees for hinges, the mesh's units for
sliders; the direction is along the mesh's axes, as the URDF's axes are; b may be less than a.
"""

import math
from dataclasses import dataclass
from typing import Any

from pipeline.arrays import Floats
from pipeline.sources.articulated.part_classes import text_field
from pipeline.sources.guarded import MIB, Folder, finite_array, read_json

NAME = "mobility_v2.json"


@dataclass(frozen=True, slots=True)
class Mobility:
    """One entry: PartNet's word for the joint and the part, the axis, limits [rad or units] about it, and freedoms."""

    joint: str
    name: str
    direction: Floats | None
    limits: tuple[float, float] | None
    free: bool  # no limit
    turns: bool  # a slider that turns as well: a screw


def mobility(folder: Folder) -> dict[str, Mobility]:
    """Return {link: entry}, {} where there is no such file; entries that make no sense are left out."""
    if not folder.has(NAME):
        return {}
    tree = read_json(folder, NAME, 16 * MIB)
    entries = tree if isinstance(tree, list) else []
    return {f"link_{e['id']}": _entry(e) for e in entries if isinstance(e, dict) and type(e.get("id")) is int}


def _entry(entry: dict[str, Any]) -> Mobility:
    joint, data = text_field(entry, "joint"), entry.get("jointData")
    data = data if isinstance(data, dict) else {}
    axis, limit = data.get("axis"), data.get("limit")
    direction = finite_array(axis.get("direction"), 3) if isinstance(axis, dict) else None
    limit = limit if isinstance(limit, dict) else {}
    ends = finite_array([limit.get("a"), limit.get("b")], 2)
    scale = math.pi / 180 if joint == "hinge" else 1.0
    limits = None if ends is None else (float(ends[0]) * scale, float(ends[1]) * scale)
    return Mobility(joint, text_field(entry, "name"), direction, limits, limit.get("noLimit") is True, limit.get("rotates") is True)
