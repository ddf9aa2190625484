"""Command: trains the net of the image metrics on plan views of the training rooms, and writes weights/features.safetensors.

Not a stage of `dvc repro`: the weights are released, so that figures of different runs are in one measure. Takes four CPU minutes.
"""

import sys
from pathlib import Path

import numpy as np
import torch

from pipeline import params, seeds, taxonomy
from pipeline.entry import run
from pipeline.features import net as nets
from pipeline.features.training import train
from pipeline.metrics.layout_features import summaries
from pipeline.metrics.perturbations import HARMS
from pipeline.metrics.relations import furniture
from pipeline.metrics.views import STATES, views_of
from pipeline.relations.arrangement import rooms_of

ROOMS = 6000  # training rooms, each as it is and harmed
EPOCHS = 12
SHARES = (0.25, 0.5, 0.25)  # of the harms: yaws are the hardest to see


def main(root: Path) -> None:
    """Train, and write the weights."""
    seed = params.read(root / "params.yaml")["seed"]
    rng = seeds.generator(seed, "features")
    torch.manual_seed(seed)
    torch.set_num_threads(1)
    known = taxonomy.load()
    rooms = [room for room in map(furniture, rooms_of(root / "data" / "tables", "train")) if room.categories]
    rooms = [rooms[k] for k in np.linspace(0, len(rooms) - 1, min(ROOMS, len(rooms))).astype(int)]
    harm = rng.choice(len(HARMS), size=len(rooms), p=SHARES)
    harmed = [list(HARMS.values())[k](rng, room) for k, room in zip(harm, rooms, strict=True)]
    kinds = np.array([known.layout_types.index(room.layout_type) for room in rooms])
    states = np.concatenate([np.zeros(len(rooms), int), harm + 1])
    views = np.concatenate([views_of(rooms), views_of(harmed)])
    layout = np.concatenate([summaries(rooms), summaries(harmed)])
    net = nets.ViewNet(len(known.layout_types), len(STATES), layout.shape[1])
    for epoch, said in enumerate(train(rng, net, views, np.tile(kinds, 2), states, layout, EPOCHS)):
        sys.stdout.write(f"epoch {epoch + 1} of {EPOCHS}: loss {said.loss}, rooms {said.rooms}, states {said.states}\n")
    nets.standardise(net, views[: len(rooms)])
    nets.store(root / "weights" / "features.safetensors", net, nets.header(known.layout_types, STATES, known.names))


if __name__ == "__main__":
    run(main)
