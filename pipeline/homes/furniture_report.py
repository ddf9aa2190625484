"""What was asked of a home's furniture beside what stands there."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from pipeline import taxonomy
from pipeline.floorplan.program.floor_program import FloorProgram, Furniture, RoomReq
from pipeline.floorplan.program.furniture import LAID, matching_categories, plain
from pipeline.homes.room_finishing import bounds_in_words
from pipeline.homes.rows import BEST


@dataclass(frozen=True, slots=True)
class Delivery:
    """One wish: the room, what it is about, what was asked, what is there, whether it is met (None: a preference)."""

    room: str
    what: str
    asked: str
    delivered: str
    met: bool | None


def deliveries(program: FloorProgram, rows: Mapping[str, Sequence[Mapping[str, Any]]], styles: Mapping[str, str]) -> list[Delivery]:
    """Compare a program with the rows of a finished home, and name rooms that ship though their tries failed; `styles` gives the style of each asset, "" where it is unknown."""
    measured = {row["room_id"]: row for row in rows["rooms"]}
    pieces = set(taxonomy.load().names)  # what lies on or in furniture is no piece of it
    entries: list[Delivery] = []
    home = program.furniture
    if home.least is not None or home.most is not None:
        there = sum(o["category"] in pieces for o in rows["objects"])
        entries.append(_delivery("(home)", "pieces", home.least or 0, home.most, there))
    for room in program.rooms:
        wish = room.furniture
        if wish != Furniture() and room.id in measured:
            objects = [o for o in rows["objects"] if o["room_id"] == room.id and o["category"] in pieces | LAID]
            entries += _room(room, wish, measured[room.id], objects, styles)
    lacking = ((row["where"].rpartition("/")[2].partition("#")[0], row["detail"]) for row in rows["rejects"] if row["reason"] == BEST)
    return entries + [Delivery(room, "what makes the room", "unasked", detail, met=False) for room, detail in lacking]


def report(entries: Sequence[Delivery]) -> str:
    """Return the deliveries as a table, "" where nothing was asked."""
    if not entries:
        return ""
    marks = {True: "yes", False: "NO", None: ""}
    rows = [("room", "furniture", "asked", "delivered", "met"), *((d.room, d.what, d.asked, d.delivered, marks[d.met]) for d in entries)]
    wide = [max(len(row[k]) for row in rows) + 2 for k in range(5)]
    return "\n".join("".join(cell.ljust(w) for cell, w in zip(row, wide, strict=True)).rstrip() for row in rows) + "\n"


def _room(
    room: RoomReq, wish: Furniture, row: Mapping[str, Any], objects: Sequence[Mapping[str, Any]], styles: Mapping[str, str]
) -> list[Delivery]:
    entries: list[Delivery] = []
    if wish.least is not None or wish.most is not None:
        entries.append(_delivery(room.id, "pieces", wish.least or 0, wish.most, sum(o["category"] not in LAID for o in objects)))
    for things in wish.counts:
        have = sum(o["category"] in matching_categories(things, room.type) for o in objects)
        entries.append(_delivery(room.id, plain(things.category), things.min, things.max, have))
    if wish.openable is not None:
        entries.append(_delivery(room.id, "that open", wish.openable, None, int(row["openable"])))
    if wish.walkable is not None:
        free = float(row["walkable_free"])
        entries.append(Delivery(room.id, "free floor", f"{wish.walkable:.0%}", f"{free:.0%}", free >= wish.walkable - 0.005))
    if wish.style is not None:
        known = [styles[o["asset_id"]] for o in objects if styles.get(o["asset_id"]) and o["category"] not in LAID]
        text = f"{sum(s == wish.style for s in known)} of {len(known)} with a style" if known else "nothing has a style"
        entries.append(Delivery(room.id, "style", wish.style, text, None))
    return entries


def _delivery(room: str, what: str, least: int, most: int | None, have: int) -> Delivery:
    return Delivery(room, what, bounds_in_words(least, most), str(have), least <= have and (most is None or have <= most))
