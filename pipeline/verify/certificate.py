"""The certificate of a home: per joint, object and room what works, and the figures that the tables carry."""

from dataclasses import dataclass
from typing import Any

from pipeline.arrays import Floats
from pipeline.geometry.kinematics import OPENERS
from pipeline.verify.settings import Policy


@dataclass(frozen=True, slots=True)
class JointCheck:
    """One joint of a placed object, or of a room door (`object_id` is then the opening's, `part_class` door_leaf).

    `axis` (3,) and `origin` (3,) [m] in the world at rest; limits in rad or m. `clear_upper` is the largest position that
    is reached from 0 without touching, `clear` whether the whole range is free, `blocker` what is touched first. The joints
    `after` of the same object are open meanwhile; where one of them is not clear, this one does not move.
    `stand` (x, y, yaw) is where a robot can stand to open it, None where it cannot.
    """

    object_id: str
    joint_id: str
    type: str
    part_class: str
    axis: Floats
    origin: Floats
    lower: float
    upper: float
    clear_upper: float
    clear: bool
    blocker: str
    stand: tuple[float, float, float] | None
    after: tuple[str, ...] = ()

    @property
    def opens(self) -> bool:
        """Whether this is a door, drawer or lid of an object (a room door, knob or button is not)."""
        return self.part_class in OPENERS


@dataclass(frozen=True, slots=True)
class ObjectCheck:
    """One object at rest: what it is in (`hits`, other objects' ids), how far it sticks out of its room [m], support."""

    object_id: str
    room_id: str
    hits: tuple[str, ...]
    outside: float
    inside: bool
    supported: bool

    @property
    def collides(self) -> bool:
        """Whether it intersects another object or a wall."""
        return bool(self.hits) or not self.inside


@dataclass(frozen=True, slots=True)
class RoomCheck:
    """One room's floor.

    `walkable_paper` is the paper's (A_room - sum A_i) / A_room over floor-standing objects (what hangs from walls or
    ceiling, or lies on furniture, takes no floor); `walkable_printed` over all furniture, as the formula is printed. `walkable_free` is the share
    that the robot covers while it moves where it can get from the entrance (`connected`: it gets into this room).
    """

    room_id: str
    area: float
    walkable_paper: float
    walkable_printed: float
    walkable_free: float
    connected: bool


@dataclass(frozen=True, slots=True)
class Certificate:
    """What the judge found in one home. `joints` are ordered as the placements, then the room doors.

    `small` are the ids of the small things: their joints must move too, but they count neither as openable nor for `reach`.
    """

    scene_id: str
    joints: tuple[JointCheck, ...]
    objects: tuple[ObjectCheck, ...]
    rooms: tuple[RoomCheck, ...]
    small: frozenset[str] = frozenset()

    @property
    def collisions(self) -> int:
        """Number of objects that intersect another object or a wall."""
        return sum(o.collides for o in self.objects)

    @property
    def joints_clear(self) -> int:
        """Number of joints that move through their whole range."""
        return sum(j.clear for j in self.joints)

    @property
    def openable(self) -> int:
        """Number of pieces of furniture with a door, drawer or lid."""
        return len({j.object_id for j in self._opening()})

    @property
    def reach(self) -> float:
        """Share of openable furniture with a part that the robot can stand at and open wholly; 1 where none opens."""
        good = {j.object_id for j in self._opening() if j.clear and j.stand is not None}
        return len(good) / self.openable if self.openable else 1.0

    def _opening(self) -> list[JointCheck]:
        return [j for j in self.joints if j.opens and j.object_id not in self.small]

    def walkable(self, name: str) -> float:
        """Return the mean of a rooms' figure over the home, weighted by area (so a share of the whole floor)."""
        total = sum(r.area for r in self.rooms)
        return sum(r.area * float(getattr(r, name)) for r in self.rooms) / total if total else 1.0

    def closed_rooms(self) -> frozenset[str]:
        """Return the rooms that the robot does not get into."""
        return frozenset(r.room_id for r in self.rooms if not r.connected)

    def faults(self, policy: Policy, closed: frozenset[str] = frozenset()) -> tuple[tuple[str, str], ...]:
        """Return what breaks the policy, as (reason code, detail); empty when the home may ship.

        `closed` are rooms that the plan itself, given by somebody, closes to the robot: no fault of what stands in them.
        """
        breaches: list[tuple[str, str]] = []
        if self.collisions > policy.collisions:
            breaches.append(("collision", ", ".join(o.object_id for o in self.objects if o.collides)))
        if self.joints and self.joints_clear < policy.clear * len(self.joints) - 1e-9:
            stuck = (f"{j.object_id}/{j.joint_id} at {j.blocker}" for j in self.joints if not j.clear)
            breaches.append(("joint_blocked", ", ".join(stuck)))
        if self.reach < policy.reach - 1e-9:
            breaches.append(("out_of_reach", f"{self.reach:.3f} of the openable objects can be opened"))
        if policy.connected and (lost := self.closed_rooms() - closed):
            breaches.append(("room_cut_off", ", ".join(r.room_id for r in self.rooms if r.room_id in lost)))
        if policy.supported and not all(o.supported for o in self.objects):
            breaches.append(("unsupported", ", ".join(o.object_id for o in self.objects if not o.supported)))
        return tuple(breaches)

    def ok(self, policy: Policy) -> bool:
        """Whether the home may ship."""
        return not self.faults(policy)

    def joint_rows(self) -> list[dict[str, Any]]:
        """Return the rows of the joints table."""
        return [
            {
                "scene_id": self.scene_id,
                "object_id": j.object_id,
                "joint_id": j.joint_id,
                "type": j.type,
                "part_class": j.part_class,
                "axis": _round_vector(j.axis),
                "origin": _round_vector(j.origin),
                "lower": j.lower,
                "upper": j.upper,
                "after": list(j.after),
                "clear_upper": j.clear_upper,
                "clear": j.clear,
                "blocker": j.blocker,
                "stand": None if j.stand is None else list(j.stand),
            }
            for j in self.joints
        ]

    def room_figures(self) -> dict[str, dict[str, float]]:
        """Return what the rooms table carries, by room_id."""
        return {r.room_id: {name: round(getattr(r, name), 6) for name in ("walkable_paper", "walkable_free")} for r in self.rooms}

    def scene_figures(self) -> dict[str, float | int]:
        """Return what the scenes table carries."""
        return {
            "joints": len(self.joints),
            "joints_clear": self.joints_clear,
            "openable": self.openable,
            "collisions": self.collisions,
            "reach": round(self.reach, 6),
            "walkable_paper": round(self.walkable("walkable_paper"), 6),
            "walkable_free": round(self.walkable("walkable_free"), 6),
        }


def _round_vector(vector: Floats) -> list[float]:
    return [round(float(x), 6) + 0.0 for x in vector]
