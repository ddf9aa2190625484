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

Floats = NDArray[np.float64]

SPREAD = 0.12  # when a pose cuts the floor, poses nearer to it than this are not tried [m]; more after every try
TRIES = 24  # poses whose floor is looked at per object
UNIT = np.ones(3)


class Crowd:
    """The settled objects of a room. Grows; nothing is taken out."""

    def __init__(self, site: Site, settings: SeparateSettings) -> None:
        self.site = site
        self.settings = settings
        self.items: list[Item] = []
        self.bodies = stacked([])
        self.keeps = site.swung
        self.accesses = stacked([])
        self.strips: list[NDArray[np.bool_]] = []
        bare = site.walk(self.bodies)
        self.doors = self._doors(bare)
        self.enters = self._enters(bare, site.entered(bare))

    def settle(self, item: Item, poses: Floats, costs: Floats) -> Item | None:
        """Add the item at the cheapest of its poses that is free and leaves the floor in one piece; None if there is none."""
        start, tries = 0, 0
        failed: list[Floats] = []
        while start < len(poses) and tries < TRIES:
            totals, start = self._totals(item, poses, costs, start)
            for k in np.argsort(np.round(totals, 9), kind="stable")[: int(np.isfinite(totals).sum())]:
                apart = SPREAD * (1.0 + 0.15 * tries)
                if any(np.linalg.norm(poses[k, :2] - f[:2]) < apart and turned(f[3], poses[k, 3]) < 0.3 for f in failed):
                    continue
                moved = item.at(poses[k])
                if self._open_floor(moved):
                    self.add(moved)
                    return moved
                failed.append(poses[k])
                tries += 1
                if tries >= TRIES:
                    break
        return None

    def add(self, item: Item) -> None:
        """Add an item where it stands."""
        self.items.append(item)
        p = item.placement
        self.bodies = stacked([self.bodies, item.shape.body.placed(p.position, p.yaw, UNIT)])
        self.keeps = stacked([self.keeps, item.shape.keep.placed(p.position, p.yaw, UNIT)])
        self.accesses = stacked([self.accesses, item.shape.access.placed(p.position, p.yaw, UNIT)])
        strip = self._strip(item)
        if strip is not None:
            self.strips.append(strip)

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

    def _open_floor(self, item: Item) -> bool:
        """Whether with the item the doors stay joined, and what opens can still be stood at."""
        p = item.placement
        body = item.shape.body.placed(p.position, p.yaw, UNIT)
        low, high = self.site.elevation + self.site.step, self.site.elevation + self.site.height
        if not len(body) or body.z[:, 0].min() >= high or body.z[:, 1].max() <= low:
            return True
        walked = self.site.walk(stacked([self.bodies, body]))
        if self._doors(walked) < self.doors:
            return False
        label = self.site.entered(walked)
        if self.enters and not self._enters(walked, label):
            return False
        own = self._strip(item)
        strips = self.strips if own is None else [*self.strips, own]
        return all(bool((walked.labels[strip] == label).any()) for strip in strips)

    def _enters(self, walked: Walk, label: int) -> bool:
        """Whether the robot gets from the doors into the room itself."""
        return bool((walked.labels[self.site.floor.room >= 0] == label).any()) and label > 0

    def _doors(self, walked: Walk) -> int:
        """Return how many doors open to the part that most doors open to."""
        label = self.site.entered(walked)
        return self.site.door_labels(walked).count(label) if label else 0

    def _strip(self, item: Item) -> NDArray[np.bool_] | None:
        """Return the cells in which one can stand to open the item: the outer part of its access place."""
        p = item.placement
        if not item.shape.opens or not len(item.shape.access):
            return None
        low, high = item.shape.access.corners[0].min(0), item.shape.access.corners[0].max(0)
        near = low[1] + self.settings.access_depth - self.site.radius
        outer = np.array([[low[0], low[1]], [high[0], low[1]], [high[0], near], [low[0], near]])
        c, s = np.cos(p.yaw), np.sin(p.yaw)
        raster = self.site.floor.raster
        return raster.fill(raster.empty(), [outer @ np.array([[c, s], [-s, c]]) + p.position[:2]])


def _own(prisms: Prisms) -> tuple[Floats, NDArray[np.int64], Floats]:
    return np.ascontiguousarray(prisms.corners), prisms.count, np.ascontiguousarray(prisms.z)


def _others(prisms: Prisms) -> tuple[Floats, NDArray[np.int64], Floats, Floats]:
    return np.ascontiguousarray(prisms.corners), prisms.count, np.ascontiguousarray(prisms.z), prisms.boxes()
