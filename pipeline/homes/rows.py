"""Homes as table rows and back."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields
from typing import Any

import numpy as np

from pipeline import taxonomy
from pipeline.entities.asset import Asset
from pipeline.entities.home import Home, Placement
from pipeline.entities.plan import Opening, Plan, Room, Swing
from pipeline.entities.reason import reasons
from pipeline.homes.furnish import Draft
from pipeline.homes.request import layout_type
from pipeline.manifest import sha256
from pipeline.verify import Certificate

Row = dict[str, Any]
REASONS = reasons("homes")  # why something was left out, exchanged or tried again while homes were made: the codes of `rejects`
BEST = "best_of_tries"  # the code of a room that ships though its tries failed

# What a table has of a record under the same names.
ROOM = ("room_id", "type", "role", "level", "height", "polygon")
OPENING = ("opening_id", "kind", "rooms", "segment", "height", "sill", "level")
PLACEMENT = tuple(f.name for f in fields(Placement))
PLAN = ("entrance", "inner_wall", "outer_wall", "storey_height")
HOME = ("scene_id", "index", "seed", "prompt", "program")
ARRAYS = {"position": np.float64, "size": np.float64, "scale": np.float64, "latent": np.float32}
UNJUDGED: Row = {"objects": 0, "openable": 0, "walkable_paper": 1.0, "walkable_free": 1.0}  # figures that only the judge knows


def _row(record: object, names: Sequence[str]) -> Row:
    """Return some fields of a record as a table takes them."""
    return {name: v.tolist() if isinstance(v := getattr(record, name), np.ndarray) else v for name in names}


def room_row(scene_id: str, room: Room, layout_type: str | None) -> Row:
    """Return a rooms row; the figures that only the judge knows are empty."""
    asked: Row = {"asked_objects": None, "openable_sampled": None, "walkable_target": None, "source_id": ""}
    own = {"scene_id": scene_id, "layout_type": layout_type or "", "area": round(room.area, 4)}
    return _row(room, ROOM) | own | UNJUDGED | asked


def opening_row(scene_id: str, opening: Opening) -> Row:
    """Return an openings row."""
    swing = opening.swing
    room, hinge, angle = (swing.room_id, swing.hinge, swing.angle) if swing else ("", None, None)
    leaf = {"swing_room": room, "swing_hinge": hinge, "swing_angle": angle}
    own = {"scene_id": scene_id, "rooms": list(opening.rooms), "width": round(opening.width, 4)}
    return _row(opening, OPENING) | own | leaf


def object_row(scene_id: str, placement: Placement, *, openable: bool) -> Row:
    """Return an objects row."""
    return _row(placement, PLACEMENT) | {"scene_id": scene_id, "openable": openable, "source_id": ""}


def plan_of(scene: Mapping[str, Any], rooms: Iterable[Mapping[str, Any]], openings: Iterable[Mapping[str, Any]]) -> Plan:
    """Rebuild the plan of one home from its rows."""
    return Plan(
        tuple(Room(**{name: r[name] for name in ROOM} | {"polygon": np.array(r["polygon"], float)}) for r in rooms),
        tuple(_opening(o) for o in openings),
        **{name: scene[name] for name in PLAN},
    )


def _opening(row: Mapping[str, Any]) -> Opening:
    swing = Swing(row["swing_room"], row["swing_hinge"], row["swing_angle"]) if row["swing_room"] else None
    own = {name: row[name] for name in OPENING} | {"rooms": tuple(row["rooms"]), "segment": np.array(row["segment"], float)}
    return Opening(**own, swing=swing)


def placement_of(row: Mapping[str, Any]) -> Placement:
    """Rebuild a placement from its objects row."""
    own: Row = {name: np.array(row[name], ARRAYS[name]) if name in ARRAYS else row[name] for name in PLACEMENT}
    return Placement(**own)


def homes_of(tables: Mapping[str, list[Row]]) -> list[Home]:
    """Rebuild homes from rows of scenes, rooms, openings and objects, in the order of the scenes."""
    grouped: dict[tuple[str, str], list[Row]] = {}
    for table in ("rooms", "openings", "objects"):
        for row in tables[table]:
            grouped.setdefault((table, row["scene_id"]), []).append(row)
    homes = []
    for scene in tables["scenes"]:
        rooms, openings, objects = (grouped.get((table, scene["scene_id"]), []) for table in ("rooms", "openings", "objects"))
        placed = tuple(placement_of(row) for row in objects)
        homes.append(Home(**{name: scene[name] for name in HOME}, plan=plan_of(scene, rooms, openings), placements=placed))
    return homes


def reject_row(scene_id: str, room_id: str, attempt: int, reject: tuple[str, str, str]) -> Row:
    """Return a rejects row of one try: `reject` is (what, reason code, detail). Raises KeyError for a code that REASONS lacks."""
    what, reason, detail = reject
    REASONS[reason]  # a typo must not reach the table
    where = f"{scene_id}/{room_id}" if room_id else scene_id
    return {"what": what, "where": f"{where}#{attempt}", "reason": reason, "detail": detail}


def unjudged_rows(home: Home, drafts: Mapping[str, Draft], assets: Mapping[str, Asset]) -> dict[str, list[Row]]:
    """Return a home's rows by table, without what only the judge knows; `drafts` are those of its rooms, by room id."""
    known = taxonomy.load()
    openable = {p.object_id: assets[p.asset_id].openable for p in home.placements}
    rooms = []
    for room in home.plan.rooms:
        mine = [p for p in home.in_room(room.room_id) if p.category not in known.small]
        row = room_row(home.scene_id, room, layout_type(room, home.plan, known))
        row |= {"objects": len(mine), "openable": sum(openable[p.object_id] for p in mine)}
        if draft := drafts.get(room.room_id):
            sampled = sum(assets[p.asset_id].openable for p in draft.placements)
            row |= {"asked_objects": draft.job.count, "walkable_target": draft.job.walkable, "openable_sampled": sampled}
        rooms.append(row)
    counts = {"objects": sum(p.category not in known.small for p in home.placements), "openable": sum(openable.values())}
    return {
        "scenes": [scene_row(home) | counts],
        "rooms": rooms,
        "openings": [opening_row(home.scene_id, opening) for opening in home.plan.openings],
        "objects": [object_row(home.scene_id, p, openable=openable[p.object_id]) for p in home.placements],
    }


def home_rows(
    home: Home, certificate: Certificate, drafts: Mapping[str, Draft], assets: Mapping[str, Asset], tries: int, licence: str
) -> dict[str, list[Row]]:
    """Return a finished home's rows by table; `tries` counts the tries of its rooms."""
    rows, figures = unjudged_rows(home, drafts, assets), certificate.room_figures()
    for row in rows["rooms"]:
        row.update(figures[row["room_id"]])
    rows["scenes"][0] |= certificate.scene_figures() | {"attempts": tries, "licence": licence, "usd": f"usd/{home.scene_id}.usdc"}
    return rows | {"joints": certificate.joint_rows()}


def scene_row(home: Home) -> Row:
    """Return a scenes row; the figures that only the judge knows are empty."""
    plan = home.plan
    counts = {
        "split": split_of(home.scene_id),
        "storeys": 1 + max((r.level for r in plan.rooms), default=0),
        "area": round(sum(r.area for r in plan.rooms), 4),
        "rooms": len(plan.rooms),
        "objects": len(home.placements),
    }
    unknown = {"joints": 0, "joints_clear": 0, "collisions": 0, "reach": 0.0, "attempts": 1, "licence": "", "usd": "", "usd_sha256": ""}
    return _row(home, HOME) | _row(plan, PLAN) | UNJUDGED | counts | unknown


def split_of(scene_id: str) -> str:
    """Return train, val or test (80 / 10 / 10), from the digest of the id alone."""
    number = int(sha256(scene_id.encode())[:8], 16) % 10
    return "train" if number < 8 else "val" if number == 8 else "test"
