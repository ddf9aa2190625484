"""Guidance: how what a sampling step expects is moved so that the constraint functions phi go down.

phi are penalties: lower is better, differentiable in the slots they judge. The paper prints the guidance as mu + lambda Sigma grad phi, with phi a
loss (a cross-entropy, a sum of overlaps). Followed to the letter that CLIMBS the penalty. Everything here that is called a
`descent` is therefore -grad phi, and is added, times a step length. Sigma is 1e-4 and less in the paper's window and would
only rescale lambda: step lengths are given in the unit of what moves, and clipped. It is the expected x0 that is moved, and so the mean of
the step with it; a later step can then bring back what the guidance has torn apart.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import torch
from torch import Tensor

from pipeline.arrays import Bools, Floats, Ints
from pipeline.diffusion.articulated_collision import LEAST, SHORT, Furniture, Obstacles, articulated_collision, descend
from pipeline.diffusion.batch import RoomBatch
from pipeline.diffusion.codec import POSITION, SHAPE, SIZE, YAW, Codec
from pipeline.diffusion.context import Library
from pipeline.diffusion.schedule import lambda_of
from pipeline.diffusion.settings import SampleSettings
from pipeline.geometry.beside import sideways

BOX = slice(0, YAW.stop)  # channels of the geometry: position, size, cos and sin of yaw
PRESSED = 0.01  # [m] of overlap from which on a smaller asset is asked for, and a room is drawn again
LESS = 1e-4  # [m2] of floor from which on an asset is smaller


@dataclass(frozen=True, slots=True)
class Guidance:
    """What guides a batch of B rooms.

    What stands still in them (`obstacles`), their tastes, the classes of slots (B, N) with C for padding, the names of the classes, the library, the
    classes that open (C + 1,), pairs of slots that may share a place (B, N, N).
    """

    obstacles: Obstacles
    tastes: Sequence[Any]
    classes: Ints
    names: Sequence[str]
    library: Library | None
    opens: Bools
    tucked: Bools
    settings: SampleSettings

    @classmethod
    def of(
        cls,
        codec: Codec,
        rooms: RoomBatch,
        tastes: Sequence[Any],
        classes: Tensor,
        library: Library | None,
        opens: Bools,
        tucks: Ints,
        settings: SampleSettings,
    ) -> Guidance:
        """Return the guidance of rooms whose slots are of `classes` (B, N); by class (C + 1,) `opens`, and `tucks`: 1 for what stands under tables, 2 for tables."""
        labels = classes.cpu().numpy()
        role = tucks[labels]
        return cls(Obstacles.of(rooms), tastes, labels, codec.norm.classes, library, opens, role[:, :, None] + role[:, None] == 3, settings)

    def step(self, codec: Codec, x0: Tensor, level: float) -> Tensor:
        """Return the expected clean channels x0 (B, N, 40) at a level (lambda) as they are wanted."""
        s = self.settings
        snaps = self.library is not None and s.snap_below > 0 and level > lambda_of(s.snap_below)
        guides = s.articulation != "none" and level > lambda_of(s.articulation_below)
        if not (snaps or guides):
            return x0
        expected, classes = self._metric(codec, x0)
        boxes, shapes = expected[..., BOX], expected[..., SHAPE]
        size, sweeps = self.find_assets(boxes, shapes)
        moved = resized(boxes, size, self.classes < len(self.names)) if snaps else boxes
        if guides:
            sweeps = self._counted(moved, sweeps)
            moved = self.push_apart(moved, sweeps)
            if snaps and s.articulation == "joints":
                moved = self._with_smaller_assets(moved, shapes, sweeps)
        shifted = x0.clone()
        shifted[..., BOX] += torch.from_numpy(moved - boxes).to(x0) / codec.scale[classes, BOX]
        return shifted

    def pressure(self, codec: Codec, x0: Tensor) -> Floats:
        """Return the deepest overlap (B,) [m] that is left in each room; 0 where nothing guides."""
        if self.settings.articulation == "none" or self.library is None:
            return np.zeros(len(x0))
        expected, _ = self._metric(codec, x0)
        boxes = expected[..., BOX]
        sweeps = self._counted(boxes, self.find_assets(boxes, expected[..., SHAPE])[1])
        return articulated_collision(boxes, self._furniture(sweeps), self.obstacles)[2]

    def _metric(self, codec: Codec, x0: Tensor) -> tuple[Floats, Tensor]:
        """Return the channels x0 (B, N, 40) in metres, and the classes on their device."""
        classes = torch.from_numpy(self.classes).to(x0.device)
        return codec.metric(x0, classes).double().cpu().numpy(), classes

    def _counted(self, boxes: Floats, sweeps: Floats | None) -> Floats | None:
        """Return what counts as extended state of boxes (B, N, 8): what their assets' joints sweep, or the paper's heuristic."""
        return heuristic_sweeps(boxes[..., SIZE], self.opens[self.classes]) if self.settings.articulation == "heuristic" else sweeps

    def _furniture(self, sweeps: Floats | None) -> Furniture:
        return Furniture.of(self.classes < len(self.names), sweeps, self.tucked)

    def push_apart(self, boxes: Floats, sweeps: Floats | None) -> Floats:
        """Return boxes (B, N, 8) pushed apart."""
        s = self.settings
        return descend(boxes, self._furniture(sweeps), self.obstacles, s.articulation_steps, s.articulation_scale, s.turn_scale, s.clip)

    def _with_smaller_assets(self, boxes: Floats, shapes: Floats, sweeps: Floats | None) -> Floats:
        """Return boxes (B, N, 8) with the next smaller asset of its kind for what is still pressed between others, and these rooms pushed apart again.

        Where a row is too long for its wall, pushing alone shares the overlap out. An asset is smaller by what reaches into it.
        """
        excess = 2 * np.maximum(articulated_collision(boxes, self._furniture(sweeps), self.obstacles)[1][..., SIZE], 0.0)
        excess[excess.max(-1) <= PRESSED] = 0.0
        rooms = np.flatnonzero(excess.any((1, 2)))
        if not len(rooms):
            return boxes
        few, own = self._of_rooms(rooms), excess[rooms]
        asked = boxes[rooms]
        asked[..., SIZE] -= own
        size, others = few.find_assets(asked, shapes[rooms])
        smaller = (own > 0).any(-1) & (size[..., :2].prod(-1) < boxes[rooms][..., 3:5].prod(-1) - LESS)
        chosen = sweeps[rooms] if sweeps is not None else None
        if chosen is not None and others is not None:
            chosen = np.where(smaller[..., None, None, None], others, chosen)
        moved = boxes.copy()
        moved[rooms] = few.push_apart(
            np.where(smaller[..., None], resized(boxes[rooms], size, few.classes < len(self.names)), boxes[rooms]), chosen
        )
        return moved

    def _of_rooms(self, rows: Ints) -> Guidance:
        """Return the guidance of some rooms of the batch."""
        tastes = [self.tastes[i] for i in rows]
        return replace(self, obstacles=self.obstacles.rows(rows), tastes=tastes, classes=self.classes[rows], tucked=self.tucked[rows])

    def find_assets(self, boxes: Floats, shapes: Floats) -> tuple[Floats, Floats | None]:
        """Ask the library for each object's asset: its size (B, N, 3) [m] and its sweeps (B, N, K, 2, 3) [m]."""
        size = np.maximum(boxes[..., SIZE], LEAST)
        if self.library is None:
            return size, None
        names = [[self.names[c] if c < len(self.names) else None for c in row] for row in self.classes]
        placed, sweeps = self.library.lookup(self.tastes, names, boxes[..., POSITION], size, shapes)
        return placed, sweeps.astype(np.float64)


def heuristic_sweeps(size: Floats, opens: Bools) -> Floats:
    """Return the paper's stand-in for joints (B, N, 1, 2, 3): the box grows by a third of its depth to the front.

    `size` (B, N, 3) [m]; `opens` (B, N) says which classes count as articulated. Depth h becomes h + h / 3.
    """
    w, d, h = np.moveaxis(size, -1, 0)
    low, high = np.stack([-w / 2, -d / 2 - d / 3, np.zeros_like(h)], -1), np.stack([w / 2, d / 2, h], -1)
    return np.where(opens[..., None, None], np.stack([low, high], -2), np.nan)[:, :, None]


def resized(boxes: Floats, size: Floats, there: Bools) -> Floats:
    """Return boxes (B, N, 8) of the given sizes (B, N, 3) [m], their backs where they were, and as far from what they flank; slots that are `there` (B, N) count."""
    length = np.maximum(np.hypot(boxes[..., 6], boxes[..., 7]), SHORT)
    grown = (size[..., 1] - boxes[..., 4]) / 2 / length
    changed, yaws = boxes.copy(), np.arctan2(boxes[..., 7], boxes[..., 6])
    places, before = np.ascontiguousarray(boxes[..., POSITION]), np.where(there[..., None], boxes[..., SIZE], 0.0)
    for room, out in enumerate(changed):
        out[:, :2] += sideways(places[room], yaws[room], before[room], size[room])
    changed[..., 0] += boxes[..., 7] * grown
    changed[..., 1] -= boxes[..., 6] * grown
    changed[..., SIZE] = size
    return changed
