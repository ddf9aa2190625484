"""Training rooms: table rows to padded arrays."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pipeline import tables, taxonomy
from pipeline.diffusion.codec import CHANNELS, LATENT
from pipeline.diffusion.context import Floor, RoomContext, RoomOpening, floor_tokens
from pipeline.diffusion.poses import pose_classes
from pipeline.errors import ContentError
from pipeline.relations.arrangement import Arrangement
from schemas import ASSET_JOINTS, LATENTS, OBJECTS, OPENINGS, ROOMS, SCENES

Row = Mapping[str, Any]
SWEEPS = 4  # boxes per object
TABLES = {f"data/tables/{t.name}.parquet": t for t in (SCENES, ROOMS, OPENINGS, OBJECTS, ASSET_JOINTS)}
SHAPES = "data/latents/latents.parquet"


@dataclass(frozen=True, slots=True)
class Example:
    """One furnished room, n objects, room frame.

    `layout` is the index of its type; `classes` (n,); `poses` (n,), see `poses`; `continuous` (n, 40) in metres, cos, sin, raw latents;
    `sweeps` (n, K, 2, 3) [m], object frame, NaN for none.
    """

    key: str
    split: str
    layout: int
    context: RoomContext
    floor: Floor
    classes: NDArray[np.int64]
    poses: NDArray[np.int64]
    continuous: NDArray[np.float64]
    sweeps: NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class Sets:
    """Examples by split, and how many rooms were left out for which reason."""

    train: tuple[Example, ...]
    val: tuple[Example, ...]
    test: tuple[Example, ...]
    left_out: Mapping[str, int]


def read_sets(root: Path, slots: int) -> Sets:
    """Read the rooms of data/tables that have at most `slots` objects. Raises ContentError where none is of split train."""
    words = taxonomy.load()
    read = {table.name: tables.read(root / path, table) for path, table in TABLES.items()}
    latents = {r["asset_id"]: np.array(r["latent"], np.float32) for r in tables.read(root / SHAPES, LATENTS)}
    sets = sets_of(read, latents, sweeps_by_asset(read[ASSET_JOINTS.name]), words.names, words.layout_types, slots)
    if not sets.train:
        raise ContentError(
            "data/tables has no furnished room of split train", "raise corpus.houses in params.yaml, or check the rejects table"
        )
    return sets


def context_of(room: Row, openings: Iterable[Row], elevation: float = 0.0) -> RoomContext:
    """Build the context of a rooms row and the openings of its scene; `elevation` [m] of its floor."""
    room_openings = tuple(
        RoomOpening(
            o["kind"],
            np.array(o["segment"], float),
            float(o["sill"]),
            int(o["swing_hinge"]) if o["swing_room"] == room["room_id"] and o["swing_hinge"] is not None else -1,
        )
        for o in openings
        if room["room_id"] in o["rooms"]
    )
    polygon = np.array(room["polygon"], float)
    return RoomContext(str(room["layout_type"]), polygon, room_openings, elevation=elevation, height=float(room["height"]))


def example_of(
    key: str,
    split: str,
    layout: int,
    context: RoomContext,
    objects: Sequence[Row],
    classes: tuple[str, ...],
    latents: Mapping[str, NDArray[np.float32]],
    sweeps: Mapping[str, NDArray[np.float32]],
) -> Example:
    """Build one example of a room and the rows of its objects."""
    position = np.array([o["position"] for o in objects], float).reshape(-1, 3) - [*context.centre, context.elevation]
    size, yaw = np.array([o["size"] for o in objects], float).reshape(-1, 3), np.array([o["yaw"] for o in objects], float)[:, None]
    latent = np.array([latents.get(o["asset_id"], np.zeros(LATENT)) for o in objects], np.float32).reshape(-1, LATENT)
    swept = np.full((len(objects), SWEEPS, 2, 3), np.nan, np.float32)
    for i, row in enumerate(objects):
        boxes = sweeps.get(row["asset_id"])
        if boxes is not None and row["openable"]:
            swept[i, : len(boxes)] = boxes[:SWEEPS] * np.array(row["scale"], np.float32)
    labels = np.array([classes.index(o["category"]) for o in objects], np.int64)
    continuous = np.concatenate([position, size, np.cos(yaw), np.sin(yaw), latent], 1)
    stands = Arrangement(key, context.layout_type, context.polygon - context.centre, (), position, yaw[:, 0], size)
    return Example(key, split, layout, context, floor_tokens(context), labels, pose_classes(stands), continuous, swept)


def sets_of(
    rows: Mapping[str, Sequence[Row]],
    latents: Mapping[str, NDArray[np.float32]],
    sweeps: Mapping[str, NDArray[np.float32]],
    classes: tuple[str, ...],
    layouts: tuple[str, ...],
    slots: int,
) -> Sets:
    """Collect the rooms of the tables scenes, rooms, openings and objects.

    Left out, with a count per reason: rooms without a layout type, without objects, with more objects than slots.
    """
    scenes = {s["scene_id"]: s for s in rows["scenes"]}
    openings, objects = _group_rows(rows["openings"], "scene_id"), _group_rows(rows["objects"], "scene_id", "room_id")
    known, by_split, left = set(classes), {"train": [], "val": [], "test": []}, Counter()  # type: ignore[var-annotated]
    for room in rows["rooms"]:
        scene, name = scenes[room["scene_id"]], (room["scene_id"], room["room_id"])
        own = [o for o in objects.get(name, []) if o["category"] in known]
        if room["layout_type"] not in layouts:
            left["no-layout-type"] += 1
            continue
        if not 0 < len(own) <= slots:
            left["more-objects-than-slots" if own else "no-objects"] += 1
            continue
        context = context_of(room, openings.get((room["scene_id"],), []), room["level"] * float(scene["storey_height"]))
        layout = layouts.index(room["layout_type"])
        by_split[scene["split"]].append(example_of("/".join(name), scene["split"], layout, context, own, classes, latents, sweeps))
    return Sets(tuple(by_split["train"]), tuple(by_split["val"]), tuple(by_split["test"]), dict(sorted(left.items())))


def _group_rows(rows: Iterable[Row], *keys: str) -> dict[tuple[Any, ...], list[Row]]:
    grouped: dict[tuple[Any, ...], list[Row]] = {}
    for row in rows:
        grouped.setdefault(tuple(row[k] for k in keys), []).append(row)
    return grouped


def sweeps_by_asset(joints: Iterable[Row]) -> dict[str, NDArray[np.float32]]:
    """Return, per asset, the boxes (k <= K, 2, 3) [m] that its joints sweep: the K largest, in the object frame."""
    by_asset = {}
    for (asset,), own in _group_rows(joints, "asset_id").items():
        boxes = np.array([[joint["sweep_min"], joint["sweep_max"]] for joint in own], float)
        by_asset[asset] = boxes[np.argsort(-np.prod(boxes[:, 1] - boxes[:, 0], axis=1), kind="stable")[:SWEEPS]].astype(np.float32)
    return by_asset


def layout_weights(examples: Sequence[Example], power: float = 0.5) -> NDArray[np.float64]:
    """Return sampling weights (n,), summing to 1: a layout type's total grows with its count to the `power`.

    With 0.5 a type that is 16 times rarer is drawn 4 times rarer, so that small bathrooms and rare studies are learnt
    without being repeated as often as bedrooms.
    """
    count = Counter(e.layout for e in examples)
    weight = np.array([count[e.layout] ** (power - 1.0) for e in examples])
    return np.asarray(weight / weight.sum())


def stacked(examples: Sequence[Example]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return all objects' continuous rows (n, 40) and class indices (n,)."""
    rows, classes = [np.zeros((0, CHANNELS))], [np.zeros(0, np.int64)]
    return np.concatenate(rows + [e.continuous for e in examples]), np.concatenate(classes + [e.classes for e in examples])
