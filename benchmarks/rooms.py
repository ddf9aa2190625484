"""Made rooms beside the rooms of the held-out split, on the same floors, over three seeds.

    python benchmarks/rooms.py [rooms] [seeds]

Needs what `make run` leaves: data/ and models/. Drafts are what the layout model draws: plain ones as it knows rooms, nothing asked of them
(a shower in every bathroom, chairs at every table); unguided ones with what is asked but without guidance, numbers and sizes as they come;
guided ones with all constraints. Finished rooms are what the arranger makes of each. Rates are those of all seeds together, with 95 %
intervals. FID of plan views is measured on training floors, against the split: that of the rooms that stand there is its floor, and no
other floors than theirs are in the way; that of the same rooms finished is what finishing costs. R_acoll is that of the objects that open,
those of the real rooms with the library's models in the places of theirs; the judge asks of one joint at a time whether it touches anything,
walls included. Behind them stand the floors of training rooms, which `part` in manifests/rooms.yaml is taken from, and last the bars that
these figures are held to.
"""

import os
import sys
import time
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np

from pipeline import params, tables, taxonomy
from pipeline.arrays import Ints
from pipeline.diffusion.codec import proposals_of
from pipeline.diffusion.rooms import Example, read_sets
from pipeline.diffusion.sampling import Sampler
from pipeline.entities.home import Home, Placement
from pipeline.experiments.realism import alike, embeddings, furnished
from pipeline.experiments.settings import spread
from pipeline.experiments.trials import FIRST, test_rooms
from pipeline.homes.factory import Factory, load_factory
from pipeline.homes.furnish import Draft, context_of, draft_rooms, retrieve
from pipeline.homes.request import RoomJob
from pipeline.homes.room_finishing import finish
from pipeline.homes.rows import object_row
from pipeline.metrics.collision import are_obstructed, sweeps_of, swept
from pipeline.metrics.layout_features import features
from pipeline.metrics.relations import compare, furniture
from pipeline.metrics.two_samples import ckl, forest_accuracy
from pipeline.metrics.views import Features, compare_views, features_once
from pipeline.relations.arrangement import Arrangement, make_arrangement, rooms_of
from pipeline.relations.model import Relations
from pipeline.verify import verify_home
from schemas import OPENINGS, ROOMS, SCENES

ROOT = Path(__file__).resolve().parents[1]
SPLIT = "test"
# Sets of drafts, and what the arranger makes of them.
SAMPLERS = {"plain": "plain and finished", "unguided": "unguided and finished", "guided": "finished"}
LEAST = 10  # percentile of the training rooms' areas that `part` is

Furniture = Sequence[Sequence[Placement]]  # of each room


class Unasked(Sampler):
    """A sampler that hears of no number, no bounds and no company."""

    def inventories(self, rooms: Any, keys: Any, features: Any) -> Any:
        """Draw what each room holds."""
        free = [replace(room, n_target=None, category_bounds=(), company=()) for room in rooms]
        return Sampler.inventories(self, free, keys, features)


def arrangements(floors: Sequence[Arrangement], jobs: Sequence[RoomJob], made: Furniture) -> list[Arrangement]:
    """Return furnished rooms as the metrics read them, with the doors and windows of the floors that they stand on."""
    things = [[(p.category, p.position, p.yaw, p.size) for p in own] for own in made]
    return [
        furniture(make_arrangement(str(j.index), j.layout_type, j.room.polygon, own, floor.openings))
        for floor, j, own in zip(floors, jobs, things, strict=True)
    ]


def furnish_rooms(factory: Factory, jobs: Sequence[RoomJob], seconds: dict[str, float]) -> dict[str, Furniture]:
    """Furnish rooms, each set of SAMPLERS as drafted and finished; adds CPU seconds by set."""
    unguided = factory.sampler.baseline()
    plain = Unasked(*(getattr(unguided, f.name) for f in fields(Sampler)))
    sets: dict[str, Furniture] = {}
    for (name, after), sampler in zip(SAMPLERS.items(), (plain, unguided, factory.sampler), strict=True):
        start = time.process_time()
        drafts = draft_rooms(replace(factory, sampler=sampler), jobs)
        seconds[name] += (drafted := time.process_time()) - start
        sets |= {name: [d.placements for d in drafts], after: finished(factory, drafts)}
        seconds[after] += time.process_time() - drafted
    return sets


def finished(factory: Factory, drafts: Sequence[Draft]) -> Furniture:
    """Return what the arranger makes of drafts."""
    return [finish(draft, factory).placements for draft in drafts]


def drafts_of_real(factory: Factory, jobs: Sequence[RoomJob], real: Sequence[Example]) -> list[Draft]:
    """Return real rooms as drafts: for each thing the library's model that is nearest to its size and shape."""
    drafts, known = [], taxonomy.load()
    for job, room in zip(jobs, real, strict=True):
        context = context_of(job, factory.seed, factory.index)
        things = proposals_of(room.continuous, [known.names[k] for k in room.classes], context)
        drafts.append(retrieve(job, context, things, factory.index, known))
    return drafts


def obstructed(factory: Factory, jobs: Sequence[RoomJob], made: Furniture) -> Ints:
    """Return (4,) how many objects open, and how many of them are obstructed by the paper's box, by boxes of the real sweeps, and as the judge finds it."""
    sweeps, counts = sweeps_of(factory.library.joints), np.zeros(4, np.int64)
    for job, own in zip(jobs, made, strict=True):
        rows = [object_row(str(job.index), p, openable=factory.library[p.asset_id].openable) for p in own]
        box, boxes = are_obstructed(rows, "heuristic"), are_obstructed(rows, "joints", sweeps)
        joints = verify_home(Home(str(job.index), 0, 0, "", "", job.plan, tuple(own)), factory.library, factory.verify).joint_rows()
        counts += len(box), sum(box), sum(boxes), swept(joints)["objects"]["successes"]
    return counts


def views_apart(
    factory: Factory,
    truth: list[Arrangement],
    train: list[Arrangement],
    jobs: Mapping[str, RoomJob],
    examples: Mapping[str, Example],
    features_of: Features,
) -> dict[str, Any]:
    """Return FID, KID and SCA of plan views against the split, of training rooms, as many of each type, also finished, and of what is made on the same floors.

    `jobs` and `examples` by name. CKL stands beside them: of the classes against those of the split.
    """
    real, floors = alike(np.random.default_rng(factory.seed), truth, train, 1)[0]
    own = [jobs[room.name] for room in floors]
    sets = {"train": floors}
    as_real = {"train, finished": finished(factory, drafts_of_real(factory, own, [examples[room.name] for room in floors]))}
    for name, made in {**as_real, **furnish_rooms(factory, own, defaultdict(float))}.items():
        sets[name] = [room for room in arrangements(floors, own, made) if room.categories]
    rng, classes, truly = np.random.default_rng(factory.seed), taxonomy.load().names, classes_of(real)
    figures = compare_views(rng, factory.seed, features_of, real, sets)
    return {name: own | {"ckl": ckl(truly, classes_of(sets[name]), classes)["real_to_generated"]} for name, own in figures.items()}


def classes_of(rooms: Sequence[Arrangement]) -> list[dict[str, str]]:
    """Return rows of the objects of rooms, as CKL reads them."""
    return [{"category": category} for room in rooms for category in room.categories]


def jobs_of(split: str) -> dict[str, RoomJob]:
    """Return the jobs of a split's rooms by the name `scene_id/room_id`."""
    source = {t.name: tables.read(ROOT / "data" / "tables" / f"{t.name}.parquet", t) for t in (SCENES, ROOMS, OPENINGS)}
    jobs = test_rooms(source, split, taxonomy.load().layout_types)
    return {f"{source['rooms'][job.index - FIRST]['scene_id']}/{job.room_id}": job for job in jobs}


def print_rates(comparison: Mapping[str, Any], seeds: int = 1) -> None:
    """Print relation rates and objects a room, of all sets."""
    for rule, rates in comparison["rates"].items():
        own = max(rates["real"]["rate"], 1e-9)
        cells = [f"{v['rate']:.3f} ({v['low']:.2f}-{v['high']:.2f}) {v['rate'] / own:4.2f}" for k, v in rates.items() if k != "real"]
        print(f"  {rule:42s} {rates['real']['rate']:.3f}  " + "   ".join(cells) + f"   n {rates['real']['n'] // seeds}")
    print("objects a room")
    for kind, of in comparison["objects"].items():
        print(f"  {kind:20s} " + "   ".join(f"{v['mean']:6.2f}" for v in of.values()) + f"   n {of['real']['n'] // seeds}")


def print_views(views: Mapping[str, Sequence[Any]]) -> None:
    """Print FID, KID, SCA and CKL of all sets, means over the seeds; KID's interval is the widest of all seeds."""
    print("plan views, on training floors: FID (lowest - highest), of that of train; KID; SCA; CKL, of that of train")
    for name, seeds in views.items():
        fids, kids = [own["fid"] for own in seeds], [own["kid"] for own in seeds]
        kid = f"{np.mean([k['mean'] for k in kids]):+.4f} ({min(k['low'] for k in kids):+.4f} to {max(k['high'] for k in kids):+.4f})"
        fid = f"{np.mean(fids):5.2f} ({min(fids):.2f}-{max(fids):.2f}) {ratio(views, 'fid', name):4.2f}"
        print(f"  {name:20s} {fid}  {kid}  {view_accuracy(seeds):.3f}  {mean(seeds, 'ckl'):.4f} {ratio(views, 'ckl', name):4.2f}")


def mean(seeds: Sequence[Any], key: str) -> float:
    """Return the mean of a figure over seeds."""
    return float(np.mean([own[key] for own in seeds]))


def ratio(views: Mapping[str, Sequence[Any]], key: str, name: str, base: str = "train") -> float:
    """Return a figure of one set as a multiple of another's, each the mean over seeds."""
    return mean(views[name], key) / mean(views[base], key)


def view_accuracy(seeds: Sequence[Any]) -> float:
    """Return the share of rooms that SCA on plan views tells apart, over seeds."""
    return float(np.mean([own["sca"]["rate"] for own in seeds]))


def print_bars(
    comparison: Mapping[str, Any], accuracies: Mapping[str, Sequence[float]], views: Mapping[str, Sequence[Any]], hits: Ints, spent: float
) -> None:
    """Print the bars that made rooms are held to, each with its figure; of guided drafts `hits` (see `obstructed`) and `spent` CPU seconds. SR(N) has none here."""
    shares = {k: min(of[k]["rate"] / max(of["real"]["rate"], 1e-9) for of in comparison["rates"].values()) for k in ("finished", "plain")}
    counts = {kind: abs(of["guided"]["mean"] / of["real"]["mean"] - 1) for kind, of in comparison["objects"].items() if of["real"]["mean"]}
    off = sorted(kind for kind, by in counts.items() if by > 0.05)
    drafts_and_rooms = ("guided", "finished")
    bars = [
        ("least relation rate, finished, of the real", shares["finished"], ">=", 0.92),
        ("least relation rate, plain drafts, of the real", shares["plain"], ">=", 0.80),
        ("SCA on layout features, guided drafts", float(np.mean(accuracies["guided"])), "<=", 0.57),
        ("SCA on layout features, finished", float(np.mean(accuracies["finished"])), "<=", 0.60),
        *((f"SCA on renders, {k}: distance from 50", abs(100 * view_accuracy(views[k]) - 50), "<=", 4.0) for k in drafts_and_rooms),
        *((f"FID, {k}, of that of train", ratio(views, "fid", k), "<=", 1.15) for k in drafts_and_rooms),
        ("CKL, guided, of that of train", ratio(views, "ckl", "guided"), "<=", 1.5),
        (f"objects a room, all; types further off: {', '.join(off) or 'none'}", counts.get("all", 0.0), "<=", 0.05),
        ("FID, constraints on against off", ratio(views, "fid", "guided", "unguided") - 1, "<=", 0.03),
        ("largest fall of a rate, constraints on against off", falls(comparison["rates"], "unguided", "guided")[0][0], "<=", 0.02),
        ("R_acoll of guided drafts, paper's boxes", hits[1] / hits[0], "<=", 0.05),
        ("R_acoll of guided drafts, the judge's sweeps", hits[3] / hits[0], "<=", 0.05),
        ("CPU ms of a guided draft", 1000 * spent, "<=", 20.0),
    ]
    print("bars")
    for name, value, sign, bar in bars:
        print(f"  {'met   ' if (value <= bar) == (sign == '<=') else 'MISSED'} {value:8.3f} {sign} {bar:<6g} {name}")


def falls(rates: Mapping[str, Any], off: str, on: str) -> list[tuple[float, str]]:
    """Return by how much each relation rate falls from one set to another, the largest fall first, with its rule."""
    return sorted(((of[off]["rate"] - of[on]["rate"], rule) for rule, of in rates.items()), reverse=True)


def print_constraints(rates: Mapping[str, Any], views: Mapping[str, Sequence[Any]]) -> None:
    """Print what the constraints cost, on against off: FID of plan views, and the relation rates that fall most."""
    print("constraints on against off")
    for name, off, on in (("drafts", "unguided", "guided"), ("finished", SAMPLERS["unguided"], SAMPLERS["guided"])):
        without, having = mean(views[off], "fid"), mean(views[on], "fid")
        said = ", ".join(f"{rule} by {fall:.3f}" for fall, rule in falls(rates, off, on)[:3])
        print(
            f"  {name:10s} FID {having:.2f} against {without:.2f} ({ratio(views, 'fid', on, off) - 1:+.1%}); rates that fall most: {said}"
        )


def print_floors(train: Sequence[Arrangement]) -> None:
    """Print the floors of training rooms beside what the manifest says of them."""
    print(f"floors of training rooms [m2]: percentiles {LEAST}, 50 and 90; `part`")
    standing = {room.layout_type for room in train}
    for kind in (kind for kind in taxonomy.load().functions.values() if kind in standing):
        areas = [room.area for room in train if room.layout_type == kind]
        print(f"  {kind:20s} " + "   ".join(f"{a:5.1f}" for a in np.percentile(areas, [LEAST, 50, 90])), taxonomy.load().layouts[kind].part)


def main(count: int, seeds: int) -> None:
    """Furnish, measure, print."""
    tree, folder = params.read(ROOT / "params.yaml"), ROOT / "data" / "tables"
    real, train = (furnished(rooms_of(folder, split)) for split in (SPLIT, "train"))
    named, floors, sets_read = jobs_of(SPLIT), jobs_of("train"), read_sets(ROOT, 10_000)
    examples = {e.key: e for e in (*sets_read.train, *sets_read.test)}
    truth = [replace(room, name=str(named[room.name].index)) for room in spread(real, count or len(real))]
    chosen = [room.name for room in spread(real, count or len(real))]
    jobs, names = [named[name] for name in chosen], [room.name for room in truth]
    sets = {"real": truth * seeds, "train": train}
    accuracies: dict[str, list[float]] = defaultdict(list)
    views: dict[str, list[Any]] = defaultdict(list)
    seconds: dict[str, float] = defaultdict(float)
    hits: dict[str, Ints] = defaultdict(lambda: np.zeros(4, np.int64))
    features_of = features_once(embeddings("")["plan-view net"])
    for seed in range(seeds):
        factory = load_factory(ROOT, tree, seed)
        for name, own in views_apart(factory, truth, train, floors, examples, features_of).items():
            views[name].append(own)
        every = furnish_rooms(factory, jobs, seconds)
        as_real = [draft.placements for draft in drafts_of_real(factory, jobs, [examples[name] for name in chosen])]
        for name, own in {"real": as_real, **every}.items():
            hits[name] += obstructed(factory, jobs, own)
        for name, made in every.items():
            rooms = arrangements(truth, jobs, made)
            sets.setdefault(name, []).extend(rooms)
            accuracies[name].append(forest_accuracy(seed, features(truth), features(rooms), names, names)["rate"])
    comparison = compare(np.random.default_rng(0), sets, Relations.load(folder / "relations.json"))
    print(f"{len(jobs)} rooms of split {SPLIT}, {seeds} seeds; share of cases in which it holds, and of the real share: {', '.join(sets)}")
    print_rates(comparison, seeds)
    print("SCA of a random forest on layout features")
    for name, rates in accuracies.items():
        print(f"  {name:20s} {np.mean(rates):.3f} +- {np.std(rates):.3f}")
    print_views(views)
    print_constraints(comparison["rates"], views)
    said = ", ".join(f"{name} {' / '.join(f'{k / n:.3f}' for k in hit)} of {n}" for name, (n, *hit) in hits.items())
    print(f"R_acoll, paper's boxes / boxes of the sweeps / the judge's sweeps: {said}")
    print("CPU ms a room: " + ", ".join(f"{k} {1000 * v / len(jobs) / seeds:.1f}" for k, v in seconds.items()))
    print_floors(train)
    print_bars(comparison, accuracies, views, hits["guided"], seconds["guided"] / len(jobs) / seeds)


if __name__ == "__main__":
    if not (ROOT / "models" / "denoiser.safetensors").is_file():
        sys.exit("sfgen: there are no trained weights; type `make run` first")
    main(*(int(v) for v in (*sys.argv[1:], *("0", "3")[len(sys.argv) - 1 :])))
