"""Homes as PyTorch tensors."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch.utils.data import Dataset

from sfgen.dataset import load
from sfgen.homes import Home

Item = dict[str, Any]


class HomeDataset(Dataset[Item]):
    """A map-style dataset with one item per home; `categories` and `room_types` are what the indices stand for.

    An item holds, for n objects: `position` (n, 3) [m], `yaw` (n,) [rad], `size` (n, 3) [m], `category` (n,) int64,
    `room` (n,) int64 (which of the home's rooms), `openable` (n,) bool, `latent` (n, 32); for m rooms: `room_type`
    (m,) int64, `area` (m,) [m2], `polygon` (a tuple of m (k, 2) tensors [m]); and `scene_id`.
    """

    def __init__(self, path: str | Path, split: str | None = None) -> None:
        everything = load(path)
        self.homes = everything if split is None else everything.split(split)
        self.categories = everything.categories()
        self.room_types = tuple(sorted(set(everything.table("rooms")["type"].to_pylist()))) if len(everything) else ()

    def __len__(self) -> int:
        return len(self.homes)

    def __getitem__(self, index: int) -> Item:
        return self.item(self.homes[index])

    def item(self, home: Home) -> Item:
        """Turn one home into tensors."""
        rooms = {room.room_id: i for i, room in enumerate(home.rooms)}
        n = len(home.objects)
        return {
            "scene_id": home.scene_id,
            "position": _floats([o.position for o in home.objects], (n, 3)),
            "yaw": _floats([o.yaw for o in home.objects], (n,)),
            "size": _floats([o.size for o in home.objects], (n, 3)),
            "latent": _floats([o.latent for o in home.objects], (n, 32)),
            "category": torch.tensor([self.categories.index(o.category) for o in home.objects], dtype=torch.int64),
            "room": torch.tensor([rooms[o.room_id] for o in home.objects], dtype=torch.int64),
            "openable": torch.tensor([o.openable for o in home.objects], dtype=torch.bool),
            "room_type": torch.tensor([self.room_types.index(r.type) for r in home.rooms], dtype=torch.int64),
            "area": _floats([r.area for r in home.rooms], (len(home.rooms),)),
            "polygon": tuple(torch.from_numpy(r.polygon.astype(np.float32)) for r in home.rooms),
        }


def collate(items: Sequence[Item]) -> Item:
    """Make a batch: tensors are padded with zeros to the longest, `objects` (b, n) and `rooms` (b, m) say what is real."""
    batch: Item = {"scene_id": [item["scene_id"] for item in items], "polygon": [item["polygon"] for item in items]}
    for name in (k for k, v in items[0].items() if isinstance(v, torch.Tensor)):
        batch[name] = torch.nn.utils.rnn.pad_sequence([item[name] for item in items], batch_first=True)
    for name, like in (("objects", "yaw"), ("rooms", "area")):
        real = [torch.ones(len(item[like]), dtype=torch.bool) for item in items]
        batch[name] = torch.nn.utils.rnn.pad_sequence(real, batch_first=True)
    return batch


def _floats(values: list[Any], shape: tuple[int, ...]) -> torch.Tensor:
    return torch.from_numpy(np.array(values, np.float32).reshape(shape))
