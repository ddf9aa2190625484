"""The furniture of a 3D-FRONT house put into its rooms: each piece in the room in which it lies, or a reason why in none."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from pipeline.sources.reasons import Row, SourceError, reject
from pipeline.sources.settings import FrontFilters
from pipeline.sources.threed_front.clearing import clear
from pipeline.sources.threed_front.furniture import Model, Placed, inside, overlapping, place_furniture
from pipeline.sources.threed_front.house_file import HouseFile, RoomRecord
from pipeline.sources.threed_front.rows import ReadRoom
from pipeline.sources.threed_front.supports import floating, supports
from pipeline.taxonomy import Taxonomy

MAX_OBJECTS = 500  # of one room
HALF = 0.4  # share of a footprint in a room, from which on a piece is moved into it


@dataclass(slots=True)
class Candidates:
    """What lies in a room: its own children, then what is filed under others."""

    own: list[Placed] = field(default_factory=list)
    guests: list[Placed] = field(default_factory=list)


def fill(
    house: HouseFile, rooms: list[ReadRoom], models: Mapping[str, Model], taxonomy: Taxonomy, limits: FrontFilters, rejects: list[Row]
) -> None:
    """Give each room its objects; every child that is left out gets a reason, dangling and built-in ones by the room."""
    by_room = {room.room_id: Candidates() for room in rooms}
    mine = {id(room.record): room for room in rooms}
    seen: set[tuple[Any, ...]] = set()
    for record in house.rooms:
        room = mine.get(id(record))
        where = f"{house.uid}/{record.instance}"
        count: Counter[str] = Counter()
        for child in record.children:
            furniture = house.furniture.get(child.ref)
            if furniture is None or furniture.valid is None:
                kind = "built_in" if furniture else "dangling_ref"
                count[kind] += not furniture.title.startswith(("door/", "window/")) if furniture else child.ref not in house.meshes
                continue
            name = f"{where}/{child.instance}"
            pose = (child.replaced_by or furniture.jid, *np.round(child.position, 3).tolist(), *np.round(child.rotation, 3).tolist())
            if furniture.valid and pose in seen:
                rejects.append(reject("object", name, "duplicate", f"model {furniture.jid}"))
                continue
            seen.add(pose)
            outcome = place_furniture(child, furniture, models, taxonomy, limits)
            home = _home(outcome, room, rooms, limits) if isinstance(outcome, Placed) else None
            if isinstance(outcome, Placed) and home is not None:
                if home is room:
                    by_room[home.room_id].own.append(outcome)
                else:
                    by_room[home.room_id].guests.append(_move_to_room(outcome, record, home))
            else:
                reason = outcome if isinstance(outcome, tuple) else ("outside_room", _outside(outcome, room, record))
                rejects.append(reject("object", name, *reason))
        rejects += [reject("room", where, k, f"{count[k]} of {len(record.children)} children") for k in sorted(count) if count[k]]
    placed_ones = {child.ref for record in house.rooms for child in record.children}
    missing = ((uid, r) for uid, r in house.furniture.items() if r.valid is not None and uid not in placed_ones)
    rejects += [reject("object", f"{house.uid}/{uid}", "not_placed", f"model {r.jid}") for uid, r in missing]
    for room in rooms:
        _keep(house, room, by_room[room.room_id], taxonomy, limits, rejects)


def _home(piece: Placed, room: ReadRoom | None, rooms: list[ReadRoom], limits: FrontFilters) -> ReadRoom | None:
    """Return the room in which a piece lies: its own, else the one that holds most of it, None where it is in none.

    Where pieces are moved out of walls, one that is half in a wall lies in the room that holds most of it.
    """
    shares = ((inside(piece, r.polygon), r) for r in rooms)
    ordered = sorted(shares, key=lambda there: (there[1] is not room, -there[0]))
    within = next((r for share, r in ordered if share >= limits.min_inside), None)
    if within is not None or not limits.max_shift:
        return within
    share, most = max(ordered, key=lambda there: there[0], default=(0.0, None))
    return most if share >= HALF else None


def _move_to_room(piece: Placed, record: RoomRecord, home: ReadRoom) -> Placed:
    note = ("other_room", f"filed under {record.instance or record.type}, lies in {home.record.instance}")
    return replace(piece, notes=(*piece.notes, note), filed=record.instance)


def _outside(piece: Placed, room: ReadRoom | None, record: RoomRecord) -> str:
    if room is None:
        return f"{record.instance or record.type} was left out, and it lies in no other room"
    return f"{inside(piece, room.polygon):.0%} of the footprint inside"


def _keep(house: HouseFile, room: ReadRoom, contents: Candidates, taxonomy: Taxonomy, limits: FrontFilters, rejects: list[Row]) -> None:
    """Give a room what lies in it, but for what lies in each other and what hangs in the air."""
    where = f"{house.uid}/{room.record.instance}"
    candidates = [*contents.own, *contents.guests]
    if len(candidates) > MAX_OBJECTS:
        raise SourceError("too_large", where, f"{len(candidates)} objects in {where}")
    if limits.max_shift:
        candidates = clear(candidates, room.polygon, taxonomy, limits.max_shift)
        outside = [inside(piece, room.polygon) < limits.min_inside for piece in candidates]
        out = [piece for piece, beyond in zip(candidates, outside, strict=True) if beyond]
        rejects += [reject("object", _name(house, room, piece), "outside_room", _outside(piece, room, room.record)) for piece in out]
        candidates = [piece for piece, beyond in zip(candidates, outside, strict=True) if not beyond]
    dropped = overlapping(candidates, limits, taxonomy)
    for i, piece in enumerate(candidates):
        name = _name(house, room, piece)
        if i in dropped:
            j, share = dropped[i]
            detail = f"{piece.category} has {share:.0%} in {candidates[j].category} {candidates[j].child.instance}"
            rejects.append(reject("object", name, "overlap", detail))
            continue
        rejects.extend(reject("object", name, reason, detail) for reason, detail in piece.notes)
        room.objects.append(piece)
    _support(house, room, taxonomy, rejects)


def _name(house: HouseFile, room: ReadRoom, piece: Placed) -> str:
    """Return where the file has a piece."""
    return f"{house.uid}/{piece.filed or room.record.instance}/{piece.child.instance}"


def _support(house: HouseFile, room: ReadRoom, taxonomy: Taxonomy, rejects: list[Row]) -> None:
    """Find what the room's objects stand on; small things whose support was left out are left out as well."""
    bearers = supports(room.objects, taxonomy)
    while any(lost := [floating(o, on, taxonomy) for o, on in zip(room.objects, bearers, strict=True)]):
        rejects.extend(reject("object", _name(house, room, o), "no_support") for o, gone in zip(room.objects, lost, strict=True) if gone)
        room.objects = [o for o, gone in zip(room.objects, lost, strict=True) if not gone]
        bearers = supports(room.objects, taxonomy)
    room.supports = bearers
