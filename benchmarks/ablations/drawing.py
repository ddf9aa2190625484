"""What a net makes of the rooms of the held-out split when it is told what they hold."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray

from benchmarks.ablations.nets import DiscreteChain
from pipeline.diffusion.batch import room_batch
from pipeline.diffusion.checkpoint import Header
from pipeline.diffusion.inventory import Inventory
from pipeline.diffusion.rooms import Example, Sets
from pipeline.diffusion.sampling import Sampler
from pipeline.diffusion.set_transformer import SetTransformer
from pipeline.diffusion.settings import SampleSettings

ROOMS = 700  # of the test split
SEEDS = 2
EVALUATIONS = 12
BATCH = 256  # rooms

Rows = tuple[NDArray[np.int64], NDArray[np.float32]]


def held_out(sets: Sets) -> list[Example]:
    """Return rooms of the test split, evenly spread over it."""
    return [sets.test[k * len(sets.test) // ROOMS] for k in range(ROOMS)] if len(sets.test) > ROOMS else list(sets.test)


def write_rooms(
    path: Path,
    net: SetTransformer,
    header: Header,
    rooms: Sequence[Example],
    evaluations: int,
    device: torch.device,
    facts: Mapping[str, Any],
) -> None:
    """Furnish rooms SEEDS times and write what stands in them, with what the table says of the net."""
    made = [furnished(net, header, rooms, seed, evaluations, device) for seed in range(SEEDS)]
    classes, rows = (np.concatenate([part[k] for part in made]) for k in (0, 1))
    keys, counts = np.array([e.key for e in rooms]), np.array([len(e.classes) for e in rooms])
    np.savez_compressed(path, keys=keys, counts=counts, classes=classes, rows=rows, **facts)


def furnished(net: SetTransformer, header: Header, rooms: Sequence[Example], seed: int, evaluations: int, device: torch.device) -> Rows:
    """Furnish rooms with what the real ones hold: classes (n,) and metric rows (n, 40) of their objects, room frame, in the rooms' order."""
    if isinstance(net, DiscreteChain):
        return chained(net, header, rooms, seed, evaluations, device)
    settings = SampleSettings(evaluations, articulation="none", snap_below=0, batch=BATCH)
    sampler = Sampler(net, Inventory(len(header.norm.classes), 1, 8), header, settings, seed)
    keys = [(k, 0, 0) for k in range(len(rooms))]
    made = sampler.arrange([e.context for e in rooms], keys, [np.sort(e.classes) for e in rooms], [e.floor for e in rooms])
    order = {name: k for k, name in enumerate(header.norm.classes)}
    rows = [
        np.concatenate([p.position - [*e.context.centre, e.context.elevation], p.size, [np.cos(p.yaw), np.sin(p.yaw)], p.latent])
        for e, own in zip(rooms, made, strict=True)
        for p in own
    ]
    return np.array([order[p.category] for own in made for p in own]), np.array(rows, np.float32)


def chained(net: DiscreteChain, header: Header, rooms: Sequence[Example], seed: int, evaluations: int, device: torch.device) -> Rows:
    """Furnish rooms with as many objects as the real ones hold, the classes drawn beside the geometry."""
    rng = torch.Generator().manual_seed(seed)
    classes, rows = [], []
    for start in range(0, len(rooms), BATCH):
        part = rooms[start : start + BATCH]
        batch = room_batch([e.floor for e in part], [e.layout for e in part], [e.context.height for e in part]).trimmed().to(device)
        occupied = torch.arange(header.slots)[None] < torch.tensor([len(e.classes) for e in part])[:, None]
        drawn, x0 = net.draw(batch, occupied.to(device), rng, evaluations)
        metric = net.codec.metric(x0, drawn)
        classes.append(drawn[occupied.to(device)].cpu().numpy())
        rows.append(metric[occupied.to(device)].cpu().numpy())
    return np.concatenate(classes), np.concatenate(rows).astype(np.float32)
