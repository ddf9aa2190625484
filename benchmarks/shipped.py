"""The rooms of a dataset beside the rooms of the held-out split: `python benchmarks/shipped.py [DATASET] [DRAWS]`.

Needs what `make run` leaves in data/tables. Homes that ship stand on floors of their own, so pairs of rooms of like type and area are drawn, several
times: FID and KID of plan views, both classifiers, each beside what training rooms reach against the same real rooms. Relation rates are over all
rooms. The 32 homes of `make run` hold too few rooms for a steady figure: give a dataset of some hundred homes.
"""

import os
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]


def main(dataset: Path, draws: int) -> None:
    """Draw, measure, print."""
    from pipeline.experiments.realism import alike, embeddings, furnished, shipped_rooms
    from pipeline.metrics.layout_features import features
    from pipeline.metrics.relations import compare
    from pipeline.metrics.two_samples import forest_accuracy, frechet, kernel_distance, linear_accuracy
    from pipeline.metrics.views import features_once
    from pipeline.relations.arrangement import rooms_of
    from pipeline.relations.model import Relations

    tables = ROOT / "data" / "tables"
    real, train = (furnished(rooms_of(tables, split)) for split in ("test", "train"))
    shipped = shipped_rooms(dataset)
    embed = features_once(embeddings("")["plan-view net"])
    print(
        f"{len(shipped)} rooms of {dataset}, {len(real)} of the test split, {draws} draws of pairs of like type and area; sd over the draws"
    )
    figures: dict[str, list[float]] = {}
    for seed in range(draws):
        rng = np.random.default_rng(seed)
        one, made = alike(rng, real, shipped)
        floor = alike(rng, one, train)
        for name, (own, other) in {"shipped": (one, made), "train": floor}.items():
            names = [room.name for room in own], [room.name for room in other]
            views = embed(own), embed(other)
            for figure, value in (
                ("rooms", len(own)),
                ("FID", frechet(*views)),
                ("KID", kernel_distance(rng, *views)["mean"]),
                ("SCA of the forest", forest_accuracy(seed, features(own), features(other), *names)["rate"]),
                ("SCA on plan views", linear_accuracy(seed, *views, *names)["rate"]),
            ):
                figures.setdefault(f"{figure}, {name}", []).append(value)
    for name, values in sorted(figures.items()):
        print(f"  {name:28s} {np.mean(values):8.4f} +- {np.std(values):.4f}")
    rates = compare(
        np.random.default_rng(0), {"real": real, "train": train, "shipped": shipped}, Relations.load(tables / "relations.json")
    )["rates"]
    print("share of cases in which it holds: real, train, shipped; shipped of real")
    for name, of in rates.items():
        in_test, in_train, in_shipped = (float(of[key]["rate"]) for key in ("real", "train", "shipped"))
        print(
            f"  {name:42s} {in_test:.3f}  {in_train:.3f}  {in_shipped:.3f}   {in_shipped / max(in_test, 1e-9):.2f}   n {of['shipped']['n']}"
        )


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "data" / "shards", int(sys.argv[2]) if len(sys.argv) > 2 else 6)
