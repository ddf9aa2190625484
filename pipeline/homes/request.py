"""What is asked of the factory: one home, or one room of it."""

from __future__ import annotations

from dataclasses import dataclass, field

from pipeline.diffusion.context import CategoryBounds
from pipeline.entities.plan import Plan, Room
from pipeline.floorplan.program.floor_program import Furniture
from pipeline.floorplan.program.furniture import meant
from pipeline.taxonomy import Taxonomy

LIVING = frozenset({"living_room", "family_room"})
MOST_ATTEMPTS = 100  # tries of a room under one plan
TABLE = 18.0  # [m2] of a living room in which one dines, though nobody said so


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
    def category_bounds(self) -> tuple[CategoryBounds, ...]:
        """What is wished for by category, as the sampler takes it."""
        kind = self.room.type
        return tuple(CategoryBounds(meant(c, kind), c.min, c.max) for c in self.furniture.counts)

    def essentials(self, taxonomy: Taxonomy) -> tuple[tuple[str, ...], ...]:
        """Return the groups of categories of which the room needs one thing each; a stated number of objects may be too small for them."""
        groups = taxonomy.layouts[self.layout_type].needs if self.count is None and self.layout_type in taxonomy.layouts else ()
        return tuple(group for group in groups if not set(group) <= set(self.unwanted(taxonomy)))

    def unwanted(self, taxonomy: Taxonomy) -> tuple[str, ...]:
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
    """Return the room type that the layout model knows this room as, or None when it stays empty.

    A living room is where one dines if somebody said so; where a home has no other place for it, its largest is, if it has floor for a table.
    """
    if room.type in LIVING:
        told = any(r.type == "dining_room" or "dining" in r.functions for r in plan.rooms)
        largest = max((r for r in plan.rooms if r.type in LIVING), key=lambda r: r.area)
        if "dining" in room.functions or (not told and room.room_id == largest.room_id and room.area >= TABLE):
            return "living_dining_room"
    if room.type in taxonomy.layouts:
        return room.type
    return (taxonomy.types[room.type].furnished_as or None) if room.type in taxonomy.types else None
