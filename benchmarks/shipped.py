"""The rooms of a dataset beside the rooms of the held-out split: `python benchmarks/shipped.py [DATASET] [DRAWS]`.

Needs what `make run` leaves in data/tables. Homes that ship stand on floors of their own, so pairs of rooms of like type and area are drawn, several
times: FID and KID of plan views, both classifiers, each beside what training rooms reach against the same real rooms. Relation rates are over all
rooms. The 32 homes of `make run` hold too few rooms for a steady figure: give a dataset of some hundred homes.
"""

import os
import sys
from collections import defaultdict
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np
from rooms import ROOT, print_rates

from pipeline.experiments.dataset import dataset_coherence
from pipeline.experiments.realism import alike, embeddings, furnished, layout_figures, shipped_rooms
from pipeline.metrics.relations import compare
from pipeline.metrics.views import compare_views, features_once
from pipeline.relations.arrangement import rooms_of
from pipeline.relations.model import Relations
from pipeline.tables import read
from schemas import OBJECTS, SCENES


def main(dataset: Path, draws: int) -> None:
    """Draw, measure, print."""
    tables = ROOT / "data" / "tables"
    real, train = (furnished(rooms_of(tables, split)) for split in ("test", "train"))
    shipped = shipped_rooms(dataset)
    embed = features_once(embeddings("")["plan-view net"])
    print(
        f"{len(shipped)} rooms of {dataset}, {len(real)} of the test split, {draws} draws of pairs of like type and area; sd over the draws"
    )
    figures: dict[str, list[float]] = defaultdict(list)
    for seed in range(draws):
        rng = np.random.default_rng(seed)
        one, made = alike(rng, real, shipped, 1)[0]
        for name, (own, other) in {"shipped": (one, made), "train": alike(rng, one, train, 1)[0]}.items():
            views = compare_views(rng, seed, embed, own, {name: other})[name]
            figures[f"rooms, {name}"].append(len(own))
            figures[f"FID, {name}"].append(views["fid"])
            figures[f"KID, {name}"].append(views["kid"]["mean"])
            figures[f"SCA on plan views, {name}"].append(views["sca"]["rate"])
            figures[f"SCA of the forest, {name}"].append(layout_figures(seed, {name: (own, other)}, {})["made"][name]["rate"])
    for name, values in sorted(figures.items()):
        print(f"  {name:28s} {np.mean(values):8.4f} +- {np.std(values):.4f}")
    print("share of cases in which it holds, and of the real share: real, train, shipped")
    sets = {"real": real, "train": train, "shipped": shipped}
    print_rates(compare(np.random.default_rng(0), sets, Relations.load(tables / "relations.json")))
    print("whether things go together, and how many a home has: real, shipped")
    split = {row["scene_id"] for row in read(tables / "scenes.parquet", SCENES) if row["split"] == "test"}
    held_out = [row for row in read(tables / "objects.parquet", OBJECTS) if row["scene_id"] in split]
    for name, of in dataset_coherence(ROOT, np.random.default_rng(0), held_out, dataset).items():
        print(f"  {name:30s} " + "   ".join(f"{v['mean']:7.3f} ({v['low']:.2f}-{v['high']:.2f}) of {v['n']}" for v in of.values()))


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "data" / "shards", int(sys.argv[2]) if len(sys.argv) > 2 else 6)
