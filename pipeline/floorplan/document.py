"""The plan as a JSON document, and back. Metres to 0.1 mm, radians, m2; version 1."""

from __future__ import annotations

from typing import Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from pipeline.entities.plan import Opening, OpeningKind, Plan, Room, Swing
from pipeline.errors import ContentError, RefusedError
from pipeline.floorplan.program import FloorProgram

VERSION = 1


def plan_json(plan: Plan, program: FloorProgram | None = None) -> dict[str, Any]:
    """Return the plan as the documented, versioned JSON object."""
    stairs = {r.room_id for r in plan.rooms if r.type == "staircase"}
    top = max((r.level for r in plan.rooms), default=0)
    return {
        "version": VERSION,
        "rooms": [
            {
                "id": r.room_id,
                "type": r.type,
                "role": r.role,
                "level": r.level,
                "levels": list(range(top + 1)) if r.room_id in stairs else [r.level],
                "height": r.height,
                "area": round(r.area, 4),
                "polygon": np.round(r.polygon, 4).tolist(),
            }
            for r in plan.rooms
        ],
        "openings": [
            {
                "id": o.opening_id,
                "kind": o.kind,
                "rooms": list(o.rooms),
                "segment": np.round(o.segment, 4).tolist(),
                "width": round(o.width, 4),
                "height": o.height,
                "sill": o.sill,
                "swing": None if o.swing is None else {"room": o.swing.room_id, "hinge": o.swing.hinge, "angle": o.swing.angle},
                "level": o.level,
            }
            for o in plan.openings
        ],
        "entrance": plan.entrance,
        "inner_wall": plan.inner_wall,
        "outer_wall": plan.outer_wall,
        "storey_height": plan.storey_height,
        "program": None if program is None else program.model_dump(mode="json"),
        "refused": None,
    }


def refusal_json(error: RefusedError) -> dict[str, Any]:
    """Return the document that stands for a plan that was refused."""
    clashes = [{"text": c.text, "start": c.start, "end": c.end} for c in getattr(error, "clashes", ())]
    refused = {"code": "refused", "message": str(error), "clashes": clashes}
    return {"version": VERSION, "rooms": [], "openings": [], "entrance": None, "program": None, "refused": refused}


class _Loose(BaseModel):
    model_config = ConfigDict(extra="ignore", frozen=True, allow_inf_nan=False)


class _Room(_Loose):
    id: str
    type: str
    polygon: list[tuple[float, float]] = Field(min_length=3, max_length=400)
    role: str = ""
    level: int = 0
    height: float = 2.7


class _Swing(_Loose):
    room: str
    hinge: int = Field(ge=0, le=1)
    angle: float = Field(gt=0.0, le=3.15)


class _Opening(_Loose):
    id: str
    kind: OpeningKind
    rooms: list[str] = Field(min_length=1, max_length=2)
    segment: tuple[tuple[float, float], tuple[float, float]]
    height: float
    sill: float = 0.0
    swing: _Swing | None = None
    level: int = 0


class _Document(_Loose):
    version: int
    rooms: list[_Room] = Field(min_length=1)
    openings: list[_Opening]
    entrance: str
    inner_wall: float = 0.12
    outer_wall: float = 0.24
    storey_height: float = 3.0


def plan_from_json(document: object) -> Plan:
    """Return the plan of a document that `plan_json` made. Raises ContentError naming the field that is wrong."""
    try:
        read = _Document.model_validate(document)
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"])
        raise ContentError(f"plan document: {where}: {first['msg']}", "see docs/floorplan.md for the format") from error
    if read.version != VERSION:
        raise ContentError(f"plan document of version {read.version}", f"this sfgen reads version {VERSION}")
    names = {r.id for r in read.rooms}
    unknown = ({read.entrance} | {name for o in read.openings for name in o.rooms}) - names
    if unknown:
        raise ContentError(f"plan document names the unknown room {min(unknown)!r}", f"rooms are {', '.join(sorted(names))}")
    rooms = tuple(Room(r.id, r.type, np.array(r.polygon, dtype=float), r.level, r.height, r.role) for r in read.rooms)
    openings = tuple(
        Opening(
            o.id,
            o.kind,
            tuple(o.rooms),
            np.array(o.segment, dtype=float),
            o.height,
            o.sill,
            None if o.swing is None else Swing(o.swing.room, o.swing.hinge, o.swing.angle),
            o.level,
        )
        for o in read.openings
    )
    return Plan(rooms, openings, read.entrance, read.inner_wall, read.outer_wall, read.storey_height)
