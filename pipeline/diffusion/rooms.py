"""Training rooms: table rows to padded arrays."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pipeline.diffusion.codec import CHANNELS, LATENT, class_indices, continuous_rows
from pipeline.diffusion.context import RoomContext, RoomOpening
from pipeline.diffusion.floor import Floor, floor_tokens

Row = Mapping[str, Any]
SWEEPS = 4  # boxes per object


@dataclass(frozen=True, slots=True)
class Example:
    """One furnished room, n objects, room frame.

    `classes` (n,); `continuous` (n, 40) in metres, cos, sin, raw latents; `sweeps` (n, K, 2, 3) [m], object frame, NaN
    for none; `height` of the ceiling [m].
    """

    key: str
    split: str
    layout: int
    classes: NDArray[np.int64]
    continuous: NDArray[np.float64]
    sweeps: NDArray[np.float32]
    floor: Floor
    height: float


@dataclass(frozen=True, slots=True)
class Sets:
    """Examples by split, and how many rooms were left out for which reason."""

    train: tuple[Example, ...]
    val: tuple[Example, ...]
    test: tuple[Example, ...]
    left_out: Mapping[str, int]


def context_of(room: Row, openings: Iterable[Row]) -> RoomContext:
    """Build the context of a rooms row and the openings of its scene."""
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
    return RoomContext(str(room["layout_type"]), np.array(room["polygon"], float), room_openings, height=float(room["height"]))


def example_of(
    room: Row,
    objects: Sequence[Row],
    context: RoomContext,
    split: str,
    layout: int,
    classes: tuple[str, ...],
    latents: Mapping[str, NDArray[np.float32]],
    sweeps: Mapping[str, NDArray[np.float32]],
    floor_z: float,
) -> Example:
    """Build one example from the rows of a room."""
    position = np.array([o["position"] for o in objects], float).reshape(-1, 3) - [*context.centre, floor_z]
    size, yaw = np.array([o["size"] for o in objects], float).reshape(-1, 3), np.array([o["yaw"] for o in objects], float)
    latent = np.array([latents.get(o["asset_id"], np.zeros(LATENT)) for o in objects], np.float32).reshape(-1, LATENT)
    swept = np.full((len(objects), SWEEPS, 2, 3), np.nan, np.float32)
    for i, row in enumerate(objects):
        boxes = sweeps.get(row["asset_id"])
        if boxes is not None and row["openable"]:
            swept[i, : len(boxes)] = boxes[:SWEEPS] * np.array(row["scale"], np.float32)
    return Example(
        f"{room['scene_id']}/{room['room_id']}",
        split,
        layout,
        class_indices([o["category"] for o in objects], classes),
        continuous_rows(position, size, yaw, latent),
        swept,
        floor_tokens(context),
        float(room["height"]),
    )


def sets_of(
    tables: Mapping[str, Sequence[Row]],
    latents: Mapping[str, NDArray[np.float32]],
    sweeps: Mapping[str, NDArray[np.float32]],
    classes: tuple[str, ...],
    layouts: tuple[str, ...],
    slots: int,
) -> Sets:
    """Collect the rooms of the tables scenes, rooms, openings and objects.

    Left out, with a count per reason: rooms without a layout type, without objects, with more objects than slots.
    """
    split = {s["scene_id"]: s["split"] for s in tables["scenes"]}
    storey = {s["scene_id"]: float(s["storey_height"]) for s in tables["scenes"]}
    openings, objects = _group_rows(tables["openings"], "scene_id"), _group_rows(tables["objects"], "scene_id", "room_id")
    known, by_split, left = set(classes), {"train": [], "val": [], "test": []}, Counter()  # type: ignore[var-annotated]
    for room in tables["rooms"]:
        rows = [o for o in objects.get((room["scene_id"], room["room_id"]), []) if o["category"] in known]
        reason = _reason(room, rows, layouts, slots)
        if reason:
            left[reason] += 1
            continue
        scene = room["scene_id"]
        context = context_of(room, openings.get((scene,), []))
        floor_z = room["level"] * storey[scene]
        example = example_of(room, rows, context, split[scene], layouts.index(room["layout_type"]), classes, latents, sweeps, floor_z)
        by_split[example.split].append(example)
    return Sets(tuple(by_split["train"]), tuple(by_split["val"]), tuple(by_split["test"]), dict(sorted(left.items())))


def _reason(room: Row, rows: Sequence[Row], layouts: tuple[str, ...], slots: int) -> str:
    if room["layout_type"] not in layouts:
        return "no-layout-type"
    if not rows:
        return "no-objects"
    return "more-objects-than-slots" if len(rows) > slots else ""


def _group_rows(rows: Iterable[Row], *keys: str) -> dict[tuple[Any, ...], list[Row]]:
    grouped: dict[tuple[Any, ...], list[Row]] = {}
    for row in rows:
        grouped.setdefault(tuple(row[k] for k in keys), []).append(row)
    return grouped


def sweeps_by_asset(joints: Iterable[Row]) -> dict[str, NDArray[np.float32]]:
    """Return, per asset, the boxes (k <= K, 2, 3) [m] that its joints sweep: the K largest, in the object frame."""
    boxes: dict[str, list[NDArray[np.float64]]] = {}
    for joint in joints:
        boxes.setdefault(joint["asset_id"], []).append(np.array([joint["sweep_min"], joint["sweep_max"]], float))
    by_asset = {}
    for asset, listed in boxes.items():
        volume = [-float(np.prod(box[1] - box[0])) for box in listed]
        by_asset[asset] = np.array([listed[i] for i in np.argsort(volume, kind="stable")[:SWEEPS]], np.float32)
    return by_asset


def layout_weights(examples: Sequence[Example], power: float = 0.5) -> NDArray[np.float64]:
    """Return sampling weights (n,), summing to 1: a layout type's total grows with its count to the `power`.

    With 0.5 a type that is 16 times rarer is drawn 4 times rarer, so that small bathrooms and rare studies are learnt
    without being repeated as often as bedrooms.
    """
    count = Counter(e.layout for e in examples)
    weight = np.array([count[e.layout] ** (power - 1.0) for e in examples])
    return np.asarray(weight / weight.sum())


def stacked_rows(examples: Sequence[Example]) -> NDArray[np.float64]:
    """Return all objects' continuous rows (n, 40)."""
    return np.concatenate([e.continuous for e in examples] or [np.zeros((0, CHANNELS))])


def stacked_classes(examples: Sequence[Example]) -> NDArray[np.int64]:
    """Return all objects' class indices (n,)."""
    return np.concatenate([e.classes for e in examples] or [np.zeros(0, np.int64)])
