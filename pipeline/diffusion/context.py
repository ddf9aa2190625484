"""What the layout model is asked (a room) and what it answers (proposals): plain numpy, world frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from pipeline.entities.plan import Opening, OpeningKind, Plan


class Library(Protocol):
    """What the sampler asks of the asset library while it guides: the retrieval index of a layer above is one."""

    def lookup(
        self,
        tastes: Sequence[Any],
        categories: Sequence[Sequence[str | None]],
        positions: NDArray[np.float64],
        sizes: NDArray[np.float64],
        latents: NDArray[np.float64],
    ) -> tuple[NDArray[np.float64], NDArray[np.float32]]:
        """Find the asset that each slot will retrieve: `tastes` (B,) of the rooms; categories (B, N), None for an empty slot; positions and sizes (B, N, 3) [m]; latents (B, N, 32).

        Returns its size as placed (B, N, 3) [m] (the asked one where there is none), and the boxes that its joints sweep
        (B, N, K, 2, 3) [m]: lower and upper corner in the object frame, NaN where a slot has fewer than K.
        """
        ...


@dataclass(frozen=True, slots=True)
class RoomOpening:
    """An opening as one of its rooms sees it.

    `segment` (2, 2) [m, world]; `hinge` is the end of the segment (0 or 1) about which the leaf turns into THIS room,
    or -1 where it turns elsewhere or has none. `sill` [m] above the floor.
    """

    kind: OpeningKind
    segment: NDArray[np.float64]
    sill: float = 0.0
    hinge: int = -1

    @classmethod
    def of(cls, opening: Opening, room_id: str) -> RoomOpening:
        """See `opening` from the room `room_id`."""
        inwards = opening.swing is not None and opening.swing.room_id == room_id
        return cls(opening.kind, opening.segment, opening.sill, opening.swing.hinge if inwards and opening.swing else -1)


@dataclass(frozen=True, slots=True)
class CategoryBounds:
    """How many objects of these categories a room is to have: at least `least`, at most `most` (None: any number)."""

    categories: tuple[str, ...]
    least: int = 0
    most: int | None = None


@dataclass(frozen=True, slots=True)
class RoomContext:
    """A room to furnish.

    `polygon` (n, 2) [m, world], inner wall faces, counter-clockwise. `n_target` is the exact number of objects that is
    asked for, or None; `category_bounds` bound the numbers of categories; `taste` is what the library is asked to suit; where it holds something of the first of two groups in `company`, it holds so many things of the second. `elevation` [m] is the z of the floor, `height` [m] that of the ceiling above it.
    """

    layout_type: str
    polygon: NDArray[np.float64]
    openings: tuple[RoomOpening, ...] = ()
    n_target: int | None = None
    elevation: float = 0.0
    height: float = 2.7
    category_bounds: tuple[CategoryBounds, ...] = ()
    company: tuple[tuple[tuple[str, ...], tuple[str, ...], int], ...] = ()
    taste: Any = None

    @classmethod
    def of(
        cls, plan: Plan, room_id: str, layout_type: str, n_target: int | None = None, category_bounds: tuple[CategoryBounds, ...] = ()
    ) -> RoomContext:
        """Take one room out of a plan."""
        room = plan.room(room_id)
        openings = tuple(RoomOpening.of(o, room_id) for o in plan.openings if room_id in o.rooms)
        return cls(layout_type, room.polygon, openings, n_target, plan.elevation(room_id), room.height, category_bounds)

    @property
    def centre(self) -> NDArray[np.float64]:
        """Centre of the polygon's box (2,) [m, world]: the origin of the room frame, whose axes are the world's."""
        middle: NDArray[np.float64] = (self.polygon.min(0) + self.polygon.max(0)) / 2
        return middle


@dataclass(frozen=True, slots=True)
class Proposal:
    """One object that the model places.

    `position` (3,) [m, world]: bottom centre of the box, storey elevation included; `yaw` [rad] in (-pi, pi]; `size`
    (3,) [m] full extents (w, d, h); `latent` (32,) the shape that is asked for.
    """

    category: str
    position: NDArray[np.float64]
    yaw: float
    size: NDArray[np.float64]
    latent: NDArray[np.float32]
