"""Made rooms beside the rooms of the held-out split, on the same floors, over three seeds.

    python benchmarks/rooms.py [rooms] [seeds]

Needs what `make run` leaves: data/ and models/. Drafts are what the layout model draws, without and with guidance; finished
rooms are what the arranger makes of them. Rates are those of all seeds together, with 95 % intervals. FID of plan views is measured on
training floors, against the split: that of the rooms that stand there is its floor, and no other floors than theirs are in the way.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from pipeline.homes.factory import Factory
    from pipeline.homes.request import RoomJob
    from pipeline.relations.arrangement import Arrangement

ROOT = Path(__file__).resolve().parents[1]
Rooms = list["Arrangement"]


def rooms_of(jobs: Sequence[RoomJob], things: Sequence[Sequence[object]]) -> Rooms:
    """Return proposals or placements of rooms as the metrics read them."""
    from pipeline.metrics.relations import furniture
    from pipeline.relations.arrangement import make_arrangement

    return [
        furniture(
            make_arrangement(str(job.index), job.layout_type, job.room.polygon, [(p.category, p.position, p.yaw, p.size) for p in own])  # type: ignore[attr-defined]
        )
        for job, own in zip(jobs, things, strict=True)
    ]


def furnish_rooms(factory: Factory, jobs: Sequence[RoomJob], seconds: dict[str, float]) -> dict[str, Rooms]:
    """Furnish rooms: drafts unguided and guided, finished; adds CPU seconds by set."""
    from pipeline import taxonomy
    from pipeline.homes.furnish import draft_rooms
    from pipeline.homes.room_finishing import finish

    sets: dict[str, Rooms] = {}
    drafts = []
    for name, sampler in (("unguided", factory.sampler.baseline()), ("guided", factory.sampler)):
        start = time.process_time()
        drafts = draft_rooms(replace(factory, sampler=sampler), jobs)
        seconds[name] = seconds.get(name, 0.0) + time.process_time() - start
        sets[name] = rooms_of(jobs, [draft.placements for draft in drafts])
    start = time.process_time()
    results = [finish(d, factory.library, factory.index, factory.learnt, factory.postopt, factory.verify, taxonomy.load()) for d in drafts]
    seconds["finished"] = seconds.get("finished", 0.0) + time.process_time() - start
    return sets | {"finished": rooms_of(jobs, [result.placements for result in results])}


def main(count: int, seeds: int) -> None:
    """Print relation rates, objects a room, SCA and CPU time."""
    from pipeline import params, tables, taxonomy
    from pipeline.experiments.rooms import spread, test_rooms
    from pipeline.homes.factory import load_factory
    from pipeline.metrics.layout_features import features
    from pipeline.metrics.relations import compare, furniture
    from pipeline.metrics.two_samples import forest_accuracy
    from pipeline.relations import files
    from pipeline.relations.split import rooms_of as real_rooms
    from schemas.openings import OPENINGS
    from schemas.rooms import ROOMS
    from schemas.scenes import SCENES

    tree, folder, split = params.read(ROOT / "params.yaml"), ROOT / "data" / "tables", "test"
    source = {t.name: tables.read(folder / f"{t.name}.parquet", t) for t in (SCENES, ROOMS, OPENINGS)}
    jobs = spread(test_rooms(source, split, taxonomy.load().layout_types), count or 10**9)
    real = {room.name: furniture(room) for room in real_rooms(folder, split)}
    by_index = {job.index: real[f"{row['scene_id']}/{row['room_id']}"] for job, row in rows_of(jobs, source["rooms"])}
    jobs = [job for job in jobs if by_index[job.index].categories]
    truth = [replace(by_index[job.index], name=str(job.index)) for job in jobs]
    sets: dict[str, Rooms] = {"real": truth * seeds}
    seconds: dict[str, float] = {}
    accuracies: dict[str, list[tuple[float, float]]] = {}
    train = {room.name: furniture(room) for room in real_rooms(folder, "train") if room.layout_type}
    floors = [(job, row) for job, row in rows_of(test_rooms(source, "train", taxonomy.load().layout_types), source["rooms"])]
    named = {f"{row['scene_id']}/{row['room_id']}": job for job, row in floors}
    views: dict[str, list[float]] = {}
    for seed in range(seeds):
        factory = load_factory(ROOT, tree, seed)
        for name, fid in views_apart(factory, seed, truth, {k: room for k, room in train.items() if room.categories}, named).items():
            views.setdefault(name, []).append(fid)
        for name, rooms in furnish_rooms(factory, jobs, seconds).items():
            sets.setdefault(name, []).extend(rooms)
            names = [room.name for room in truth]
            pair = [
                forest_accuracy(seed, features(truth, solid=solid), features(rooms, solid=solid), names, names)["rate"]
                for solid in (False, True)
            ]
            accuracies.setdefault(name, []).append((pair[0], pair[1]))
    comparison = compare(np.random.default_rng(0), sets, files.load(folder / "relations.json"))
    print(f"{len(jobs)} rooms of split {split}, {seeds} seeds; share of cases in which it holds, and of the real share")
    for rule, rates in comparison["rates"].items():
        own = max(rates["real"]["rate"], 1e-9)
        cells = [f"{v['rate']:.3f} ({v['low']:.2f}-{v['high']:.2f}) {v['rate'] / own:4.2f}" for k, v in rates.items() if k != "real"]
        print(f"  {rule:42s} {rates['real']['rate']:.3f}  " + "   ".join(cells) + f"   n {rates['real']['n'] // seeds}")
    print("objects a room: real, " + ", ".join(k for k in sets if k != "real"))
    for kind, of in comparison["objects"].items():
        print(f"  {kind:20s} " + "   ".join(f"{v['mean']:6.2f}" for v in of.values()) + f"   n {of['real']['n'] // seeds}")
    print("SCA of a random forest on layout features; the same where what is in another body counts as touching it")
    for name, pairs in accuracies.items():
        print(f"  {name:20s} " + "   ".join(f"{np.mean(p):.3f} +- {np.std(p):.3f}" for p in zip(*pairs, strict=True)))
    print(
        "FID of plan views, on training floors: " + ", ".join(f"{k} {np.mean(v):.2f} ({min(v):.2f}-{max(v):.2f})" for k, v in views.items())
    )
    print("CPU ms a room: " + ", ".join(f"{k} {1000 * v / len(jobs) / seeds:.1f}" for k, v in seconds.items()))


def views_apart(
    factory: Factory, seed: int, truth: Rooms, train: Mapping[str, Arrangement], jobs: Mapping[str, RoomJob]
) -> dict[str, float]:
    """Return FID of plan views against the split: of training rooms, as many of each type, and of what is made on the same floors; rooms and jobs by name."""
    from pipeline.experiments.realism import alike, embeddings
    from pipeline.metrics.two_samples import frechet
    from pipeline.metrics.views import views_of

    embed = embeddings("")["plan-view net"]
    real, floors = alike(np.random.default_rng(seed), truth, list(train.values()))
    sets = {"train": floors}
    for name, rooms in furnish_rooms(factory, [jobs[room.name] for room in floors], {}).items():
        sets[name] = [replace(room, openings=floor.openings) for room, floor in zip(rooms, floors, strict=True) if room.categories]
    return {name: frechet(embed(views_of(real)), embed(views_of(rooms))) for name, rooms in sets.items()}


def rows_of(jobs: Sequence[RoomJob], rooms: Sequence[dict[str, object]]) -> list[tuple[RoomJob, dict[str, object]]]:
    """Return each job with its row of the rooms table."""
    from pipeline.experiments.rooms import FIRST

    return [(job, rooms[job.index - FIRST]) for job in jobs]


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    if not (ROOT / "models" / "denoiser.safetensors").is_file():
        sys.exit("sfgen: there are no trained weights; type `make run` first")
    main(*(int(v) for v in (*sys.argv[1:], *("0", "3")[len(sys.argv) - 1 :])))
