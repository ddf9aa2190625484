"""What the judge holds homes to."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class Robot:
    """The robot for which floors must be walkable and handles in reach: an upright cylinder."""

    radius: float = 0.25  # [m]
    height: float = 1.4  # [m]
    step: float = 0.02  # it drives over what is lower [m]
    reach: tuple[float, float] = (0.4, 0.9)  # distance in plan from its axis to a handle [m]
    cone: float = 75.0  # it stands within this angle of the way in which the handle sets off [deg]


@dataclass(frozen=True, slots=True)
class Policy:
    """What a home must satisfy to ship."""

    collisions: int = 0  # most objects that intersect something
    clear: float = 1.0  # least share of joints that move freely through their range
    reach: float = 0.0  # least share of openable objects that the robot can open
    connected: bool = True  # every room can be reached from the entrance
    supported: bool = True  # nothing floats


@dataclass(frozen=True, slots=True)
class VerifySettings:
    """Section `verify` of params.yaml."""

    touch: float = 0.005  # prisms that are in each other by no more touch, but do not collide [m]
    wall: float = 0.01  # the same at walls [m]
    float_gap: float = 0.02  # an object that stands no higher than this above its support does not float [m]
    cell: float = 0.05  # cell of the free-floor raster [m]
    robot: Robot = field(default_factory=Robot)
    policy: Policy = field(default_factory=Policy)
