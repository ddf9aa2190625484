"""What rooms a house has, how large they are meant to be, and what joins them: the program that its plan is solved from."""

from collections.abc import Sequence

import numpy as np

from pipeline.corpus.houses import rates
from pipeline.floorplan.program.floor_program import Entrance, FloorProgram, Footprint, Link, LinkKind, Range, RoomReq, Shell, Style

ROOMS = rates.load()["rooms"]
AREAS: dict[str, tuple[float, float, float, float]] = {name: room["area"] for name, room in ROOMS.items() if "area" in room}
BEDROOMS = tuple(name for name, room in ROOMS.items() if room["plan"] == "bedroom")
PRIVATE = (*BEDROOMS, "Library")
LOW, HIGH = 0.85, 1.12
"""Rooms are built no smaller than this part of the least area of their type, no larger than this part of the largest."""
FEW = 3
"""Rooms that may open off a living room without a corridor."""
SHAPES = {"rectangle": 0.3, "L": 0.4, "T": 0.3}


def area(rng: np.random.Generator, room_type: str) -> float:
    """Draw an area [m2] for a room type."""
    mean, spread, least, most = AREAS[room_type]
    return float(np.clip(rng.normal(mean, spread), least, most))


class Apartment:
    """Collects the rooms of a program and what joins them; `types` are 3D-FRONT's by the rooms' ids."""

    def __init__(self, rng: np.random.Generator) -> None:
        self.rng = rng
        self.rooms: list[RoomReq] = []
        self.links: list[Link] = []
        self.types: dict[str, str] = {}

    def room(self, room_type: str, host: str = "", kind: LinkKind = "door") -> str:
        """Add a room that opens to `host`, and return its id; without an area of its own where the type has none."""
        name = f"room_{len(self.rooms)}"
        size = Range()
        if room_type in AREAS:
            _, _, least, most = AREAS[room_type]
            size = Range(min=LOW * least, max=HIGH * most, target=area(self.rng, room_type))
        self.rooms.append(RoomReq.model_validate({"id": name, "type": ROOMS[room_type]["plan"], "area": size}))
        self.types[name] = room_type
        if host:
            self.links.append(Link(a=host, b=name, kind=kind, stated=True))
        return name

    def program(self, into: str) -> FloorProgram:
        """Return the program of what was collected, entered through `into`: no less than a quarter of the rooms have more than four corners."""
        aspect = float(self.rng.choice([1.0, 1.2, 1.4]))
        shape = str(self.rng.choice(list(SHAPES), p=list(SHAPES.values())))
        return FloorProgram(
            rooms=tuple(self.rooms),
            links=tuple(self.links),
            only=True,
            entrance=Entrance(into=into),
            footprint=Footprint.model_validate({"shape": shape, "min_aspect": aspect, "max_aspect": aspect + 0.5, "stated": True}),
            nonrect=len(self.rooms) // 4,
            shell=Shell(ceiling=float(self.rng.choice([2.6, 2.8], p=[0.45, 0.55]))),
            style=Style(area=2, squareness=-1, convexity=-2, simplicity=-2),
        )


def sample(rng: np.random.Generator, furnished: Sequence[str]) -> tuple[FloorProgram, dict[str, str]]:
    """Draw a program that has the rooms of these types, and what else an apartment cannot do without, or may have.

    Returns it with the 3D-FRONT type of each of its rooms.
    """
    private = _private(rng, furnished)
    together = "LivingDiningRoom" in furnished
    if not {"LivingDiningRoom", "DiningRoom", "LivingRoom"} & set(furnished):
        together = rng.random() < 0.7
    home = Apartment(rng)
    living = home.room("LivingDiningRoom" if together else "LivingRoom")
    dines = "DiningRoom" in furnished or (not together and rng.random() < 0.25)
    dining = home.room("DiningRoom", living, "open") if dines else living
    entry = {"Hallway", "Aisle", "Corridor"} & set(furnished) or rng.random() < 0.40
    hall = home.room("Hallway", living, "open") if entry else living
    baths = ["Bathroom"] + ["SecondBathroom"] * (len(private) >= 3 and rng.random() < 0.35)
    apart = len(private) + len(baths) > FEW or not together or rng.random() < 0.45
    hub = home.room("Corridor", living, "open") if apart else living
    bedrooms = [home.room(t, hub) for t in private]
    kitchen = home.room("Kitchen", dining, "open" if rng.random() < 0.2 else "door")
    for bath in baths:
        home.room(bath, hub)
    if private[0] == "MasterBedroom":
        suite = rng.random()
        if "CloakRoom" in furnished or suite > 0.94:
            home.room("CloakRoom", bedrooms[0])
        elif suite < 0.38:
            home.room("MasterBathroom", bedrooms[0])
    if "StorageRoom" in furnished or rng.random() < 0.24:
        home.room("StorageRoom", hall if entry else hub)
    if rng.random() < 0.20:
        home.room("LaundryRoom", kitchen)
    for host in (living, bedrooms[-1])[: int(rng.choice([0, 1, 2], p=[0.28, 0.55, 0.17]))]:
        home.room("Balcony", host)
    return home.program(hall), home.types


def _private(rng: np.random.Generator, furnished: Sequence[str]) -> list[str]:
    """Draw the types of the rooms to sleep and to work in, the one with a suite first."""
    rooms = [t for t in furnished if t in PRIVATE]
    if not any(t in BEDROOMS for t in rooms):
        rooms.insert(0, "MasterBedroom" if rng.random() < 0.6 else "Bedroom")
    if len(rooms) < 3 and rng.random() < 0.35:
        rooms.append(str(rng.choice(["SecondBedroom", "Bedroom", "Library"], p=[0.5, 0.3, 0.2])))
    return sorted(rooms, key=lambda t: t != "MasterBedroom")
