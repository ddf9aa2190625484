"""What others call rooms: 3D-FRONT, ProcTHOR and people, as one of our room types and a role."""

import difflib
import re
import typing

from pipeline.floorplan.imports.sketch import Sketch, refuse
from pipeline.floorplan.program.floor_program import Role, RoomReq, RoomType

TYPES: tuple[str, ...] = typing.get_args(RoomType)
ROLES: tuple[str, ...] = typing.get_args(Role)
FUNCTIONS: tuple[str, ...] = typing.get_args(typing.get_args(RoomReq.model_fields["functions"].annotation)[0])
ALIASES = {
    # people
    "living": "living_room", "lounge": "living_room", "sitting_room": "living_room", "bed_room": "bedroom", "bath": "bathroom",
    "bath_room": "bathroom", "shower_room": "bathroom", "toilet": "wc", "powder_room": "wc", "restroom": "wc", "hall": "hallway",
    "corridor": "hallway", "landing": "hallway", "foyer": "entry", "entrance": "entry", "entrance_hall": "entry", "vestibule": "entry",
    "study": "office", "living_dining_room": "living_room", "living_dining": "living_room", "home_office": "office", "studio": "studio_room", "stairs": "staircase", "stairwell": "staircase", "dining": "dining_room",
    "laundry": "utility", "laundry_room": "utility", "utility_room": "utility", "storage_room": "storage", "store": "storage",
    "pantry": "storage", "wardrobe": "closet", "dressing_room": "closet", "walk_in_closet": "closet", "terrace": "balcony", "loggia": "balcony",
    "patio": "balcony", "conservatory": "sunroom", "nursery": "bedroom", "kitchenette": "kitchen",
    # 3D-FRONT
    "livingdiningroom": "living_room", "livingroom": "living_room", "diningroom": "dining_room", "masterbedroom": "bedroom",
    "secondbedroom": "bedroom", "kidsroom": "bedroom", "elderlyroom": "bedroom", "nannyroom": "bedroom", "masterbathroom": "bathroom",
    "secondbathroom": "bathroom", "aisle": "hallway", "storageroom": "storage", "cloakroom": "closet", "laundryroom": "utility",
    "equipmentroom": "utility", "courtyard": "balcony", "auditorium": "media_room", "otherroom": "storage",
}  # fmt: skip
FUNCTIONS_OF = dict.fromkeys(("livingdiningroom", "livingdining"), ("living", "dining"))
ROLE_OF = {
    "masterbedroom": "primary",
    "master_bedroom": "primary",
    "kidsroom": "child",
    "nursery": "child",
    "elderlyroom": "elder",
    "nannyroom": "staff",
}


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
            room.role = ROLE_OF.get(plain, ROLE_OF.get(kind, ""))
        room.functions = tuple(f for f in room.functions if f in FUNCTIONS) or FUNCTIONS_OF.get(plain, ())
        if room.role not in ROLES:
            sketch.repair("role", room.room_id, f"the unknown role {room.role[:40]!r} is left out")
            room.role = ""
        if room_type != said:
            room.type = room_type
            also = f", with {' and '.join(room.functions)} in it" if room.functions else ""
            sketch.repair("type", room.room_id, f"the type {said[:40]!r} is taken as {room_type}{also}")
