"""Homes as PyTorch tensors."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch.utils.data import Dataset, IterableDataset, get_worker_info

from sfgen.dataset import KEPT, load
from sfgen.homes import Home

Item = dict[str, Any]


class HomeDataset(Dataset[Item]):
    """A map-style dataset with one item per home; `categories` and `room_types` are what the indices stand for (those of the whole dataset).

    An item holds, for n objects: `position` (n, 3) [m], `yaw` (n,) [rad], `size` (n, 3) [m], `category` (n,) int64,
    `room` (n,) int64 (which of the home's rooms), `openable` (n,) bool, `latent` (n, 32); for m rooms: `room_type`
    (m,) int64, `area` (m,) [m2], `polygon` (a tuple of m (k, 2) tensors [m]); and `scene_id`.

    Reading in an order that jumps between more shards than a dataset keeps in memory is slow: HomeStream shuffles without that.
    """

    def __init__(self, path: str | Path, split: str | None = None) -> None:
        self.homes = load(path, split)
        self.categories, self.room_types = self.homes.categories(), self.homes.room_types()
        self._numbers = [{name: i for i, name in enumerate(names)} for names in (self.categories, self.room_types)]

    def __len__(self) -> int:
        return len(self.homes)

    def __getitem__(self, index: int) -> Item:
        return tensors(self.homes[index], *self._numbers)


class HomeStream(IterableDataset[Item]):
    """The items of HomeDataset in an order that is shuffled anew in each epoch, at the speed of reading in order.

    Shards are shuffled, and then the homes of every `window` of them in a row. The processes of a DataLoader and the ranks of a
    training share an epoch: no home comes twice, and every rank gets the same number (up to `world` - 1 homes of an epoch are left out).
    Call `set_epoch` before each epoch, as with torch's DistributedSampler. `state_dict` says how far this process has read;
    with `load_state_dict` it goes on there (torchdata's StatefulDataLoader does both in its own processes).
    """

    def __init__(
        self,
        path: str | Path,
        split: str | None = None,
        *,
        seed: int = 0,
        shuffle: bool = True,
        window: int = 8,
        rank: int | None = None,
        world: int | None = None,
    ) -> None:
        if not 1 <= window <= KEPT:
            msg = f"a window of {window} shards cannot be; give 1 to {KEPT}"
            raise ValueError(msg)
        self.data = HomeDataset(path, split)
        self.categories, self.room_types = self.data.categories, self.data.room_types
        self.seed, self.shuffle, self.window = seed, shuffle, window
        together = torch.distributed.is_available() and torch.distributed.is_initialized()
        self.rank = rank if rank is not None else torch.distributed.get_rank() if together else 0
        self.world = world if world is not None else torch.distributed.get_world_size() if together else 1
        self.epoch = self.done = 0

    def __len__(self) -> int:
        return len(self.data) // self.world

    def __iter__(self) -> Iterator[Item]:
        worker = get_worker_info()
        number, count = (worker.id, worker.num_workers) if worker else (0, 1)
        mine = self.order()[self.rank * len(self) : (self.rank + 1) * len(self)]
        for position in mine[number * len(mine) // count + self.done : (number + 1) * len(mine) // count]:
            self.done += 1
            yield self.data[int(position)]
        self.done = 0

    def order(self) -> NDArray[np.int64]:
        """Return the places of all homes (n,) in the order of this epoch."""
        shards = self.data.homes.shards
        if not self.shuffle:
            return np.arange(len(shards))
        rng = np.random.default_rng((self.seed, self.epoch))
        numbers, which = np.unique(shards, return_inverse=True)
        windows = rng.permutation(len(numbers))[which] // self.window
        return np.lexsort((rng.random(len(shards)), windows))

    def set_epoch(self, epoch: int) -> None:
        """Begin another epoch: another order."""
        self.epoch, self.done = epoch, 0

    def state_dict(self) -> dict[str, int]:
        """Return where this process is."""
        return {"epoch": self.epoch, "done": self.done}

    def load_state_dict(self, state: dict[str, int]) -> None:
        """Go on where a process with the same seed, rank, world and number of workers was."""
        self.epoch, self.done = state["epoch"], state["done"]


def tensors(home: Home, categories: dict[str, int], room_types: dict[str, int]) -> Item:
    """Turn one home into tensors, as HomeDataset says."""
    rooms = {room.room_id: i for i, room in enumerate(home.rooms)}
    n = len(home.objects)
    return {
        "scene_id": home.scene_id,
        "position": _floats([o.position for o in home.objects], (n, 3)),
        "yaw": _floats([o.yaw for o in home.objects], (n,)),
        "size": _floats([o.size for o in home.objects], (n, 3)),
        "latent": _floats([o.latent for o in home.objects], (n, 32)),
        "category": torch.tensor([categories[o.category] for o in home.objects], dtype=torch.int64),
        "room": torch.tensor([rooms[o.room_id] for o in home.objects], dtype=torch.int64),
        "openable": torch.tensor([o.openable for o in home.objects], dtype=torch.bool),
        "room_type": torch.tensor([room_types[r.type] for r in home.rooms], dtype=torch.int64),
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
