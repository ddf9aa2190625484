"""What the judge holds homes to."""

from dataclasses import dataclass

from pipeline.geometry.robot import Robot


@dataclass(frozen=True, slots=True)
class Policy:
    """What a home must satisfy to ship."""

    collisions: int  # most objects that intersect something
    clear: float  # least share of joints that move freely through their range
    reach: float  # least share of openable objects that the robot can open
    connected: bool  # every room can be reached from the entrance
    supported: bool  # nothing floats


@dataclass(frozen=True, slots=True)
class VerifySettings:
    """Section `verify` of params.yaml."""

    touch: float  # prisms that are in each other by no more touch, but do not collide [m]
    wall: float  # the same at walls [m]
    float_gap: float  # an object that stands no higher than this above its support does not float [m]
    cell: float  # cell of the free-floor raster [m]
    robot: Robot
    policy: Policy
