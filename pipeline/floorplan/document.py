"""The plan as a JSON document, and back. Lengths in metres to 1 mm, angles in radians, areas in m2; version 1.

`document_schema` exports the format as JSON Schema; docs/floorplan.md describes it.
"""

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, ValidationError

from pipeline.entities.plan import Opening, OpeningKind, Plan, Room, Swing
from pipeline.errors import ContentError, RefusedError
from pipeline.floorplan.program.floor_program import FloorProgram, Model

VERSION = 1
MM = 3  # decimals

Point = tuple[float, float]


class RoomDocument(Model):
    """A room between its inner wall faces. A staircase is one room with its lowest `level` and all `levels`."""

    id: str
    type: str
    role: str = ""
    functions: tuple[str, ...] = ()
    level: Annotated[int, Field(ge=0, description="storey, from 0")] = 0
    levels: tuple[int, ...] = ()
    height: Annotated[float, Field(gt=0.0, description="floor to ceiling [m]")] = 2.7
    area: Annotated[float, Field(gt=0.0, description="area of the polygon [m2]")]
    polygon: Annotated[
        list[Point],
        Field(min_length=3, max_length=400, description="inner wall faces [m], counter-clockwise, not closed, no collinear vertex"),
    ]


class SwingDocument(Model):
    """How a leaf turns: into `room`, about end `hinge` of the segment, by up to `angle` [rad]."""

    room: str
    hinge: Literal[0, 1]
    angle: Annotated[float, Field(gt=0.0, le=3.15)]


class OpeningDocument(Model):
    """A hole in a wall; `rooms` are two, or one where the other side is outside."""

    id: str
    kind: OpeningKind
    rooms: Annotated[list[str], Field(min_length=1, max_length=2)]
    segment: Annotated[tuple[Point, Point], Field(description="the clear width on the wall's centre line [m]")]
    width: Annotated[float, Field(gt=0.0, description="clear width [m]")]
    height: Annotated[float, Field(gt=0.0, description="clear height [m]")]
    sill: Annotated[float, Field(ge=0.0, description="its bottom above the floor [m]")] = 0.0
    swing: SwingDocument | None = None
    level: Annotated[int, Field(ge=0)] = 0


class RepairDocument(Model):
    """Something that was changed in a plan of the user's own."""

    code: str
    where: str
    text: str


class AssumedDocument(Model):
    """Something that the request left open and a default filled in; in `program` it is marked `stated: false`."""

    field: str
    text: str


class ClashDocument(Model):
    """Words of the prompt, [start, end) in characters."""

    text: str
    start: int
    end: int


class RefusedDocument(Model):
    """Why there is no plan: `impossible` (the words or the program exclude it), `own_plan`, `unsound` (a plan of the user's own), `refused` (else)."""

    code: Literal["impossible", "own_plan", "unsound", "refused"]
    message: str
    clashes: tuple[ClashDocument, ...] = ()


class PlanDocument(Model):
    """A floor plan, or why there is none: then `refused` is set and the lists are empty."""

    version: Literal[1] = 1
    rooms: list[RoomDocument]
    openings: list[OpeningDocument]
    entrance: Annotated[str | None, Field(description="the id of the room that one enters")]
    inner_wall: Annotated[float | None, Field(description="thickness [m]")] = None
    outer_wall: Annotated[float | None, Field(description="thickness [m]")] = None
    storey_height: Annotated[float | None, Field(description="floor to floor [m]")] = None
    program: FloorProgram | None = None
    repairs: tuple[RepairDocument, ...] = ()
    assumed: tuple[AssumedDocument, ...] = ()
    refused: RefusedDocument | None = None


def document_schema() -> dict[str, Any]:
    """Return the JSON Schema of the document, that of the program included."""
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **PlanDocument.model_json_schema()}


def plan_json(
    plan: Plan,
    program: FloorProgram | None = None,
    repairs: Sequence[Mapping[str, str]] = (),
    assumed: Sequence[Mapping[str, str]] = (),
) -> dict[str, Any]:
    """Return the plan as the documented, versioned JSON object; `assumed` as `assumptions` gives it."""
    stairs = {r.room_id for r in plan.rooms if r.type == "staircase"}
    top = max((r.level for r in plan.rooms), default=0)
    return {
        "version": VERSION,
        "rooms": [
            {
                "id": r.room_id,
                "type": r.type,
                "role": r.role,
                "functions": list(r.functions),
                "level": r.level,
                "levels": list(range(r.level, top + 1)) if r.room_id in stairs else [r.level],
                "height": round(r.height, MM),
                "area": round(r.area, 4),
                "polygon": _round_points(r.polygon),
            }
            for r in plan.rooms
        ],
        "openings": [
            {
                "id": o.opening_id,
                "kind": o.kind,
                "rooms": list(o.rooms),
                "segment": _round_points(o.segment),
                "width": round(o.width, MM),
                "height": round(o.height, MM),
                "sill": round(o.sill, MM),
                "swing": None if o.swing is None else {"room": o.swing.room_id, "hinge": o.swing.hinge, "angle": o.swing.angle},
                "level": o.level,
            }
            for o in plan.openings
        ],
        "entrance": plan.entrance,
        "inner_wall": round(plan.inner_wall, MM),
        "outer_wall": round(plan.outer_wall, MM),
        "storey_height": round(plan.storey_height, MM),
        "program": None if program is None else program.model_dump(mode="json"),
        "repairs": [dict(r) for r in repairs],
        "assumed": [dict(a) for a in assumed],
        "refused": None,
    }


def _round_points(points: np.ndarray[Any, np.dtype[np.float64]]) -> list[list[float]]:
    return (np.round(points, MM) + 0.0).tolist()  # type: ignore[no-any-return]


def refusal_json(error: RefusedError) -> dict[str, Any]:
    """Return the document that stands for a plan that was refused."""
    clashes = [{"text": c.text, "start": c.start, "end": c.end} for c in getattr(error, "clashes", ())]
    refused = RefusedDocument.model_validate({"code": error.code, "message": str(error), "clashes": clashes})
    return PlanDocument(rooms=[], openings=[], entrance=None, refused=refused).model_dump(mode="json")


def plan_from_json(document: object) -> Plan:
    """Return the plan of a document that `plan_json` made. Raises ContentError naming the field that is wrong.

    What others wrote goes through `pipeline.floorplan.imports`, which checks that it can be built.
    """
    try:
        read = PlanDocument.model_validate(document)
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"])
        raise ContentError(f"plan document: {where}: {first['msg']}", "see docs/floorplan.md for the format") from error
    if not read.rooms or read.entrance is None:
        raise ContentError("plan document without rooms or entrance", "see docs/floorplan.md for the format")
    names = {r.id for r in read.rooms}
    unknown = ({read.entrance} | {name for o in read.openings for name in o.rooms}) - names
    if unknown:
        raise ContentError(f"plan document names the unknown room {min(unknown)!r}", f"rooms are {', '.join(sorted(names))}")
    rooms = tuple(
        Room(r.id, r.type, np.array(r.polygon, dtype=float), r.level, r.height, r.role, functions=r.functions) for r in read.rooms
    )
    swings = [None if o.swing is None else Swing(o.swing.room, o.swing.hinge, o.swing.angle) for o in read.openings]
    openings = tuple(
        Opening(o.id, o.kind, tuple(o.rooms), np.array(o.segment, dtype=float), o.height, o.sill, swing, o.level)
        for o, swing in zip(read.openings, swings, strict=True)
    )
    return Plan(rooms, openings, read.entrance, read.inner_wall or 0.12, read.outer_wall or 0.24, read.storey_height or 3.0)
