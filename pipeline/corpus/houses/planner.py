"""What rooms a house has, which of them are furnished, and the plan that the factory's own planner makes of them."""

import functools
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pipeline.corpus import front_statistics
from pipeline.corpus.houses import rates
from pipeline.corpus.houses.rates import Deal
from pipeline.entities.plan import Plan
from pipeline.errors import ContentError, RefusedError
from pipeline.floorplan import solve
from pipeline.floorplan.program.floor_program import Entrance, FloorProgram, Footprint, Link, LinkKind, Range, RoomReq, Shell, Style
from pipeline.seeds import generator

ROOMS = rates.load()["rooms"]
AREAS: dict[str, tuple[float, float, float, float]] = {name: room["area"] for name, room in ROOMS.items() if "area" in room}
BEDROOMS = tuple(name for name, room in ROOMS.items() if room["plan"] == "bedroom")
PRIVATE = (*BEDROOMS, "Library")
LOW, HIGH = 0.85, 1.12  # rooms are built no smaller than this part of the least area of their type, no larger than this part of the largest
FEW = 3  # rooms that may open off a living room without a corridor
SHAPES = {"rectangle": 0.3, "L": 0.4, "T": 0.3}
BLOCK = 32  # houses over which decisions are dealt evenly
MOST_PRIVATE = 5  # rooms that a plan can hold beside the living rooms
CORRIDORS = ("Hallway", "Aisle", "Corridor")
KINDS: Mapping[str, str] = {name: room["chances"] for name, room in ROOMS.items()}  # whose chances furnish a type of room
PROGRAMS = 24
LARGEST_AISLE = 3.1  # what is larger is called a corridor [m2]


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
            mean, spread, least, most = AREAS[room_type]
            target = float(np.clip(self.rng.normal(mean, spread), least, most))
            size = Range(min=LOW * least, max=HIGH * most, target=target)
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
    entry = set(CORRIDORS) & set(furnished) or rng.random() < 0.40
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


@dataclass(frozen=True, slots=True)
class Agenda:
    """The types of the furnished rooms, and per recipe the first ordinal of this house and the total of its block."""

    block: int
    rooms: tuple[str, ...]
    ordinals: Mapping[str, tuple[int, int]]

    def deal(self, seed: int, room_type: str, number: int, place: int) -> Deal:
        """Return the hand of the `number`-th furnished room of its recipe; `place` is the house's in its block."""
        kind = KINDS[room_type]
        first, total = self.ordinals.get(kind, (0, 0))
        if not total:  # rooms that every house has: one stratum per house
            return Deal(seed, f"{kind}.{number}", self.block, place, BLOCK)
        return Deal(seed, kind, self.block, first + number, total)


def agenda(seed: int, index: int) -> Agenda:
    """Return what is furnished in house `index`."""
    return _block(seed, index // BLOCK)[index % BLOCK]


@functools.lru_cache(maxsize=64)
def _block(seed: int, block: int) -> tuple[Agenda, ...]:
    rng = generator(seed, "agenda", block)
    weights: Mapping[str, float] = rates.load()["agenda"]
    names, shares = list(weights), np.array(list(weights.values()))
    drawn = [_rooms(rng, names, shares, n) for n in _numbers(rng)]
    typed = _living(rng, drawn)
    totals = Counter(KINDS[t] for rooms in typed for t in rooms)
    counts: Counter[str] = Counter()
    agendas = []
    for rooms in typed:
        agendas.append(Agenda(block, rooms, {kind: (counts[kind], total) for kind, total in totals.items()}))
        counts.update(KINDS[t] for t in rooms)
    return tuple(agendas)


def _numbers(rng: np.random.Generator) -> list[int]:
    """Return how many rooms each house of a block furnishes: the observed shares, evenly."""
    houses = np.array(front_statistics.load().furnished_rooms, float)
    edges = np.cumsum(houses) / houses.sum()
    marks = (np.arange(BLOCK) + rng.random()) / BLOCK
    return [int(n) + 1 for n in rng.permutation(np.searchsorted(edges, marks))]


def chances(shares: NDArray[np.float64], number: int) -> NDArray[np.float64]:
    """Return the chance of each candidate to be among `number` chosen ones: in proportion to the shares, at most 1."""
    sure = np.zeros(len(shares), bool)
    while True:
        probabilities = np.where(sure, 1.0, shares * (number - sure.sum()) / shares[~sure].sum())
        new = (probabilities >= 1) & ~sure
        if not new.any():
            return np.asarray(probabilities)
        sure |= new


def _rooms(rng: np.random.Generator, names: list[str], shares: NDArray[np.float64], number: int) -> tuple[str, ...]:
    """Choose rooms by systematic sampling in a random order."""
    likely = chances(shares, number)
    while True:
        order = rng.permutation(len(names))
        ends = np.cumsum(likely[order])
        picks = order[np.searchsorted(ends, np.arange(number) + rng.random())]
        rooms = tuple(names[i].removesuffix("_2") for i in sorted(picks))
        if sum(t in PRIVATE for t in rooms) <= MOST_PRIVATE:
            return rooms


def _living(rng: np.random.Generator, drawn: list[tuple[str, ...]]) -> list[tuple[str, ...]]:
    """Say which living rooms are dining rooms as well: those of houses without a dining room, in their share."""
    alone = [k for k, rooms in enumerate(drawn) if "living" in rooms and "DiningRoom" not in rooms]
    share = float(rates.load()["living_dining"])  # type: ignore[arg-type]
    marks = (rng.permutation(len(alone)) + rng.random()) / max(1, len(alone))
    both = {k for k, mark in zip(alone, marks, strict=True) if mark < share}
    names = ["LivingDiningRoom" if k in both else "LivingRoom" for k in range(len(drawn))]
    return [tuple(name if t == "living" else t for t in rooms) for name, rooms in zip(names, drawn, strict=True)]


def make_plan(rng: np.random.Generator, furnished: Sequence[str]) -> Plan:
    """Draw a plan with a room of every type in `furnished`: rooms `room_<i>` with 3D-FRONT types, doors, windows and an entrance."""
    for _ in range(PROGRAMS):
        program, types = sample(rng, furnished)
        try:
            plan = solve(program, int(rng.integers(2**31)))
        except RefusedError:
            continue
        angle = float(rng.uniform(1.45, 1.57))  # of open leaves [rad]
        openings = (o if o.swing is None else replace(o, swing=replace(o.swing, angle=angle)) for o in plan.openings)
        aisles = {r.room_id for r in plan.rooms if types[r.room_id] == "Corridor" and r.area < LARGEST_AISLE}
        rooms = (replace(r, type="Aisle" if r.room_id in aisles else types[r.room_id]) for r in plan.rooms)
        return replace(plan, rooms=tuple(rooms), openings=tuple(openings))
    raise ContentError(f"no house plan after {PROGRAMS} programs", "choose another seed in params.yaml")
