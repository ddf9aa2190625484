"""How much of a source house's floor a robot can walk on, with furniture as boxes; the judge uses the meshes themselves."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from pipeline import params
from pipeline.arrays import Floats
from pipeline.entities.plan import Opening, Room
from pipeline.geometry.free_space import bare_floor, standing_room
from pipeline.geometry.robot import Robot


@dataclass(frozen=True, slots=True)
class Walker:
    """The robot that homes are verified for, and the cell of the raster [m] on which its ways are looked for."""

    robot: Robot
    cell: float

    @classmethod
    def of(cls, tree: Mapping[str, Any]) -> Walker:
        """Take both from section `verify` of params.yaml: rooms are measured alike before training and when they are judged."""
        return cls(params.section(Robot, tree["verify"], "robot"), params.convert(float, tree["verify"]["cell"], "verify.cell"))

    def shares(
        self, rooms: Sequence[Room], openings: Sequence[Opening], boxes: Iterable[tuple[Floats, tuple[float, float]]]
    ) -> list[float]:
        """Return for each room the share of its floor in the largest connected part that the robot covers.

        `boxes` are the footprints (4, 2) [m] of objects, and from where to where they reach above their floor [m].
        """
        low, high = self.robot.band(0.0)
        in_the_way = [footprint for footprint, (bottom, top) in boxes if bottom < high and top > low]
        floor = bare_floor(rooms, openings, 0.2, self.cell)
        free = floor.raster.fill(floor.free.copy(), in_the_way, value=False)
        space = standing_room(floor, free, self.robot.radius)
        swept = space.swept_floor(space.largest_label(space.labels > 0))
        return [round(float(share), 4) for share in space.shares(swept, len(rooms))]
