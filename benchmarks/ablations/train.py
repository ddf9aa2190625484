"""Train variants one after the other, and furnish the rooms of the held-out split with each.

    python -m benchmarks.ablations.train FOLDER STEPS [variant ...]

Writes FOLDER/<variant>.npz: what stands in the rooms, and what training took. Several of these share a GPU well.
"""

import os
import sys
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from unittest.mock import patch

os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np
import torch

from benchmarks.ablations.drawing import EVALUATIONS, held_out, write_rooms
from benchmarks.ablations.variants import VARIANTS, Variant
from pipeline import taxonomy
from pipeline.diffusion import training
from pipeline.diffusion.checkpoint import Header
from pipeline.diffusion.codec import Normalisation
from pipeline.diffusion.job import rooms_of
from pipeline.diffusion.rooms import Example, Sets, read_sets, stacked
from pipeline.diffusion.settings import ModelSettings, TrainSettings
from pipeline.diffusion.training import Trainer, train

ROOT = Path(__file__).resolve().parents[2]
SETTINGS = TrainSettings(constraint=False, ema=0.999, steps=0)


def main(folder: Path, steps: int, names: Sequence[str]) -> None:
    """Train, furnish, write."""
    sets = read_sets(ROOT, SETTINGS.slots)
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    folder.mkdir(parents=True, exist_ok=True)
    for name in names or VARIANTS:
        start = time.perf_counter()
        trainer, header = trained(VARIANTS[name], sets, steps, device)
        spent, tested = time.perf_counter() - start, held_out(sets)
        facts = {"says": VARIANTS[name].says, "steps": trainer.done, "parameters": sum(p.numel() for p in trainer.net.parameters())}
        write_rooms(folder / f"{name}.npz", trainer.average, header, tested, EVALUATIONS, device, facts)
        print(f"{name}: {trainer.done} steps, {spent:.0f} s", flush=True)


def trained(variant: Variant, sets: Sets, steps: int, device: torch.device) -> tuple[Trainer, Header]:
    """Train a variant."""
    rooms = part_of(sets.train, variant.houses)
    settings = replace(SETTINGS, model=ModelSettings(**variant.model), **variant.train)
    words = taxonomy.load()
    header = Header(Normalisation.of(*stacked(rooms), words.names), words.layout_types, settings.slots, settings.model, 8)
    data = rooms_of(rooms, header, device)
    if variant.true_share:
        data = data._replace(weights=np.full(len(rooms), 1 / len(rooms)))
    torch.manual_seed(variant.seed)
    start = variant.net(header.norm, len(header.layouts), header.model)
    trainer = Trainer(variant.seed, header, settings, round(steps * variant.steps), 1, device, start=start)
    with patch.multiple(training, draw=variant.draw, denoising_loss=variant.loss):
        for _ in train(trainer, data):
            pass
    return trainer, header


def part_of(rooms: Sequence[Example], houses: int) -> Sequence[Example]:
    """Return the rooms of so many houses; 0: of all."""
    if not houses:
        return rooms
    kept = set(sorted({room.key.split("/")[0] for room in rooms})[:houses])
    return [room for room in rooms if room.key.split("/")[0] in kept]


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    main(Path(sys.argv[1]), int(sys.argv[2]), sys.argv[3:])
