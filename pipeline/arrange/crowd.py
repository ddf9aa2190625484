"""What already stands in a room, and whether one more can join it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pipeline.arrange.item import Item, turned
from pipeline.arrange.search import free_poses
from pipeline.arrange.settings import SeparateSettings
from pipeline.arrange.site import Site
from pipeline.geometry.freefloor import Walk
from pipeline.geometry.prisms import Prisms, stacked
from pipeline.geometry.standing import stand_pose

Floats = NDArray[np.float64]

SPREAD = 0.12  # when a pose cuts the floor, poses nearer to it than this are not tried [m]; more after every try
TRIES = 24  # poses whose floor is looked at per object
UNIT = np.ones(3)
FINE, ALOOF, CUT = "fine", "aloof", "cut"


class Crowd:
    """The settled objects of a room. Grows; nothing is taken out."""

    def __init__(self, site: Site, settings: SeparateSettings) -> None:
        self.site = site
        self.settings = settings
        self.usable: list[Item] = []
        self.bodies = stacked([])
        self.keeps = site.swung
        self.accesses = stacked([])
        bare = site.walk(self.bodies)
        label, self.doors = site.gate(bare)
        self.enters = self._enters(bare, label)

    def settle(self, item: Item, poses: Floats, costs: Floats) -> tuple[Item | None, str]:
        """Add the item at the cheapest of its poses that is free and leaves the floor in one piece; (None, CUT) if there is none.

        A pose at which nobody can stand before the item's own handles is taken when there is no better one.
        """
        start, tries = 0, 0
        failed: list[Floats] = []
        aloof: Item | None = None
        while start < len(poses) and tries < TRIES:
            totals, start = self._totals(item, poses, costs, start)
            for k in np.argsort(np.round(totals, 9), kind="stable")[: int(np.isfinite(totals).sum())]:
                apart = SPREAD * (1.0 + 0.15 * tries)
                if any(np.linalg.norm(poses[k, :2] - f[:2]) < apart and turned(f[3], poses[k, 3]) < 0.3 for f in failed):
                    continue
                moved = item.at(poses[k])
                verdict = self._verdict(moved)
                if verdict == FINE:
                    self.add(moved)
                    self.usable.append(moved)
                    return moved, FINE
                if verdict == ALOOF:
                    aloof = aloof or moved
                failed.append(poses[k])
                tries += 1
                if tries >= TRIES:
                    break
        if aloof is None:
            return None, CUT
        self.add(aloof)
        return aloof, ALOOF

    def add(self, item: Item) -> None:
        """Add an item where it stands."""
        p = item.placement
        self.bodies = stacked([self.bodies, item.shape.body.placed(p.position, p.yaw, UNIT)])
        self.keeps = stacked([self.keeps, item.shape.keep.placed(p.position, p.yaw, UNIT)])
        self.accesses = stacked([self.accesses, item.shape.access.placed(p.position, p.yaw, UNIT)])

    def _totals(self, item: Item, poses: Floats, costs: Floats, start: int) -> tuple[Floats, int]:
        shape = item.shape
        return free_poses(
            poses,
            costs,
            start,
            self.settings.candidates,
            shape.outline,
            (_own(shape.body), _own(shape.keep), _own(shape.access)),
            (_others(self.bodies), _others(self.keeps), _others(self.accesses), self.site.polygon),
            self.site.ceiling,
            self.settings.touch,
            self.settings.access_cost,
        )

    def _verdict(self, item: Item) -> str:
        """Judge the floor with the item: the doors must stay joined, and what opens must still have a robot's place.

        `ALOOF`: only the item itself cannot be stood at. That is better than no item.
        """
        p = item.placement
        body = item.shape.body.placed(p.position, p.yaw, UNIT)
        low, high = self.site.elevation + self.site.step, self.site.elevation + self.site.height
        if not len(body) or body.z[:, 0].min() >= high or body.z[:, 1].max() <= low:
            return FINE
        walked = self.site.walk(stacked([self.bodies, body]))
        label, doors = self.site.gate(walked)
        if doors < self.doors or (self.enters and not self._enters(walked, label)):
            return CUT
        if not all(self._usable(one, walked, label) for one in self.usable):
            return CUT
        return FINE if self._usable(item, walked, label) else ALOOF

    def _enters(self, walked: Walk, label: int) -> bool:
        """Whether the robot gets from the doors into the room itself."""
        return bool((walked.labels[self.site.floor.room >= 0] == label).any()) and label > 0

    def _usable(self, item: Item, walked: Walk, label: int) -> bool:
        """Whether a robot can stand at one of the item's handles, if it has any."""
        p, site = item.placement, self.site
        c, s = np.cos(p.yaw), np.sin(p.yaw)
        T = np.array([[c, s], [-s, c]])
        ceiling = site.elevation + site.height
        return not item.shape.grips or any(
            stand_pose(
                grip.point @ T + p.position[:2],
                grip.heading @ T,
                grip.swept.placed(p.position, p.yaw, UNIT),
                ceiling,
                walked,
                label,
                radius=site.radius,
                reach=site.reach,
                cone=site.cone,
            )
            is not None
            for grip in item.shape.grips
        )


def _own(prisms: Prisms) -> tuple[Floats, NDArray[np.int64], Floats]:
    return np.ascontiguousarray(prisms.corners), prisms.count, np.ascontiguousarray(prisms.z)


def _others(prisms: Prisms) -> tuple[Floats, NDArray[np.int64], Floats, Floats]:
    return np.ascontiguousarray(prisms.corners), prisms.count, np.ascontiguousarray(prisms.z), prisms.boxes()
