"""One home in the making: its first draft, and what it has come to so far."""

from __future__ import annotations

from dataclasses import dataclass, field

from pipeline.entities.home import Placement
from pipeline.entities.plan import Plan
from pipeline.homes.furnish import Draft
from pipeline.homes.outcomes import Empty
from pipeline.homes.request import Request, RoomJob
from pipeline.homes.room_finishing import RoomResult
from pipeline.homes.rows import Row
from pipeline.verify import Certificate


@dataclass(frozen=True, slots=True)
class HomeDraft:
    """The first attempt at a home: its plan, and a draft of each room that is furnished."""

    request: Request
    prompt: str
    program: str
    plan: Plan
    drafts: tuple[Draft, ...]


@dataclass
class Work:
    """One home in the making.

    `tries` counts the tries of its rooms, `seconds` of CPU are what they took; `empty` says why it is given up; `closed` are the
    rooms that a plan of the user's own closes to the robot.
    """

    request: Request
    attempt: int
    prompt: str
    program: str
    plan: Plan
    pending: list[RoomJob]
    last: dict[str, int]  # attempt number that each room has reached
    results: dict[str, RoomResult] = field(default_factory=dict)
    first: dict[str, Draft] = field(default_factory=dict)
    rejects: list[Row] = field(default_factory=list)
    tries: int = 0
    seconds: float = 0.0
    empty: Empty | None = None
    certificate: Certificate | None = None
    things: tuple[Placement, ...] = ()
    closed: frozenset[str] = frozenset()
