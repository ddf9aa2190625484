"""What others call rooms: 3D-FRONT, ProcTHOR and people, as one of our room types and a role."""

import difflib
import re
import typing

from pipeline import taxonomy
from pipeline.floorplan.imports.sketch import Sketch, refuse
from pipeline.floorplan.program.floor_program import Role, RoomReq, RoomType

TYPES: tuple[str, ...] = typing.get_args(RoomType)
ROLES: tuple[str, ...] = typing.get_args(Role)
FUNCTIONS: tuple[str, ...] = typing.get_args(typing.get_args(RoomReq.model_fields["functions"].annotation)[0])
ALIASES = {name: kind for kind, known in taxonomy.load().types.items() for name in known.called}
FUNCTIONS_OF = dict.fromkeys(("livingdiningroom", "livingdining"), ("living", "dining"))
ROLE_OF = {"masterbedroom": "primary", "kidsroom": "child", "nursery": "child", "elderlyroom": "elder", "nannyroom": "staff"}


def resolve_types(sketch: Sketch) -> None:
    """Give every room one of our types, stating what was translated.

    A type that nothing resembles is a store in a house of a dataset; elsewhere RefusedError is raised, for whoever wrote it can say what is meant.
    """
    for room in sketch.rooms:
        said = room.type
        kind = re.sub(r"[^a-z]+", "_", re.sub(r"(?<=[a-z])(?=[A-Z])", "_", said).lower()).strip("_")
        plain = kind.replace("_", "")
        room_type = next((t for t in (kind, ALIASES.get(kind, ""), ALIASES.get(plain, ""), f"{kind}_room") if t in TYPES), "")
        room_type = room_type or next((t for t in TYPES if t.replace("_", "") == plain), "")
        if not room_type and sketch.foreign:
            room_type = "storage"
        if not room_type:
            near = difflib.get_close_matches(kind, TYPES, 1)
            hint = f"did you mean {near[0]}?" if near else f"types are {', '.join(TYPES)}"
            raise refuse(f"{room.room_id} has the unknown type {said[:40]!r}", hint)
        if not room.role:
            room.role = ROLE_OF.get(plain, "")
        room.functions = tuple(f for f in room.functions if f in FUNCTIONS) or FUNCTIONS_OF.get(plain, ())
        if room.role not in ROLES:
            sketch.repair("role", room.room_id, f"the unknown role {room.role[:40]!r} is left out")
            room.role = ""
        if room_type != said:
            room.type = room_type
            also = f", with {' and '.join(room.functions)} in it" if room.functions else ""
            sketch.repair("type", room.room_id, f"the type {said[:40]!r} is taken as {room_type}{also}")
