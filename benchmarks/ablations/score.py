"""Judge what variants have made of the rooms of the held-out split, all of one inventory: a row for each file of `benchmarks.ablations.train`.

    python -m benchmarks.ablations.score FOLDER

Needs data/ and models/ of the same corpus. What a net draws is retrieved from the library as drafts are, nothing is arranged. Rates are
shares of cases in which a relation holds; SCA is a forest's on layout features, FID that of plan views, against the real rooms of the same floors.
"""

import sys
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from benchmarks.ablations.solvers import SOLVERS
from benchmarks.ablations.variants import VARIANTS
from benchmarks.rooms import ROOT, SPLIT, arrangements, jobs_of
from pipeline import params, taxonomy
from pipeline.diffusion.codec import proposals_of
from pipeline.experiments.realism import embeddings, furnished
from pipeline.homes.factory import Factory, load_factory
from pipeline.homes.furnish import context_of, retrieve
from pipeline.homes.request import RoomJob
from pipeline.metrics.layout_features import features
from pipeline.metrics.relations import compare
from pipeline.metrics.two_samples import forest_accuracy, frechet
from pipeline.metrics.views import features_once
from pipeline.relations.arrangement import Arrangement, rooms_of
from pipeline.relations.model import Relations

SHOWN = (
    "chair at its table",
    "coffee table before a sofa",
    "sofa looks at the TV stand",
    "nightstand at the bed",
    "kitchen unit in a run",
    "back at the wall",
    "straight, to 3 degrees",
)


class Made(NamedTuple):
    """What a variant drew: the rooms' names, how many objects each holds, their classes (n,) and metric rows (n, 40), seed after seed."""

    keys: Sequence[str]
    counts: NDArray[np.int64]
    classes: NDArray[np.int64]
    rows: NDArray[np.float32]
    says: str
    steps: int
    parameters: int

    @classmethod
    def read(cls, path: Path) -> "Made":
        """Read a file."""
        with np.load(path) as file:
            facts = (file[name].item() for name in ("says", "steps", "parameters"))
            return cls(file["keys"].tolist(), file["counts"], file["classes"], file["rows"], *facts)

    def seeds(self) -> int:
        """Return how many times each room was furnished."""
        return len(self.classes) // int(self.counts.sum())


def drafts(factory: Factory, made: Made, jobs: Mapping[str, RoomJob], truth: Sequence[Arrangement]) -> list[list[Arrangement]]:
    """Return the rooms of each seed, with the library's assets in them and the openings of the real ones."""
    known, seeds = taxonomy.load(), []
    parts = np.split(np.arange(len(made.classes)), np.cumsum(np.tile(made.counts, made.seeds()))[:-1])
    own = [jobs[key] for key in made.keys]
    for start in range(0, len(parts), len(own)):
        placed = []
        for job, which in zip(own, parts[start : start + len(own)], strict=True):
            context = context_of(job, factory.seed, factory.index)
            things = proposals_of(made.rows[which].astype(float), [known.names[k] for k in made.classes[which]], context)
            placed.append(retrieve(job, context, things, factory.index, known).placements)
        rooms = zip(arrangements(truth, own, placed), truth, strict=True)
        seeds.append([replace(room, name=floor.name) for room, floor in rooms if room.categories])
    return seeds


def main(folder: Path) -> None:
    """Print the table."""
    order = [*VARIANTS, *SOLVERS]
    files = {
        path.stem: Made.read(path)
        for path in sorted(folder.glob("*.npz"), key=lambda path: order.index(path.stem) if path.stem in order else len(order))
    }
    if not files:
        sys.exit(f"sfgen: {folder} holds no variant; run `python -m benchmarks.ablations.train {folder} 1500` first")
    tables = ROOT / "data" / "tables"
    factory, jobs = load_factory(ROOT, params.read(ROOT / "params.yaml"), 0), jobs_of(SPLIT)
    real = {room.name: room for room in furnished(rooms_of(tables, SPLIT))}
    known, view = Relations.load(tables / "relations.json"), features_once(embeddings("")["plan-view net"])
    names = next(iter(files.values())).keys
    truth = [real[name] for name in names]
    print(f"| {len(names)} rooms | steps | parameters | " + " | ".join(SHOWN) + " | SCA | FID |\n" + "|---" * (len(SHOWN) + 5) + "|")
    for name, made in files.items():
        sets = drafts(factory, made, jobs, truth)
        rates = compare(np.random.default_rng(0), {"real": truth, "made": [room for rooms in sets for room in rooms]}, known)["rates"]
        if name == next(iter(files)):
            print("| real | | | " + " | ".join(f"{rates[rule]['real']['rate']:.2f}" for rule in SHOWN) + " | | |")
        sca = np.mean(
            [forest_accuracy(k, features(truth), features(rooms), names, [r.name for r in rooms])["rate"] for k, rooms in enumerate(sets)]
        )
        fid = np.mean([frechet(view(truth), view(rooms)) for rooms in sets])
        shown = " | ".join(f"{rates[rule]['made']['rate']:.3f}" for rule in SHOWN)
        print(f"| {made.says} | {made.steps} | {made.parameters} | {shown} | {sca:.3f} | {fid:.2f} |", flush=True)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(Path(sys.argv[1]))
