"""The furniture of a 3D-FRONT house put into its rooms: each piece in the room in which it lies, or a reason why in none."""

from collections import Counter
from dataclasses import replace
from typing import Any

import numpy as np

from pipeline import taxonomy
from pipeline.sources.reasons import Row, SourceError, reject
from pipeline.sources.settings import FrontFilters
from pipeline.sources.source import Task
from pipeline.sources.threed_front.clearing import move_apart
from pipeline.sources.threed_front.furniture import Placed, find_overlaps, hangs_in_air, place_furniture, share_inside, supports
from pipeline.sources.threed_front.house_file import HouseFile, RoomRecord
from pipeline.sources.threed_front.house_rows import ReadRoom

MAX_OBJECTS = 500  # of one room
HALF = 0.4  # share of a footprint in a room, from which on a piece is moved into it


def fill(house: HouseFile, rooms: list[ReadRoom], task: Task, rejects: list[Row]) -> None:
    """Give each room its objects; every child that is left out gets a reason, dangling and built-in ones by the room."""
    limits = task.reading.settings.filters
    own, guests = ({room.room_id: list[Placed]() for room in rooms} for _ in range(2))
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
            outcome = place_furniture(child, furniture, task.known, taxonomy.load(), limits)
            if isinstance(outcome, tuple):
                rejects.append(reject("object", name, *outcome))
            elif (home := _home(outcome, room, rooms, limits)) is None:
                rejects.append(reject("object", name, "outside_room", _outside(outcome, room, record)))
            elif home is room:
                own[home.room_id].append(outcome)
            else:
                note = ("other_room", f"filed under {record.instance or record.type}, lies in {home.record.instance}")
                guests[home.room_id].append(replace(outcome, notes=(*outcome.notes, note), filed=record.instance))
        rejects += [reject("room", where, k, f"{count[k]} of {len(record.children)} children") for k in sorted(count) if count[k]]
    placed_ones = {child.ref for record in house.rooms for child in record.children}
    missing = ((uid, r) for uid, r in house.furniture.items() if r.valid is not None and uid not in placed_ones)
    rejects += [reject("object", f"{house.uid}/{uid}", "not_placed", f"model {r.jid}") for uid, r in missing]
    for room in rooms:
        _keep(house.uid, room, [*own[room.room_id], *guests[room.room_id]], limits, rejects)


def _home(piece: Placed, room: ReadRoom | None, rooms: list[ReadRoom], limits: FrontFilters) -> ReadRoom | None:
    """Return the room in which a piece lies: its own, else the one that holds most of it, None where it is in none.

    Where pieces are moved out of walls, one that is half in a wall lies in the room that holds most of it.
    """
    shares = ((share_inside(piece, r.polygon), r) for r in rooms)
    ordered = sorted(shares, key=lambda there: (there[1] is not room, -there[0]))
    within = next((r for share, r in ordered if share >= limits.min_inside), None)
    if within is not None or not limits.max_shift:
        return within
    share, most = max(ordered, key=lambda there: there[0], default=(0.0, None))
    return most if share >= HALF else None


def _outside(piece: Placed, room: ReadRoom | None, record: RoomRecord) -> str:
    if room is None:
        return f"{record.instance or record.type} was left out, and it lies in no other room"
    return f"{share_inside(piece, room.polygon):.0%} of the footprint inside"


def _keep(uid: str, room: ReadRoom, candidates: list[Placed], limits: FrontFilters, rejects: list[Row]) -> None:
    """Give a room what lies in it, but for what lies in each other and what hangs in the air."""
    where, words = f"{uid}/{room.record.instance}", taxonomy.load()

    def refuse(piece: Placed, reason: str, detail: str = "") -> None:
        rejects.append(reject("object", f"{uid}/{piece.filed or room.record.instance}/{piece.child.instance}", reason, detail))

    if len(candidates) > MAX_OBJECTS:
        raise SourceError("too_large", where, f"{len(candidates)} objects in {where}")
    if limits.max_shift:
        moved, candidates = move_apart(candidates, room.polygon, words, limits.max_shift), []
        for piece in moved:
            if share_inside(piece, room.polygon) < limits.min_inside:
                refuse(piece, "outside_room", _outside(piece, room, room.record))
            else:
                candidates.append(piece)
    dropped = find_overlaps(candidates, limits, words)
    for i, piece in enumerate(candidates):
        if i in dropped:
            j, share = dropped[i]
            refuse(piece, "overlap", f"{piece.category} has {share:.0%} in {candidates[j].category} {candidates[j].child.instance}")
            continue
        for note in piece.notes:
            refuse(piece, *note)
        room.objects.append(piece)
    room.supports = supports(room.objects, words)
    while any(lost := [hangs_in_air(o, on, words) for o, on in zip(room.objects, room.supports, strict=True)]):
        for piece, gone in zip(room.objects, lost, strict=True):
            if gone:  # a small thing whose support was left out
                refuse(piece, "no_support")
        room.objects = [o for o, gone in zip(room.objects, lost, strict=True) if not gone]
        room.supports = supports(room.objects, words)
