"""What is asked of the factory: one home, or one room of it."""

from __future__ import annotations

from dataclasses import dataclass

from pipeline.entities.plan import Plan, Room
from pipeline.taxonomy import Taxonomy


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

    `index` is the home's, `number` the room's position in the plan, `attempt` counts from 0: with the seed they key
    every random draw. `count` is the exact number of objects that is asked for, `walkable` the share of free floor.
    """

    plan: Plan
    room_id: str
    layout_type: str
    index: int
    number: int
    attempt: int = 0
    count: int | None = None
    walkable: float | None = None

    @property
    def room(self) -> Room:
        """The room itself."""
        return self.plan.room(self.room_id)


def layout_type(room: Room, plan: Plan, taxonomy: Taxonomy) -> str | None:
    """Return the room type that the layout model knows this room as, or None when it stays empty.

    A living room of a home without a dining room is where one dines, if it is large enough for a table.
    """
    if room.type in taxonomy.layout_types:
        return room.type
    known = taxonomy.plan_rooms.get(room.type)
    dining = any(r.type == "dining_room" for r in plan.rooms)
    if known == "living_room" and room.type in {"living_room", "family_room"} and not dining and room.area >= 18.0:
        return "living_dining_room"
    return known
