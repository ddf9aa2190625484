"""What is asked of the factory: one home, or one room of it."""

from dataclasses import dataclass, field

from pipeline.diffusion.context import CategoryBounds
from pipeline.entities.plan import Plan, Room
from pipeline.floorplan.program.floor_program import Furniture
from pipeline.floorplan.program.furniture import arranged, matching_categories
from pipeline.taxonomy import Taxonomy

LIVING = frozenset({"living_room", "family_room"})
MOST_ATTEMPTS = 100  # tries of a room under one plan
ENOUGH = 0.75  # of the floor that training rooms have for it makes a place to dine, where a home has no other
PARTS = "+"  # between the layout types of a room that serves as several


@dataclass(frozen=True, slots=True)
class Request:
    """One home: its index in the dataset, and the words that ask for it ("" draws a program from the prior).

    `program` is the typed request as JSON where something else than the built-in parser has read the words; `plan` the floor
    plan as its JSON document where the user has brought one, `program` then says what it is.
    """

    index: int
    prompt: str = ""
    program: str = ""
    plan: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class RoomJob:
    """One room to furnish; equal to nothing but itself.

    `index` is the home's, `number` the room's position in the plan; `plan_attempt` and, within one plan, `attempt` count from 0.
    `layout_type` names the layout types of a room's parts, with a "+" between them.
    `count` is the number of objects that the sampler is told, `walkable` the share of free floor,
    `furniture` all that is wished for.
    """

    plan: Plan
    room_id: str
    layout_type: str
    index: int
    number: int
    plan_attempt: int = 0
    attempt: int = 0
    count: int | None = None
    walkable: float | None = None
    furniture: Furniture = field(default_factory=Furniture)

    @property
    def draw(self) -> int:
        """Number of the try among all of the room's: with seed, index and number it keys every random draw, so that none is made twice."""
        return self.plan_attempt * MOST_ATTEMPTS + self.attempt

    @property
    def kinds(self) -> tuple[str, ...]:
        """The layout types of the room's parts: mostly one."""
        return tuple(self.layout_type.split(PARTS))

    @property
    def category_bounds(self) -> tuple[CategoryBounds, ...]:
        """What is wished for by category, as the sampler takes it."""
        kind = self.room.type
        return tuple(CategoryBounds(matching_categories(c, kind), c.min, c.max) for c in arranged(self.furniture))

    def essentials(self, taxonomy: Taxonomy) -> tuple[tuple[str, ...], ...]:
        """Return the groups of categories of which the room needs one thing each; a stated number of objects may be too small for them."""
        return tuple(group for kind in self.kinds for group in self.essentials_of(kind, taxonomy))

    def essentials_of(self, kind: str, taxonomy: Taxonomy) -> tuple[tuple[str, ...], ...]:
        """Return the groups that a part of this layout type needs."""
        groups = taxonomy.layouts[kind].needs if self.count is None and kind in taxonomy.layouts else ()
        return tuple(group for group in groups if not set(group) <= set(self.exclusions(taxonomy)))

    def exclusions(self, taxonomy: Taxonomy) -> tuple[str, ...]:
        """Return what is not put into rooms of the plan's type, though rooms of the same layout type have it: no tub into a WC."""
        return taxonomy.types[self.room.type].unwanted if self.room.type in taxonomy.types else ()

    @property
    def bounds(self) -> tuple[int | None, int | None]:
        """Least and most number of objects; a job that states a count alone means it exactly."""
        least, most = self.furniture.least, self.furniture.most
        return (self.count, self.count) if least is None and most is None else (least, most)

    @property
    def room(self) -> Room:
        """The room itself."""
        return self.plan.room(self.room_id)


def layout_type(room: Room, plan: Plan, taxonomy: Taxonomy) -> str | None:
    """Return the room type that the layout model knows this room as, or None when it stays empty; "bedroom+living_room" for one that serves as both."""
    if room.type not in taxonomy.types:
        return room.type if room.type in taxonomy.layouts else None
    kind = taxonomy.types[room.type]
    own = kind.functions
    if not own:
        return kind.roles.get(room.role) or (room.type if room.type in taxonomy.layouts else kind.furnished_as or None)
    functions = {*own, *room.functions, *(["dining"] if _dines(room, plan, taxonomy) else [])}
    if {"living", "dining"} <= functions and "sleeping" not in functions:  # no part of a studio is as large as rooms that are both
        functions = functions - {"living", "dining"} | {"living and dining"}
    return PARTS.join(kind for name, kind in taxonomy.functions.items() if name in functions)


def _dines(room: Room, plan: Plan, taxonomy: Taxonomy) -> bool:
    """Whether one dines in a room though nobody said so: in kitchens with the floor for both, and where a home has no other place for it in the room that comes nearest to that."""
    share = _dining_share(room, taxonomy)
    if room.type == "kitchen" and share >= 1.0:
        return True
    if any(r.type == "dining_room" or "dining" in r.functions for r in plan.rooms):
        return False
    return share >= ENOUGH and room is max(plan.rooms, key=lambda r: _dining_share(r, taxonomy))


def _dining_share(room: Room, taxonomy: Taxonomy) -> float:
    """Return a room's floor as a share of what it takes to dine there as well; 0 where nobody does."""
    part = {kind: taxonomy.layouts[kind].part for kind in taxonomy.functions.values()}
    needed = {
        **dict.fromkeys(LIVING, part["living_dining_room"]),
        "kitchen": part["kitchen"] + part["dining_room"],
        "studio_room": part["bedroom"] + part["living_room"] + part["dining_room"],
    }
    return room.area / needed[room.type] if room.type in needed else 0.0
