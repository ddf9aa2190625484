"""Command: trains the net of the image metrics on plan views of the training rooms, and writes weights/features.safetensors.

Not a stage of `dvc repro`: the weights are released, so that figures of different runs are in one measure. The released ones were
trained on the rooms of preset `release`, some minutes on a GPU; without one it takes hours.
"""

import os
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import torch

from pipeline import params, seeds, taxonomy
from pipeline.entry import run
from pipeline.execution import cores
from pipeline.features import net as nets
from pipeline.features.net import Examples, train
from pipeline.metrics.layout_features import summaries
from pipeline.metrics.relations import furniture
from pipeline.metrics.views import HARMS, STATES, views_of
from pipeline.relations.arrangement import Arrangement, rooms_of

ROOMS = 30_000  # training rooms at most, each as it is and with each harm
STEPS = 12_000
PORTION = 200  # rooms that a process draws at a time


def main(root: Path) -> None:
    """Train, and write the weights."""
    seed = params.read(root / "params.yaml")["seed"]
    torch.manual_seed(seed)
    torch.set_num_threads(1)
    known = taxonomy.load()
    rooms = [room for room in map(furniture, rooms_of(root / "data" / "tables", "train")) if room.categories]
    rooms = [rooms[k] for k in np.linspace(0, len(rooms) - 1, min(ROOMS, len(rooms))).astype(int)]
    examples = drawn(rooms, seed, known.layout_types)
    net = nets.ViewNet(len(known.layout_types), len(STATES), examples.layout.shape[1])
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    for said in train(seeds.generator(seed, "features"), net, examples, STEPS, device):
        sys.stdout.write(f"step {said.done} of {STEPS}: loss {said.loss}, rooms {said.rooms}, states {said.states}\n")
        sys.stdout.flush()
    net.cpu()
    nets.standardise(net, examples.views[examples.states == 0])
    nets.store(root / "weights" / "features.safetensors", net, nets.header(known.layout_types, STATES, known.names))


def drawn(rooms: Sequence[Arrangement], seed: int, layout_types: Sequence[str]) -> Examples:
    """Draw rooms as they are and with each harm, in all processes."""
    portions = [(rooms[k : k + PORTION], seed, k, tuple(layout_types)) for k in range(0, len(rooms), PORTION)]
    with ProcessPoolExecutor(cores(), mp_context=get_context("spawn")) as pool:
        parts = list(pool.map(portion, portions))
    return Examples(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def portion(of: tuple[Sequence[Arrangement], int, int, tuple[str, ...]]) -> Examples:
    """Draw some rooms: `of` are they, the seed, the number of the first of them, and the room types in order."""
    rooms, seed, first, layout_types = of
    rng = seeds.generator(seed, "features", first)
    every = [rooms, *([harm(rng, room) for room in rooms] for harm in HARMS.values())]
    kinds = np.array([layout_types.index(room.layout_type) for room in rooms])
    views, layout = ([part(sample) for sample in every] for part in (views_of, summaries))
    return Examples(np.concatenate(views), np.tile(kinds, len(every)), np.repeat(np.arange(len(every)), len(rooms)), np.concatenate(layout))


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    run(main)
