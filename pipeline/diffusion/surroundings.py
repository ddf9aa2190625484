"""How the objects of several rooms stand in tensors, and see each other: padded to one shape (`padded`), or in one list (`ragged`)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Protocol

from torch import Tensor

from pipeline.diffusion.relations import Boxes, Relations


class Surroundings(NamedTuple):
    """What objects look at: of each pair the features that are `seen` (..., R), `scores` by layer, those of the pointers last, and `offers` (..., 2 K)."""

    seen: Tensor
    scores: Sequence[Tensor]
    offers: Tensor


class BatchLayout(Protocol):
    """The rooms of a batch, as the network asks about them. Tokens are (B, N, d) of padded rooms, (T, d) of a list."""

    def to_objects(self, by_room: Tensor) -> Tensor:
        """Hand what belongs to rooms (B, d) to their objects."""
        ...

    def split_keys(self, keys: Tensor, parts: int) -> Sequence[Tensor]:
        """Split keys of floor tokens (B, M, parts * d) into `parts`."""
        ...

    def pairs(self, boxes: Boxes, blur: Tensor) -> Relations:
        """Relate objects to each other; `blur` (B, 2) is the noise of a position [m] and of an axis."""
        ...

    def walls(self, boxes: Boxes, blur: Tensor) -> Relations:
        """Relate objects to walls and openings."""
        ...

    def axis_deviations(self, boxes: Boxes, blur: Tensor) -> Tensor:
        """Return how far axes are from those of their rooms, in units of the noise."""
        ...

    def pair_scores(self, scores: Tensor) -> Sequence[Tensor]:
        """Split scores of pairs (..., L H) by layer."""
        ...

    def wall_scores(self, scores: Tensor) -> Sequence[Tensor]:
        """Split scores of walls and openings (..., L H) by layer."""
        ...

    def look_around(self, looks: Tensor, around: Surroundings, layer: int) -> Tensor:
        """Return what objects see of each other (..., d + H R); `looks` (..., 3 d) are queries, keys and values."""
        ...

    def look_at_floor(self, queries: Tensor, key: Tensor, value: Tensor, around: Surroundings, layer: int) -> Tensor:
        """Return what objects see of the floor (..., d + H R); keys and values are two of `split_keys`."""
        ...

    def take_offers(self, points: Tensor, key: Tensor, walls: Surroundings, pairs: Surroundings, amounts: Sequence[Tensor]) -> Tensor:
        """Return the sums (..., 2, 2) of what walls and objects offer, a move and a turn.

        `points` (..., 3 d): queries to walls and to objects, keys of objects; `amounts` of the walls' offers and of the objects', (..., H K) each.
        """
        ...
