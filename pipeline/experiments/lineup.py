"""Real and made rooms side by side, from above: in an unlabelled order first, labelled in the next picture."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np
from PIL import Image

from pipeline import taxonomy
from pipeline.entities.asset import Asset
from pipeline.entities.home import Home
from pipeline.preview.sheet import contact_sheet
from pipeline.preview.top import top_view

EACH = 5  # rooms of each type and kind
CELL = 190  # pixels
Room = tuple[Home, str]  # a home, and the room of it that is shown


def alone(home: Home, room_id: str) -> Home:
    """Return the home that is left when one room is cut out of it, with its windows: sources draw doors in different ways, and leaves would tell."""
    room = replace(home.plan.room(room_id), level=0)
    lift = np.array([0.0, 0.0, home.plan.room(room_id).level * home.plan.storey_height])
    openings = tuple(replace(o, level=0) for o in home.plan.openings if o.kind == "window" and room_id in o.rooms)
    placed = tuple(replace(p, position=p.position - lift) for p in home.in_room(room_id))
    return replace(home, plan=replace(home.plan, rooms=(room,), openings=openings, entrance=room_id), placements=placed)


def lineup(
    rng: np.random.Generator, real: Mapping[str, Sequence[Room]], generated: Mapping[str, Sequence[Room]], assets: Mapping[str, Asset]
) -> tuple[Image.Image, Image.Image] | None:
    """Return the two pictures of rooms by type, a row for each type that both have; None where there is none."""
    hidden: list[tuple[str, Image.Image]] = []
    answers: list[tuple[str, Image.Image]] = []
    for kind in (kind for kind in taxonomy.load().layout_types if real.get(kind) and generated.get(kind)):
        row = [
            (name, top_view(alone(*room), assets, CELL, reaches=False))
            for name, rooms in (("real", real), ("made", generated))
            for room in (rooms[kind][k] for k in sorted(rng.permutation(len(rooms[kind]))[:EACH]))
        ]
        blank = Image.new("RGB", (CELL, CELL), (244, 244, 241))
        row += [("", blank)] * (2 * EACH - len(row))
        answers += [(f"{name} {kind.replace('_', ' ')}" if name else "", picture) for name, picture in row]
        hidden += [("", row[k][1]) for k in rng.permutation(len(row))]
    if not answers:
        return None
    return contact_sheet(hidden, 2 * EACH, CELL), contact_sheet(answers, 2 * EACH, CELL)


def by_type(homes: Iterable[Home], types: Mapping[tuple[str, str], str]) -> dict[str, list[Room]]:
    """Return the furnished rooms of homes by their layout type; `types` by (scene_id, room_id)."""
    rooms: dict[str, list[Room]] = {}
    for home in homes:
        for room in home.plan.rooms:
            if home.in_room(room.room_id):
                rooms.setdefault(types.get((home.scene_id, room.room_id), ""), []).append((home, room.room_id))
    return rooms
