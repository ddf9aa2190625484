"""A plan in our own JSON, whole as `sfgen plan --json` writes it or in the short form, as a sketch."""

import json
from typing import Annotated, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from pipeline.entities.plan import OpeningKind, Swing
from pipeline.errors import ContentError
from pipeline.floorplan.imports.sketch import MAX_CORNERS, MAX_OPENINGS, MAX_ROOMS, Sketch, SketchOpening, SketchRoom, identifiers, refuse

FORMAT = "see docs/floorplan.md for the format"
VERSION = 1

Length = Annotated[float, Field(gt=0.0, lt=1e7)]
Number = Annotated[float, Field(gt=-1e9, lt=1e9)]
Point = tuple[Number, Number]
Text = Annotated[str, Field(max_length=200)]


class Loose(BaseModel):
    """Base of what is read: fields beyond ours are somebody else's, numbers are finite, nothing is cast from text."""

    model_config = ConfigDict(extra="ignore", frozen=True, allow_inf_nan=False, strict=True)


class RoomIn(Loose):
    """A room of the document."""

    type: Text
    polygon: Annotated[list[Point], Field(max_length=100_000)]
    id: Text = ""
    role: Text = ""
    functions: Annotated[list[Text], Field(max_length=10)] = []
    level: int = 0
    height: Length = 2.7


class SwingIn(Loose):
    """How a leaf turns."""

    room: Text
    hinge: Literal[0, 1]
    angle: Annotated[float, Field(gt=0.2, le=3.15)] = 1.5


class OpeningIn(Loose):
    """An opening of the document: `segment`, or `at` and `width`, or only `rooms`."""

    kind: OpeningKind | None = None
    id: Text = ""
    rooms: Annotated[list[Text], Field(max_length=2)] = []
    segment: tuple[Point, Point] | None = None
    at: Point | None = None
    width: Length | None = None
    height: Length | None = None
    sill: Annotated[float, Field(ge=0.0, lt=1e7)] | None = None
    swing: SwingIn | None = None
    level: int | None = None


class PlanIn(Loose):
    """The document. `openings` are all kinds; `doors` and `windows` are the short form."""

    rooms: list[RoomIn]
    version: int = VERSION
    units: Text = ""
    faces: Literal["inner", "centre", ""] = ""
    openings: list[OpeningIn] | None = None
    doors: list[OpeningIn] | None = None
    windows: list[OpeningIn] = []
    entrance: Text | None = None
    inner_wall: Length | None = None
    outer_wall: Length | None = None
    storey_height: Length | None = None


def native_sketch(document: object) -> Sketch:
    """Read the document. Raises ContentError naming the field that is wrong, RefusedError for counts that no home has."""
    if isinstance(document, dict) and isinstance(document.get("refused"), dict):
        raise refuse("the document is itself a refusal and holds no plan", "plan again with other words")
    try:
        read = PlanIn.model_validate_json(json.dumps(document))  # as JSON, whose lists are taken for tuples in strict mode
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"]) or "document"
        raise ContentError(f"plan document: {where}: {first['msg']}", FORMAT) from error
    except RecursionError as error:
        raise ContentError("plan document: it is nested too deeply", FORMAT) from error
    if read.version != VERSION:
        raise ContentError(f"plan document of version {read.version}", f"this sfgen reads version {VERSION}")
    entries = _openings(read)
    for count, most, what in ((len(read.rooms), MAX_ROOMS, "rooms"), (len(entries), MAX_OPENINGS, "openings")):
        if count > most:
            raise refuse(f"it has {count} {what}; at most {most} are read")
    if not read.rooms:
        raise refuse("it has no rooms")
    if any(len(r.polygon) > MAX_CORNERS for r in read.rooms):
        raise refuse(f"a room has more than {MAX_CORNERS} corners")
    ids = identifiers([r.id or r.type for r in read.rooms], "room")
    twice = {r.id for k, r in enumerate(read.rooms) if r.id and r.id in {x.id for x in read.rooms[:k]}}
    if twice:
        raise refuse(f"two rooms are called {min(twice)[:40]!r}", "give each room an id of its own")
    named = {room.id or name: name for room, name in zip(read.rooms, ids, strict=True)}
    rooms = [
        SketchRoom(name, r.type, np.array(r.polygon, float).reshape(-1, 2), r.level, r.height, r.role, tuple(r.functions))
        for name, r in zip(ids, read.rooms, strict=True)
    ]
    # the whole form states inner faces and metres; the short form is found out
    whole = read.openings is not None
    doors = "all" if whole or read.doors is not None else "none"
    sketch = Sketch(rooms, [], read.faces or ("inner" if whole else ""), doors, inner_wall=read.inner_wall, outer_wall=read.outer_wall)  # type: ignore[arg-type]
    sketch.storey_height, sketch.units = read.storey_height, read.units
    changed = [f"{r.id[:24]!r} is {name}" for r, name in zip(read.rooms, ids, strict=True) if r.id and r.id != name]
    if changed:
        sketch.repair("id", "plan", f"{len(changed)} ids are rewritten: {', '.join(changed[:4])}{' ...' if len(changed) > 4 else ''}")
    sketch.entrance = _room(read.entrance, named, "entrance") if read.entrance else ""
    for (entry, kind), name in zip(entries, identifiers([e.id or k for e, k in entries], "opening"), strict=True):
        sketch.openings.append(_opening(entry, kind, name, named, {r.room_id: r.level for r in rooms}))
    return sketch


def _openings(read: PlanIn) -> list[tuple[OpeningIn, OpeningKind]]:
    without = next((k for k, entry in enumerate(read.openings or ()) if entry.kind is None), None)
    if without is not None:
        raise ContentError(f"plan document: openings.{without}.kind: Field required", FORMAT)
    entries = [*(read.openings or ()), *(read.doors or ())]
    return [(entry, entry.kind or "door") for entry in entries] + [(entry, entry.kind or "window") for entry in read.windows]


def _opening(entry: OpeningIn, kind: OpeningKind, name: str, named: dict[str, str], levels: dict[str, int]) -> SketchOpening:
    rooms = tuple(dict.fromkeys(_room(r, named, name) for r in entry.rooms if r.strip().lower() not in {"outside", "exterior", ""}))
    swing = None if entry.swing is None else Swing(_room(entry.swing.room, named, name), entry.swing.hinge, entry.swing.angle)
    if entry.segment is None and entry.at is None and not rooms:
        raise ContentError(f"plan document: {name} has neither `segment` nor `at` nor `rooms`", FORMAT)
    level = entry.level if entry.level is not None else max((levels[r] for r in rooms), default=0)
    segment = None if entry.segment is None else np.array(entry.segment, float)
    at = None if entry.at is None else np.array(entry.at, float)
    return SketchOpening(name, kind, rooms, segment, at, entry.width, entry.height, entry.sill, swing, level)


def _room(said: str, named: dict[str, str], where: str) -> str:
    if said not in named:
        raise refuse(f"{where} names the unknown room {said[:40]!r}", f"rooms are {', '.join(sorted(named))[:200]}")
    return named[said]
