"""Homes as table rows and back."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from pipeline.entities.asset import Asset
from pipeline.entities.home import Home, Placement
from pipeline.entities.plan import Opening, Plan, Room, Swing
from pipeline.homes.reasons import REASONS
from pipeline.homes.request import layout_type
from pipeline.homes.room_finishing import RoomResult
from pipeline.manifest import sha256
from pipeline.taxonomy import Taxonomy
from pipeline.verify import Certificate

Row = dict[str, Any]


def room_row(scene_id: str, room: Room, layout_type: str | None) -> Row:
    """Return a rooms row; the figures that only the judge knows are empty."""
    return {
        "scene_id": scene_id,
        "room_id": room.room_id,
        "type": room.type,
        "layout_type": layout_type or "",
        "role": room.role,
        "level": room.level,
        "height": room.height,
        "area": round(room.area, 4),
        "polygon": room.polygon.tolist(),
        "objects": 0,
        "asked_objects": None,
        "openable": 0,
        "openable_sampled": None,
        "walkable_paper": 1.0,
        "walkable_free": 1.0,
        "walkable_target": None,
        "source_id": "",
    }


def opening_row(scene_id: str, opening: Opening) -> Row:
    """Return an openings row."""
    swing = opening.swing
    return {
        "scene_id": scene_id,
        "opening_id": opening.opening_id,
        "kind": opening.kind,
        "rooms": list(opening.rooms),
        "segment": opening.segment.tolist(),
        "width": round(opening.width, 4),
        "height": opening.height,
        "sill": opening.sill,
        "swing_room": swing.room_id if swing else "",
        "swing_hinge": swing.hinge if swing else None,
        "swing_angle": swing.angle if swing else None,
        "level": opening.level,
    }


def object_row(scene_id: str, placement: Placement, *, openable: bool) -> Row:
    """Return an objects row."""
    return {
        "scene_id": scene_id,
        "object_id": placement.object_id,
        "room_id": placement.room_id,
        "category": placement.category,
        "asset_id": placement.asset_id,
        "position": placement.position.tolist(),
        "yaw": placement.yaw,
        "size": placement.size.tolist(),
        "scale": placement.scale.tolist(),
        "openable": openable,
        "support": placement.support,
        "latent": placement.latent.tolist(),
        "retrieval_distance": placement.retrieval_distance,
        "source_id": "",
    }


def plan_of(scene: Mapping[str, Any], rooms: Iterable[Mapping[str, Any]], openings: Iterable[Mapping[str, Any]]) -> Plan:
    """Rebuild the plan of one home from its rows."""
    return Plan(
        tuple(Room(r["room_id"], r["type"], np.array(r["polygon"], float), r["level"], r["height"], r["role"]) for r in rooms),
        tuple(_opening(o) for o in openings),
        scene["entrance"],
        scene["inner_wall"],
        scene["outer_wall"],
        scene["storey_height"],
    )


def placement_of(row: Mapping[str, Any]) -> Placement:
    """Rebuild a placement from its objects row."""
    return Placement(
        row["object_id"],
        row["room_id"],
        row["category"],
        row["asset_id"],
        np.array(row["position"], float),
        row["yaw"],
        np.array(row["size"], float),
        np.array(row["scale"], float),
        np.array(row["latent"], np.float32),
        row["retrieval_distance"],
        row["support"],
    )


def homes_of(tables: Mapping[str, list[Row]]) -> list[Home]:
    """Rebuild homes from rows of scenes, rooms, openings and objects, in the order of the scenes."""
    grouped = {name: _by_scene(tables[name]) for name in ("rooms", "openings", "objects")}
    return [
        Home(
            scene["scene_id"],
            scene["seed"],
            scene["index"],
            scene["prompt"],
            scene["program"],
            plan_of(scene, grouped["rooms"].get(scene["scene_id"], []), grouped["openings"].get(scene["scene_id"], [])),
            tuple(placement_of(row) for row in grouped["objects"].get(scene["scene_id"], [])),
        )
        for scene in tables["scenes"]
    ]


def _opening(row: Mapping[str, Any]) -> Opening:
    swing = Swing(row["swing_room"], row["swing_hinge"], row["swing_angle"]) if row["swing_room"] else None
    return Opening(
        row["opening_id"],
        row["kind"],
        tuple(row["rooms"]),
        np.array(row["segment"], float),
        row["height"],
        row["sill"],
        swing,
        row["level"],
    )


def _by_scene(rows: Iterable[Row]) -> dict[str, list[Row]]:
    grouped: dict[str, list[Row]] = {}
    for row in rows:
        grouped.setdefault(row["scene_id"], []).append(row)
    return grouped


def reject_row(scene_id: str, room_id: str, attempt: int, reject: tuple[str, str, str]) -> Row:
    """Return a rejects row of one try: `reject` is (what, reason code, detail). Raises KeyError for a code that REASONS lacks."""
    what, reason, detail = reject
    REASONS[reason]  # a typo must not reach the table
    where = f"{scene_id}/{room_id}" if room_id else scene_id
    return {"what": what, "where": f"{where}#{attempt}", "reason": reason, "detail": detail}


def home_rows(
    home: Home,
    certificate: Certificate,
    results: Mapping[str, RoomResult],
    assets: Mapping[str, Asset],
    taxonomy: Taxonomy,
    tries: int,
    licence: str,
) -> dict[str, list[Row]]:
    """Return a finished home's rows by table; `tries` counts the tries of its rooms."""
    openable = {p.object_id: assets[p.asset_id].openable for p in home.placements}
    figures, small = certificate.room_figures(), taxonomy.small
    rooms = []
    for room in home.plan.rooms:
        row = room_row(home.scene_id, room, layout_type(room, home.plan, taxonomy)) | figures[room.room_id]
        mine = [p for p in home.in_room(room.room_id) if p.category not in small]
        row |= {"objects": len(mine), "openable": sum(openable[p.object_id] for p in mine)}
        if room.room_id in results:
            draft = results[room.room_id].draft
            row |= {
                "asked_objects": draft.job.count,
                "walkable_target": draft.job.walkable,
                "openable_sampled": sum(assets[p.asset_id].openable for p in draft.placements),
            }
        rooms.append(row)
    scene = (
        scene_row(home)
        | certificate.scene_figures()
        | {
            "objects": sum(p.category not in small for p in home.placements),
            "attempts": tries,
            "licence": licence,
            "usd": f"usd/{home.scene_id}.usdc",
        }
    )
    return {
        "scenes": [scene],
        "rooms": rooms,
        "openings": [opening_row(home.scene_id, opening) for opening in home.plan.openings],
        "objects": [object_row(home.scene_id, p, openable=openable[p.object_id]) for p in home.placements],
        "joints": certificate.joint_rows(),
    }


def scene_row(home: Home) -> Row:
    """Return a scenes row; the figures that only the judge knows are empty."""
    plan = home.plan
    return {
        "scene_id": home.scene_id,
        "index": home.index,
        "seed": home.seed,
        "split": split_of(home.scene_id),
        "prompt": home.prompt,
        "program": home.program,
        "storeys": 1 + max((r.level for r in plan.rooms), default=0),
        "storey_height": plan.storey_height,
        "inner_wall": plan.inner_wall,
        "outer_wall": plan.outer_wall,
        "entrance": plan.entrance,
        "area": round(sum(r.area for r in plan.rooms), 4),
        "rooms": len(plan.rooms),
        "objects": len(home.placements),
        "openable": 0,
        "joints": 0,
        "joints_clear": 0,
        "collisions": 0,
        "reach": 0.0,
        "walkable_paper": 1.0,
        "walkable_free": 1.0,
        "attempts": 1,
        "licence": "",
        "usd": "",
        "usd_sha256": "",
    }


def split_of(scene_id: str) -> str:
    """Return train, val or test (80 / 10 / 10), from the digest of the id alone."""
    number = int(sha256(scene_id.encode())[:8], 16) % 10
    return "train" if number < 8 else "val" if number == 8 else "test"
