"""Made rooms beside real ones: relation rates, classifiers, image metrics, novelty; and what harm does to each of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from pipeline import seeds, tables, taxonomy
from pipeline.experiments.dataset import shipped_rows
from pipeline.experiments.rooms import FIRST
from pipeline.features import inception, net
from pipeline.homes.rows import Row
from pipeline.metrics.layout_features import features
from pipeline.metrics.novelty import novelty
from pipeline.metrics.perturbations import HARMS, Harm, spoilt
from pipeline.metrics.relations import compare, furniture
from pipeline.metrics.two_samples import forest_accuracy, frechet
from pipeline.metrics.views import STATES, Embed, Features, compare_views, features_once
from pipeline.relations.arrangement import Arrangement, from_rows
from pipeline.relations.model import Relations
from pipeline.relations.split import rooms_of
from schemas.objects import OBJECTS
from schemas.openings import OPENINGS
from schemas.rooms import ROOMS

Json = dict[str, Any]
Rooms = list[Arrangement]

WEIGHTS = Path(__file__).resolve().parents[2] / "weights" / "features.safetensors"
SEEN = 0.8  # accuracy from which on a classifier has seen a harm
FARTHER = 2.0  # times that of train against test: from which on FID has seen it
DRAWS = 5  # draws of training rooms over which their FID against the held-out split is meant: with 195 rooms one is .2 off
SHIPPED = "shipped"  # rooms of data/shards: on floors of their own
WHOLE: Mapping[str, Harm] = {**HARMS, "all": spoilt}


@dataclass(frozen=True, slots=True)
class Beside:
    """Furnished rooms of the held-out split, rooms of split train, and `samples` of rooms by what made them; furniture alone."""

    real: Rooms
    train: Rooms
    samples: Mapping[str, Rooms]


def beside(root: Path, split: str, drafted: Mapping[str, Mapping[str, Sequence[Row]]]) -> Beside:
    """Gather the rooms: `drafted` are rows of rooms and objects by name, on floors of the split; data/shards are what shipped."""
    folder = root / "data" / "tables"
    rows = tables.read_arrow(folder / f"{ROOMS.name}.parquet", ROOMS).select(["scene_id", "room_id"]).to_pylist()
    number = {f"{row['scene_id']}/{row['room_id']}": f"room_{FIRST + k}/{row['room_id']}" for k, row in enumerate(rows)}
    real = [replace(furniture(room), name=number[room.name]) for room in rooms_of(folder, split) if room.layout_type]
    floors = {room.name: room for room in real if room.categories}
    generated = {}
    for name, draft in drafted.items():
        rooms = [room for room in map(furniture, from_rows(draft["rooms"], draft["objects"])) if room.name in floors]
        generated[name] = [replace(room, openings=floors[room.name].openings) for room in rooms]
    shipped = from_rows(*(shipped_rows(root / "data" / "shards", table) for table in (ROOMS, OBJECTS, OPENINGS)))
    generated[SHIPPED] = [room for room in map(furniture, shipped) if room.layout_type and room.categories]
    train = [room for room in map(furniture, rooms_of(folder, "train")) if room.layout_type and room.categories]
    return Beside(list(floors.values()), train, generated)


def realism_table(seed: int, rooms: Beside, known: Relations, nets: Mapping[str, Embed]) -> Json:
    """Return every figure: real beside made, its floor (train against the held-out split), and whether it sees harm."""
    rng = seeds.generator(seed, "realism")
    draws = [alike(rng, rooms.real, rooms.train) for _ in range(DRAWS)]
    pairs = {"train": draws[0]}
    for name, generated in rooms.samples.items():
        floors = {room.name for room in generated}
        same = [room for room in rooms.real if room.name in floors]
        pairs[name] = (same, generated) if same else alike(rng, rooms.real, generated)
    pairs = {name: pair for name, pair in pairs.items() if len(pair[0]) > 1}
    spoils = {name: [harm(rng, room) for room in rooms.real] for name, harm in WHOLE.items()}
    harmed = {name: (rooms.real, worse) for name, worse in spoils.items()}
    own, train = pairs.get("train", (rooms.real, rooms.real))
    kept = {room.name for room in own}
    apart = {name: (train, [room for room in worse if room.name in kept]) for name, worse in spoils.items()}
    return {
        "relations": compare(rng, {"real": rooms.real, "train": rooms.train, **rooms.samples}, known),
        "layout": layout_figures(seed, pairs, harmed),
        "views": {name: view_figures(rng, seed, features_once(embed), pairs, apart, draws) for name, embed in nets.items()},
        "novelty": {name: novelty(generated, real, rooms.train) for name, (real, generated) in pairs.items() if name != "train"},
    }


def alike(rng: np.random.Generator, rooms: Sequence[Arrangement], others: Sequence[Arrangement]) -> tuple[Rooms, Rooms]:
    """Draw as many rooms of each type from both: what is compared then is furniture, not which rooms homes have."""
    drawn: tuple[Rooms, Rooms] = ([], [])
    for kind in sorted({room.layout_type for room in rooms}):
        own = [[room for room in group if room.layout_type == kind] for group in (rooms, others)]
        count = min(map(len, own))
        for group, into in zip(own, drawn, strict=True):
            into += [group[k] for k in rng.permutation(len(group))[:count]]
    return drawn


Pairs = Mapping[str, tuple[Sequence[Arrangement], Sequence[Arrangement]]]


def layout_figures(seed: int, pairs: Pairs, harmed: Pairs) -> Json:
    """Return SCA of the forest for each pair of samples and for each harm."""

    def accuracy_of(pair: tuple[Sequence[Arrangement], Sequence[Arrangement]]) -> Any:
        real, generated = (features(rooms) for rooms in pair)
        return forest_accuracy(seed, real, generated, *([room.name for room in rooms] for rooms in pair))

    harm = {name: accuracy_of(pair) for name, pair in harmed.items()}
    blind = [name for name, accuracy in harm.items() if accuracy["rate"] < SEEN]
    return {
        "made": {name: accuracy_of(pair) for name, pair in pairs.items()},
        "harm": harm,
        "blind_to": blind,
    }


def view_figures(
    rng: np.random.Generator, seed: int, features_of: Features, pairs: Pairs, harmed: Pairs, draws: Sequence[tuple[Rooms, Rooms]] = ()
) -> Json:
    """Return FID, KID and SCA of plan views for each pair of samples, and for each harm; FID of training rooms is the mean over `draws` of them.

    A harm is seen where spoilt rooms of the split are farther from training rooms than the same rooms unspoilt, twice as far or more.
    """

    def scores_of(samples: Pairs) -> Json:
        return {name: compare_views(rng, seed, features_of, real, {name: generated})[name] for name, (real, generated) in samples.items()}

    scores, harm = scores_of(pairs), scores_of(harmed)
    if "train" in scores:
        every = [frechet(*map(features_of, pair)) for pair in draws]
        scores["train"]["fid"] = round(float(np.mean(every)), 4)
    blind = [name for name, figures in harm.items() if "train" not in scores or figures["fid"] < FARTHER * scores["train"]["fid"]]
    return {"made": scores, "harm": harm, "blind_to": blind}


def embeddings(file: str) -> dict[str, Embed]:
    """Return the nets by name: our own, and Inception where the user names its file."""
    known = taxonomy.load()
    own = net.load(WEIGHTS, net.header(known.layout_types, STATES, known.names))
    nets: dict[str, Embed] = {"plan-view net": lambda views: net.embed(own, views)}
    if file:
        module = inception.inception(Path(file))
        nets["Inception-v3"] = lambda views: inception.embed(module, views)
    return nets
