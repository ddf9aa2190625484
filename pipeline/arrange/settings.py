"""Settings of the post-optimisation: section `postopt` of params.yaml."""

from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class WalkableSettings:
    """Algorithm 2: objects are exchanged for smaller ones until the walkable share reaches its target."""

    top: int = 3  # k: how many of the largest objects are exchanged per iteration
    iterations: int = 20  # M: most iterations per room


@dataclass(frozen=True, slots=True)
class SeparateSettings:
    """Separation: the nearest poses without collisions are searched, one object after the other."""

    touch: float = 0.0005  # prisms that are in each other by no more may stay [m]; below what the judge allows
    snap_angle: float = 4.0  # a yaw is turned to the walls' directions when it is this near to one [deg]
    wall_reach: float = 0.5  # an object that wants a wall is put to one whose distance is below this [m]
    turn_cost: float = 0.3  # what turning costs, in metres of displacement per radian [m/rad]
    access_cost: float = 0.25  # what blocking the place in front of a door or drawer costs, in metres of displacement [m]
    nearness_cost: float = 2.0  # what a metre costs by which things are nearer to each other than in training, in metres of displacement
    access_depth: float = 0.55  # depth of that place beyond the opened part [m]
    candidates: int = 16  # free poses that are weighed against each other per object
    rounds: int = 5  # times a room is started over, those first that found nothing free; from the third on as smaller assets


@dataclass(frozen=True, slots=True)
class ThingsSettings:
    """Small things on and in finished furniture."""

    rate: float = 1.0  # factor on the expected numbers on the cards in manifests/categories and in manifests/rooms.yaml; 0: no small things
    hidden: float = 0.1  # weight of a place in a drawer or behind a door, beside 1 of an open one
    margin: float = 0.01  # distance from edges and from each other [m]
    tries: int = 8  # places that are tried per thing


@dataclass(frozen=True, slots=True)
class PostoptSettings:
    """Section `postopt` of params.yaml. The robot's radius, height and raster cell are those of section `verify`."""

    walkable: WalkableSettings = field(default_factory=WalkableSettings)
    separate: SeparateSettings = field(default_factory=SeparateSettings)
    things: ThingsSettings = field(default_factory=ThingsSettings)
