"""Made rooms beside real ones: relation rates, classifiers, image metrics, novelty; and what harm does to each of them."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from pipeline import seeds, tables, taxonomy
from pipeline.experiments.dataset import shipped_rows
from pipeline.experiments.trials import FIRST
from pipeline.features import inception, net
from pipeline.homes.rows import Row
from pipeline.metrics.layout_features import features
from pipeline.metrics.novelty import novelty
from pipeline.metrics.relations import compare, furniture
from pipeline.metrics.two_samples import forest_accuracy, frechet
from pipeline.metrics.views import HARMS, STATES, Embed, Features, Harm, compare_views, features_once, spoilt
from pipeline.relations.arrangement import Arrangement, from_rows, rooms_of
from pipeline.relations.model import Relations
from schemas import OBJECTS, OPENINGS, ROOMS

Json = dict[str, Any]
Rooms = list[Arrangement]
Pair = tuple[Sequence[Arrangement], Sequence[Arrangement]]  # real rooms, and generated ones beside them
Pairs = Mapping[str, Pair]

WEIGHTS = Path(__file__).resolve().parents[2] / "weights" / "features.safetensors"
SEEN = 0.8  # accuracy from which on a classifier has seen a harm
FARTHER = (
    2.0  # times that of train against test: from which on FID has seen it; KID, which is about 0 there, by the high end of its interval
)
DRAWS = 40  # draws of pairs over which FID is meant: one of 195 rooms is .2 off, the mean of 40 some .02
AREA = 0.08  # by so much two rooms of a pair may differ in area
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
    generated[SHIPPED] = shipped_rooms(root / "data" / "shards")
    return Beside(list(floors.values()), furnished(rooms_of(folder, "train")), generated)


def shipped_rooms(dataset: Path) -> Rooms:
    """Return the furnished rooms of a dataset but for WCs: they are furnished as bathrooms, and the training houses have none."""
    rooms, *others = (shipped_rows(dataset, table) for table in (ROOMS, OBJECTS, OPENINGS))
    return furnished(from_rows([row for row in rooms if row["type"] != "wc"], *others))


def furnished(rooms: Iterable[Arrangement]) -> Rooms:
    """Return rooms of a layout type with their furniture alone, those that have any."""
    return [room for room in map(furniture, rooms) if room.layout_type and room.categories]


def realism_table(seed: int, rooms: Beside, known: Relations, nets: Mapping[str, Embed]) -> Json:
    """Return every figure: real beside made, its floor (train against the held-out split), and whether it sees harm."""
    rng = seeds.generator(seed, "realism")
    draws = {
        name: drawn
        for name, generated in {"train": rooms.train, **rooms.samples}.items()
        if (drawn := pairs_of(rng, rooms.real, generated))
    }
    floors = {name: pairs_of(rng, drawn[0][0], rooms.train) for name, drawn in draws.items()}
    pairs = {name: drawn[0] for name, drawn in draws.items()}
    spoils = {name: [harm(rng, room) for room in rooms.real] for name, harm in WHOLE.items()}
    harmed = {name: (rooms.real, worse) for name, worse in spoils.items()}
    own, train = pairs.get("train", (rooms.real, rooms.real))
    kept = {room.name for room in own}
    apart = {name: (train, [room for room in worse if room.name in kept]) for name, worse in spoils.items()}
    return {
        "relations": compare(rng, {"real": rooms.real, "train": rooms.train, **rooms.samples}, known),
        "layout": layout_figures(seed, pairs, harmed),
        "views": {name: view_figures(rng, seed, features_once(embed), draws, floors, apart) for name, embed in nets.items()},
        "novelty": {name: novelty(generated, real, rooms.train) for name, (real, generated) in pairs.items() if name != "train"},
    }


def pairs_of(rng: np.random.Generator, rooms: Rooms, generated: Rooms) -> list[tuple[Rooms, Rooms]]:
    """Return the rooms and what is generated on the same floors; where these are others, DRAWS draws of rooms alike; none of fewer than two."""
    names = {room.name for room in generated}
    same = [room for room in rooms if room.name in names]
    drawn = [(same, generated)] if same else alike(rng, rooms, generated, DRAWS)
    return [pair for pair in drawn if len(pair[0]) > 1]


def alike(rng: np.random.Generator, rooms: Sequence[Arrangement], others: Sequence[Arrangement], draws: int) -> list[tuple[Rooms, Rooms]]:
    """Draw so many times pairs of a room and another of its type whose area is within AREA of its own, each room once a draw.

    What is compared then is furniture, not which rooms homes have and how large.
    """
    areas, kinds = np.log([other.area for other in others]), np.array([other.layout_type for other in others])
    near = [np.flatnonzero((kinds == r.layout_type) & (np.abs(areas - np.log(r.area)) <= np.log1p(AREA))) for r in rooms]
    drawn: list[tuple[Rooms, Rooms]] = []
    for _ in range(draws):
        free, pair = np.ones(len(others), bool), (Rooms(), Rooms())
        for k in rng.permutation(len(rooms)):
            candidates = near[k][free[near[k]]]
            if len(candidates):
                chosen = int(rng.choice(candidates))
                free[chosen] = False
                pair[0].append(rooms[k])
                pair[1].append(others[chosen])
        drawn.append(pair)
    return drawn


def layout_figures(seed: int, pairs: Pairs, harmed: Pairs) -> Json:
    """Return SCA of the forest for each pair of samples and for each harm."""

    def accuracy_of(pair: Pair) -> Any:
        real, generated = (features(rooms) for rooms in pair)
        return forest_accuracy(seed, real, generated, *([room.name for room in rooms] for rooms in pair))

    harm = {name: accuracy_of(pair) for name, pair in harmed.items()}
    return {
        "made": {name: accuracy_of(pair) for name, pair in pairs.items()},
        "harm": harm,
        "blind_to": {"SCA": [name for name, accuracy in harm.items() if accuracy["rate"] < SEEN]},
    }


def view_figures(
    rng: np.random.Generator,
    seed: int,
    features_of: Features,
    draws: Mapping[str, Sequence[Pair]],
    floors: Mapping[str, Sequence[Pair]],
    harmed: Pairs,
) -> Json:
    """Return FID, KID and SCA of plan views for each sample, and for each harm.

    FID of a sample is the mean over its `draws`; beside it stands its floor, that of training rooms against the same real rooms (over `floors`).
    FID and KID see a harm where spoilt rooms of the split are twice as far from training rooms as the same rooms unspoilt, SCA where it tells them from training rooms.
    """

    def scores_of(samples: Pairs) -> Json:
        return {name: compare_views(rng, seed, features_of, real, {name: generated})[name] for name, (real, generated) in samples.items()}

    def fid(every: Sequence[Pair]) -> float | None:
        return round(float(np.mean([frechet(features_of(real), features_of(rooms)) for real, rooms in every])), 4) if every else None

    scores, harm = scores_of({name: drawn[0] for name, drawn in draws.items()}), scores_of(harmed)
    for name, drawn in draws.items():
        scores[name] |= {"fid": fid(drawn), "floor": fid(floors.get(name, []))}
    return {"made": scores, "harm": harm, "blind_to": unseen(harm, scores.get("train"))}


def unseen(harm: Json, train: Json | None) -> dict[str, list[str]]:
    """Return the harms that each figure of plan views does not see; one that misses any is void. Without `train`, training rooms against the split, FID and KID see none."""
    fid, kid = (FARTHER * train["fid"], FARTHER * train["kid"]["high"]) if train else (np.inf, np.inf)
    return {
        "FID": [name for name, figures in harm.items() if figures["fid"] < fid],
        "KID": [name for name, figures in harm.items() if figures["kid"]["mean"] < kid],
        "SCA": [name for name, figures in harm.items() if figures["sca"]["rate"] < SEEN],
    }


def embeddings(file: str) -> dict[str, Embed]:
    """Return the nets by name: our own, and Inception where the user names its file."""
    known = taxonomy.load()
    own = net.load(WEIGHTS, net.header(known.layout_types, STATES, known.names))
    nets: dict[str, Embed] = {"plan-view net": lambda views: net.embed(own, views)}
    if file:
        module = inception.inception(Path(file))
        nets["Inception-v3"] = lambda views: inception.embed(module, views)
    return nets
