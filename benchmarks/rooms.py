"""Made rooms beside the rooms of the held-out split, on the same floors, over three seeds.

    python benchmarks/rooms.py [rooms] [seeds]

Needs what `make run` leaves: data/ and models/. Drafts are what the layout model draws: plain ones as it knows rooms, nothing asked of them
(a shower in every bathroom, chairs at every table); unguided ones with what is asked but without guidance, numbers and sizes as they come;
guided ones with all constraints. Finished rooms are what the arranger makes of each. Rates are those of all seeds together, with 95 %
intervals. FID of plan views is measured on training floors, against the split: that of the rooms that stand there is its floor, and no
other floors than theirs are in the way; that of the same rooms finished is what finishing costs. R_acoll is that of the objects that open, those of the real rooms with the library's models in the
places of theirs. At the end stand the floors of training rooms, which `part` in manifests/rooms.yaml is taken from.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from pipeline.diffusion.sampling import Sampler
    from pipeline.entities.home import Placement
    from pipeline.homes.factory import Factory
    from pipeline.homes.furnish import Draft
    from pipeline.homes.request import RoomJob
    from pipeline.metrics.views import Features
    from pipeline.relations.arrangement import Arrangement

ROOT = Path(__file__).resolve().parents[1]
SPLIT = "test"
# Sets of drafts, and what the arranger makes of them.
SAMPLERS = {"plain": "plain and finished", "unguided": "unguided and finished", "guided": "finished"}
LEAST = 10  # percentile of the training rooms' areas that `part` is

Rooms = list["Arrangement"]
Row = dict[str, Any]
Furnished = Mapping[str, Sequence[Sequence["Placement"]]]  # by set: the furniture of each room


def rooms_of(jobs: Sequence[RoomJob], furniture: Sequence[Sequence[Placement]]) -> Rooms:
    """Return furnished rooms as the metrics read them."""
    from pipeline.metrics import relations
    from pipeline.relations.arrangement import make_arrangement

    return [
        relations.furniture(
            make_arrangement(str(job.index), job.layout_type, job.room.polygon, [(p.category, p.position, p.yaw, p.size) for p in own])
        )
        for job, own in zip(jobs, furniture, strict=True)
    ]


def furnish_rooms(factory: Factory, jobs: Sequence[RoomJob], seconds: dict[str, float]) -> Furnished:
    """Furnish rooms, each set of SAMPLERS as drafted and finished; adds CPU seconds by set."""
    from pipeline.homes.furnish import draft_rooms

    unguided = factory.sampler.baseline()
    sets: dict[str, Sequence[Sequence[Placement]]] = {}
    for name, sampler in zip(SAMPLERS, (unasked(unguided), unguided, factory.sampler), strict=True):
        start = time.process_time()
        drafts = draft_rooms(replace(factory, sampler=sampler), jobs)
        drafted = time.process_time()
        sets |= {name: [d.placements for d in drafts], SAMPLERS[name]: finished(factory, drafts)}
        for part, spent in ((name, drafted - start), (SAMPLERS[name], time.process_time() - drafted)):
            seconds[part] = seconds.get(part, 0.0) + spent
    return sets


def unasked(sampler: Sampler) -> Sampler:
    """Return a sampler that hears of no number, no bounds and no company."""
    from dataclasses import fields

    from pipeline.diffusion.sampling import Sampler

    class Unasked(Sampler):
        def inventories(self, rooms: Any, keys: Any, floors: Any) -> Any:
            return super().inventories([replace(room, n_target=None, category_bounds=(), company=()) for room in rooms], keys, floors)

    return Unasked(*(getattr(sampler, f.name) for f in fields(Sampler)))


def finished(factory: Factory, drafts: Sequence[Draft]) -> Sequence[Sequence[Placement]]:
    """Return what the arranger makes of drafts."""
    from pipeline.homes.room_finishing import finish

    return [finish(draft, factory).placements for draft in drafts]


def drafts_of_real(factory: Factory, jobs: Sequence[RoomJob], names: Sequence[str]) -> Sequence[Draft]:
    """Return real rooms, named as `scene_id/room_id`, as drafts: for each thing the library's model that is nearest to its size and shape."""
    from pipeline import tables, taxonomy
    from pipeline.diffusion.context import Proposal, RoomContext
    from pipeline.homes.furnish import retrieve
    from schemas.assets import LATENTS
    from schemas.objects import OBJECTS

    known, data = taxonomy.load(), ROOT / "data"
    latents = {row["asset_id"]: np.array(row["latent"], np.float32) for row in tables.read(data / "latents" / "latents.parquet", LATENTS)}
    inside: dict[str, list[Proposal]] = {}
    for row in tables.read(data / "tables" / "objects.parquet", OBJECTS):
        if row["category"] in known.names:
            own = Proposal(row["category"], np.array(row["position"]), row["yaw"], np.array(row["size"]), latents[row["asset_id"]])
            inside.setdefault(f"{row['scene_id']}/{row['room_id']}", []).append(own)
    contexts = [RoomContext.of(job.plan, job.room_id, job.layout_type) for job in jobs]
    return [
        retrieve(job, context, inside[name], factory.index, known, factory.seed)
        for job, context, name in zip(jobs, contexts, names, strict=True)
    ]


def obstructed(factory: Factory, jobs: Sequence[RoomJob], furniture: Sequence[Sequence[Placement]]) -> str:
    """Return R_acoll in words, as a share of the objects that open: by the paper's box and by the real sweeps."""
    from pipeline.homes.rows import object_row
    from pipeline.metrics.articulation import are_obstructed, sweeps_of

    box, swept = [], []
    sweeps = sweeps_of(factory.library.joints)
    for job, own in zip(jobs, furniture, strict=True):
        rows = [object_row(str(job.index), p, openable=factory.library[p.asset_id].openable) for p in own]
        box += are_obstructed(rows, "heuristic")
        swept += are_obstructed(rows, "joints", sweeps)
    return f"{np.mean(box):.2f} / {np.mean(swept):.2f} of {len(box)}"


def views_apart(
    factory: Factory, truth: Rooms, train: Mapping[str, Arrangement], jobs: Mapping[str, RoomJob], features_of: Features
) -> dict[str, float]:
    """Return FID of plan views against the split: of training rooms, as many of each type, also finished, and of what is made on the same floors; rooms and jobs by name."""
    from pipeline.experiments.realism import alike
    from pipeline.metrics.two_samples import frechet

    real, floors = alike(np.random.default_rng(factory.seed), truth, list(train.values()))
    own = [jobs[room.name] for room in floors]
    sets = {"train": floors}
    as_real = {"train, finished": finished(factory, drafts_of_real(factory, own, [room.name for room in floors]))}
    for name, furniture in {**as_real, **furnish_rooms(factory, own, {})}.items():
        rooms = zip(rooms_of(own, furniture), floors, strict=True)
        sets[name] = [replace(room, openings=floor.openings) for room, floor in rooms if room.categories]
    return {name: frechet(features_of(real), features_of(rooms)) for name, rooms in sets.items()}


def jobs_of(source: Mapping[str, Sequence[Row]], split: str) -> dict[str, RoomJob]:
    """Return the jobs of a split's rooms by the name `scene_id/room_id`."""
    from pipeline import taxonomy
    from pipeline.experiments.rooms import FIRST, test_rooms

    jobs = test_rooms(source, split, taxonomy.load().layout_types)
    rows = [source["rooms"][job.index - FIRST] for job in jobs]
    return {f"{row['scene_id']}/{row['room_id']}": job for job, row in zip(jobs, rows, strict=True)}


def furnished(split: str) -> dict[str, Arrangement]:
    """Return the rooms of a split that are furnished, by name; furniture alone."""
    from pipeline.metrics.relations import furniture
    from pipeline.relations.arrangement import rooms_of as read_rooms

    rooms = (furniture(room) for room in read_rooms(ROOT / "data" / "tables", split) if room.layout_type)
    return {room.name: room for room in rooms if room.categories}


def print_rates(comparison: Mapping[str, Any], seeds: int) -> None:
    """Print relation rates and objects a room, of all sets."""
    for rule, rates in comparison["rates"].items():
        own = max(rates["real"]["rate"], 1e-9)
        cells = [f"{v['rate']:.3f} ({v['low']:.2f}-{v['high']:.2f}) {v['rate'] / own:4.2f}" for k, v in rates.items() if k != "real"]
        print(f"  {rule:42s} {rates['real']['rate']:.3f}  " + "   ".join(cells) + f"   n {rates['real']['n'] // seeds}")
    print("objects a room")
    for kind, of in comparison["objects"].items():
        print(f"  {kind:20s} " + "   ".join(f"{v['mean']:6.2f}" for v in of.values()) + f"   n {of['real']['n'] // seeds}")


def print_constraints(rates: Mapping[str, Any], views: Mapping[str, Sequence[float]]) -> None:
    """Print what the constraints cost, on against off: FID of plan views, and the relation rates that fall most."""
    print("constraints on against off")
    for name, off, on in (("drafts", "unguided", "guided"), ("finished", SAMPLERS["unguided"], SAMPLERS["guided"])):
        falls = sorted((of[off]["rate"] - of[on]["rate"], rule) for rule, of in rates.items())[-3:]
        without, having = np.mean(views[off]), np.mean(views[on])
        said = ", ".join(f"{rule} by {fall:.3f}" for fall, rule in reversed(falls))
        print(f"  {name:10s} FID {having:.2f} against {without:.2f} ({having / without - 1:+.1%}); rates that fall most: {said}")


def print_floors(train: Mapping[str, Arrangement]) -> None:
    """Print the floors of training rooms beside what the manifest says of them."""
    from pipeline import taxonomy

    print(f"floors of training rooms [m2]: percentiles {LEAST}, 50 and 90; `part`")
    for kind in taxonomy.load().functions.values():
        areas = [room.area for room in train.values() if room.layout_type == kind]
        print(f"  {kind:20s} " + "   ".join(f"{a:5.1f}" for a in np.percentile(areas, [LEAST, 50, 90])), taxonomy.load().layouts[kind].part)


def main(count: int, seeds: int) -> None:
    """Furnish, measure, print."""
    from pipeline import params, tables
    from pipeline.experiments.realism import embeddings
    from pipeline.experiments.rooms import spread
    from pipeline.homes.factory import load_factory
    from pipeline.metrics.layout_features import features
    from pipeline.metrics.relations import compare
    from pipeline.metrics.two_samples import forest_accuracy
    from pipeline.metrics.views import features_once
    from pipeline.relations.model import Relations
    from schemas.openings import OPENINGS
    from schemas.rooms import ROOMS
    from schemas.scenes import SCENES

    tree, folder = params.read(ROOT / "params.yaml"), ROOT / "data" / "tables"
    source = {t.name: tables.read(folder / f"{t.name}.parquet", t) for t in (SCENES, ROOMS, OPENINGS)}
    real, train, floors, named = furnished(SPLIT), furnished("train"), jobs_of(source, "train"), jobs_of(source, SPLIT)
    chosen = spread([name for name in named if name in real], count or len(named))
    jobs, truth = [named[name] for name in chosen], [replace(real[name], name=str(named[name].index)) for name in chosen]
    sets: dict[str, Rooms] = {"real": truth * seeds}
    accuracies: dict[str, list[float]] = {}
    views: dict[str, list[float]] = {}
    seconds: dict[str, float] = {}
    ways: dict[str, str] = {}
    features_of, names = features_once(embeddings("")["plan-view net"]), [room.name for room in truth]
    for seed in range(seeds):
        factory = load_factory(ROOT, tree, seed)
        for name, fid in views_apart(factory, truth, train, floors, features_of).items():
            views.setdefault(name, []).append(fid)
        every = furnish_rooms(factory, jobs, seconds)
        as_real = {"real": [draft.placements for draft in drafts_of_real(factory, jobs, chosen)]}
        ways = {name: obstructed(factory, jobs, own) for name, own in {**as_real, **every}.items()}
        for name, own in every.items():
            rooms = rooms_of(jobs, own)
            sets.setdefault(name, []).extend(rooms)
            accuracies.setdefault(name, []).append(forest_accuracy(seed, features(truth), features(rooms), names, names)["rate"])
    comparison = compare(np.random.default_rng(0), sets, Relations.load(folder / "relations.json"))
    print(f"{len(jobs)} rooms of split {SPLIT}, {seeds} seeds; share of cases in which it holds, and of the real share: {', '.join(sets)}")
    print_rates(comparison, seeds)
    print("SCA of a random forest on layout features")
    for name, rates in accuracies.items():
        print(f"  {name:20s} {np.mean(rates):.3f} +- {np.std(rates):.3f}")
    print(
        "FID of plan views, on training floors: " + ", ".join(f"{k} {np.mean(v):.2f} ({min(v):.2f}-{max(v):.2f})" for k, v in views.items())
    )
    print_constraints(comparison["rates"], views)
    print("R_acoll, paper's boxes / real sweeps: " + ", ".join(f"{name} {said}" for name, said in ways.items()))
    print("CPU ms a room: " + ", ".join(f"{k} {1000 * v / len(jobs) / seeds:.1f}" for k, v in seconds.items()))
    print_floors(train)


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    if not (ROOT / "models" / "denoiser.safetensors").is_file():
        sys.exit("sfgen: there are no trained weights; type `make run` first")
    main(*(int(v) for v in (*sys.argv[1:], *("0", "3")[len(sys.argv) - 1 :])))
