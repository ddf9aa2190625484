"""The calibration: each house of the corpus counted as the reference was counted on real files, and every figure beside the reference, its interval, and whether it is met."""

import itertools
import math
import sys
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from shapely.geometry import Polygon
from shapely.ops import unary_union

from pipeline import seeds
from pipeline.card import cards
from pipeline.corpus import front_statistics as known
from pipeline.corpus.front_statistics import Classes, Interval, Reference
from pipeline.corpus.furniture.catalogue import Model
from pipeline.corpus.houses.records import House, Item
from pipeline.manifest import write_bytes, write_json

Json = Mapping[str, Any]
STANDING = 0.3  # what starts lower stands on the floor [m]
SOFAS = frozenset({"multi_seat_sofa", "loveseat_sofa", "l_shaped_sofa"})
DINING = frozenset({"dining_chair", "chinese_chair"})
NEAR_TABLE, ABOVE_TABLE = 1.6, 0.45  # a chair belongs to a table within this distance, a lamp hangs above one within that [m]
TOTAL_VARIATION, RELATIVE = 0.05, 0.10
HISTOGRAM = ((1, 3), (4, 6), (7, 9), (10, 12), (13, 15), (16, 99))
LEAST_MODELS = 20  # sizes are held to the reference where it counted so many models


@dataclass(frozen=True, slots=True)
class RoomTally:
    """One room as it is counted.

    `type` is 3D-FRONT's in lower case; `area` [m2]; `side` the longest of the floor's bounds [m]; `categories` those of what the
    peers count; `walkable` the share of the floor under nothing, None below three objects.
    """

    type: str
    area: float
    rectangular: bool
    side: float
    categories: tuple[str, ...]
    mirrored: bool
    walkable: float | None


@dataclass(slots=True)
class HouseTally:
    """One house; `shares` are (how many, of how many) by name, `relations` lists of lengths [m]."""

    rooms: list[RoomTally] = field(default_factory=list)
    shares: dict[str, tuple[int, int]] = field(default_factory=dict)
    relations: dict[str, list[float]] = field(default_factory=dict)


def tally(house: House, scene: Json, reference: Reference) -> HouseTally:
    """Count a house and its scene file."""
    house_tally = HouseTally(relations={name: [] for name in reference.relations})
    outside, overlapping, oblique, objects, pairs = 0, 0, 0, 0, 0
    for number, room in enumerate(house.plan.rooms):
        items = [i for i in house.items if i.room == number and reference.counted(i.model.category)]
        polygon = Polygon(room.polygon)
        shapes = [Polygon(i.corners()) for i in items]
        house_tally.rooms.append(_room(room.type, polygon, items, shapes))
        for item, shape in zip(items, shapes, strict=True):
            objects += 1
            outside += not polygon.covers(shape) and shape.intersection(polygon).area < 0.95 * shape.area
            oblique += abs(math.sin(2 * item.yaw)) > 0.035
        count, together = _overlaps(items, shapes)
        overlapping, pairs = overlapping + count, pairs + together
        relate(items, house_tally.relations)
    house_tally.shares = _defects(scene) | {
        "outside": (outside, objects),
        "overlapping": (overlapping, pairs),
        "oblique": (oblique, objects),
        "rectangular": (sum(r.rectangular for r in house_tally.rooms), len(house_tally.rooms)),
    }
    return house_tally


def _room(room_type: str, polygon: Polygon, items: Sequence[Item], shapes: Sequence[Polygon]) -> RoomTally:
    x0, y0, x1, y1 = polygon.bounds
    share = None
    if len(items) >= 3:
        standing = [s for i, s in zip(items, shapes, strict=True) if i.position[2] < STANDING]
        share = 1.0 - unary_union(standing).intersection(polygon).area / polygon.area if standing else 1.0
    mirrored = any(min(i.scale) < 0 for i in items)
    categories = tuple(i.model.category for i in items)
    rectangular = polygon.area > 0.99 * (x1 - x0) * (y1 - y0)
    return RoomTally(room_type.lower(), float(polygon.area), rectangular, max(x1 - x0, y1 - y0), categories, mirrored, share)


def _overlaps(items: Sequence[Item], shapes: Sequence[Polygon]) -> tuple[int, int]:
    """Return how many pairs of things on the floor overlap by more than 1 % of the smaller, and how many pairs there are."""
    pairs = list(itertools.combinations([s for i, s in zip(items, shapes, strict=True) if i.position[2] < STANDING], 2))
    return sum(one.intersection(other).area > 0.01 * min(one.area, other.area) for one, other in pairs), len(pairs)


def local(frame: Item, item: Item) -> tuple[float, float]:
    """Return an item's place in another's frame: (to the right, in front) [m]."""
    c, s = math.cos(frame.yaw), math.sin(frame.yaw)
    dx, dy = item.position[0] - frame.position[0], item.position[1] - frame.position[1]
    return c * dx + s * dy, s * dx - c * dy


def relate(items: Sequence[Item], lengths: dict[str, list[float]]) -> None:
    """Append the lengths of the relations that the pieces of one room stand in."""
    by: dict[str, list[Item]] = {}
    for item in items:
        by.setdefault(item.model.category, []).append(item)
    sofas = [i for name in sorted(SOFAS) for i in by.get(name, ())]
    for bed in by.get("double_bed", ()):
        for stand in by.get("nightstand", ()):
            if abs(math.remainder(stand.yaw - bed.yaw, 2 * math.pi)) < 0.1:
                across, ahead = local(bed, stand)
                lengths["nightstand beside double_bed, across"].append(abs(across))
                lengths["nightstand beside double_bed, ahead"].append(ahead)
        _opposite(bed, by.get("tv_stand", ()), lengths["tv_stand before double_bed, ahead"], lengths["tv_stand before double_bed, across"])
    for sofa in sofas:
        _opposite(sofa, by.get("tv_stand", ()), lengths["tv_stand before sofa, ahead"], [])
    for table in by.get("coffee_table", ()):
        places = [local(sofa, table) for sofa in sofas]
        in_front = [(ahead, abs(across)) for across, ahead in places if 0.3 < ahead < 2.5 and abs(across) < 1.0]
        if in_front:
            lengths["coffee_table before sofa, ahead"].append(min(in_front)[0])
            lengths["coffee_table before sofa, across"].append(min(in_front)[1])
    for table in by.get("dining_table", ()):
        for name, categories, most in (
            ("dining_chair from the table's centre", DINING, NEAR_TABLE),
            ("pendant_lamp from the table's centre", {"pendant_lamp"}, ABOVE_TABLE),
        ):
            distances = [math.dist(i.position[:2], table.position[:2]) for i in items if i.model.category in categories]
            lengths[name] += [d for d in distances if d < most]


def _opposite(seat: Item, stands: Sequence[Item], ahead: list[float], across: list[float]) -> None:
    for stand in stands:
        right, front = local(seat, stand)
        if math.cos(stand.yaw - seat.yaw) < -0.99 and abs(right) < 1.0 and 0.5 < front < 6.0:
            ahead.append(front)
            across.append(abs(right))


def _defects(scene: Json) -> dict[str, tuple[int, int]]:
    """Count a scene file's defects, as (how many, of how many)."""
    records = scene["furniture"]
    uids = Counter(r["uid"] for r in records)
    meshes = {m["uid"]: m for m in scene["mesh"]}
    rooms = scene["scene"]["room"]
    children = [c for room in rooms for c in room["children"] if c["instanceid"].startswith("furniture/")]
    floorless = sum(not any(meshes.get(c["ref"], {}).get("type") == "Floor" for c in room["children"]) for room in rooms)
    return {
        "dangling": (sum(c["ref"] not in uids for c in children), len(children)),
        "invalid": (sum(r.get("valid") is False for r in records), len(records)),
        "surplus": (len(records) - len(uids), len(records)),
        "floorless": (floorless, len(rooms)),
        "mirrored": (sum(bool(np.min(c["scale"]) < 0) for c in children), len(children)),
    }


Figure = dict[str, Any]


def figure(ours: float, reference: float, interval: Interval, n: int, basis: str) -> Figure:
    """Return one figure; `n` is what it was measured on here, `basis` what the interval comes from."""
    figures = {"ours": ours, "reference": reference, "low": interval[0], "high": interval[1]}
    return {k: round(float(v), 4) for k, v in figures.items()} | {"n": n, "basis": basis, "ok": bool(interval[0] <= ours <= interval[1])}


def within(reference: float) -> Interval:
    """Return the interval of RELATIVE around a figure."""
    return (1 - RELATIVE) * reference, (1 + RELATIVE) * reference


def calibration(houses: Sequence[HouseTally], models: Sequence[Model], centimetres: int) -> dict[str, Any]:
    """Return the whole table by group and name; of the models, so many are written in `centimetres`."""
    reference = known.load()
    rooms = [room for house in houses for room in house.rooms]
    groups: dict[str, Any] = {"houses": len(houses), "rooms": len(rooms), "frequencies": {}, "histograms": {}, "classes": {}}
    for name, kind in reference.classes.items():
        kept = filter_rooms(rooms, kind)
        groups["frequencies"][name] = frequencies(kept, kind)
        ours, theirs = histogram([len(labels) for labels in kept]), histogram([n for n in kind.objects if n >= 3])
        bins = zip(HISTOGRAM, ours, theirs, strict=True)
        groups["histograms"][name] = {f"{a}-{b}": {"ours": x, "reference": y} for (a, b), x, y in bins}
        apart = 0.5 * sum(abs(s["ours"] - s["reference"]) for s in groups["frequencies"][name].values())
        mean = float(np.mean([len(labels) for labels in kept])) if kept else 0.0
        shape = 0.5 * sum(abs(a - b) for a, b in zip(ours, theirs, strict=True))
        noise, n = _histogram_noise(kind, theirs), len(kept)
        groups["classes"] |= {
            f"{name}: total variation of class frequencies": figure(apart, 0.0, (0.0, TOTAL_VARIATION), n, "bar"),
            f"{name}: objects per room": figure(mean, kind.mean, within(kind.mean), n, "bar"),
            f"{name}: total variation of the histogram of objects per room": figure(shape, 0.0, (0.0, noise), n, "12 scenes, bootstrap"),
        }
    groups["rooms_by_house"] = _rooms_by_house(houses, reference)
    areas = {name: [r.area for r in rooms if r.type == name.lower()] for name in reference.areas}
    groups["areas"] = {f"{name} [m2]": _of_range(areas[name], known) for name, known in reference.areas.items() if areas[name]}
    groups["shares"] = {name: _share(houses, name, *counts) for name, counts in reference.shares.items()}
    walkable = [r.walkable for r in rooms if r.walkable is not None and r.type not in reference.beyond]
    groups["shares"]["walkable"] = _of_range(walkable, reference.walkable)
    groups["relations"] = {}
    for name, values in reference.relations.items():
        lengths = [v for h in houses for v in h.relations[name]]
        if lengths:
            here, there, basis = float(np.mean(lengths)), float(np.mean(values)), f"{len(values)} of 12 scenes, bootstrap"
            groups["relations"][f"{name} [m]"] = figure(here, there, known.bootstrap(values), len(lengths), basis)
    groups["sizes"] = _sizes(models)
    groups["defects"] = {name: _share(houses, name, *counts) for name, counts in reference.defects.items() if name != "centimetres"}
    count, of = reference.defects["centimetres"]
    total = max(1, len(models))
    # One model is the least that can be in centimetres: of few models it is more than the observed share.
    high = max(known.bootstrap_share(count, of)[1], 1.5 / total)
    groups["defects"]["centimetres"] = figure(centimetres / total, count / of, (0.0, high), total, "release, bootstrap; at least one model")
    return groups


def filter_rooms(rooms: Iterable[RoomTally], kind: Classes) -> list[list[str]]:
    """Return the labels of each room that the peers' filters keep: three objects or more, not too large, nothing mirrored."""
    kept = []
    for room in rooms:
        labels = [label for c in room.categories if (label := kind.label(c)) is not None]
        fits = kind.word in room.type and 3 <= len(labels) <= kind.most and room.side <= kind.side and not room.mirrored
        if fits and (not kind.needs or set(kind.needs) & set(labels)):
            kept.append(labels)
    return kept


def frequencies(kept: Sequence[Sequence[str]], kind: Classes) -> dict[str, dict[str, float]]:
    """Return the share of each label among the objects, beside the reference's."""
    counted = Counter(label for labels in kept for label in labels)
    total, whole = max(1, sum(counted.values())), sum(kind.counts.values())
    return {c: {"ours": round(counted[c] / total, 4), "reference": round(n / whole, 4)} for c, n in kind.counts.items()}


def histogram(counts: Sequence[int]) -> list[float]:
    """Return the shares of rooms by number of objects."""
    return [round(sum(a <= n <= b for n in counts) / max(1, len(counts)), 4) for a, b in HISTOGRAM]


def _histogram_noise(kind: Classes, theirs: Sequence[float]) -> float:
    """Return the 97.5 % quantile of the total variation between the 12 scenes' histogram and resamples of it."""
    n = sum(v >= 3 for v in kind.objects)
    p = np.asarray(theirs) / sum(theirs)
    draws = seeds.generator(0, "corpus.calibration.histogram").multinomial(n, p, known.RESAMPLES) / n
    return float(np.percentile(0.5 * np.abs(draws - p).sum(axis=1), 97.5))


def _rooms_by_house(houses: Sequence[HouseTally], reference: Reference) -> dict[str, Figure]:
    """Return how many houses have so many rooms with two objects or more, those beyond 3D-FRONT left out."""
    top = len(reference.furnished_rooms)
    furnished = [sum(len(r.categories) >= 2 and r.type not in reference.beyond for r in house.rooms) for house in houses]
    counted = Counter(min(count, top) for count in furnished)
    whole, n = sum(reference.furnished_rooms), max(1, len(houses))
    figures = {}
    for k, count in enumerate(reference.furnished_rooms, 1):
        theirs = count / whole
        half = 1.96 * float(np.sqrt(theirs * (1 - theirs) / n)) + 0.5 / n
        interval = max(0.0, theirs - half), theirs + half
        figures[f"{k}{'+' if k == top else ''} furnished rooms"] = figure(counted[k] / n, theirs, interval, n, "sampling of our houses")
    return figures


def _of_range(ours: Sequence[float], reference: tuple[int, float, float, float]) -> Figure:
    n, mean, least, most = reference
    basis = f"{n} rooms of 12 scenes, from their range"
    return figure(float(np.mean(ours)) if ours else 1.0, mean, known.from_range(n, mean, least, most), len(ours), basis)


def _share(houses: Sequence[HouseTally], name: str, count: int, of: int) -> Figure:
    hits, cases = (sum(h.shares[name][k] for h in houses) for k in (0, 1))
    return figure(hits / max(1, cases), count / of, known.bootstrap_share(count, of), cases, "12 scenes, bootstrap")


def _sizes(models: Iterable[Model]) -> dict[str, Figure]:
    """Return mean and spread of every axis over the distinct models of a category."""
    sizes: dict[str, list[tuple[float, float, float]]] = {}
    for model in models:
        sizes.setdefault(model.category, []).append(model.size)
    figures = {}
    for category, theirs in ((name, card.size) for name, card in cards().items()):
        if theirs.n < LEAST_MODELS or category not in sizes:
            continue
        box = np.array(sizes[category], float)
        for axis, letter in enumerate("wdh"):
            for word, ours, wanted in (("mean", box.mean(axis=0), theirs.mean), ("spread", box.std(axis=0), theirs.std)):
                name = f"{category}, {letter}, {word} [m]"
                figures[name] = figure(float(ours[axis]), wanted[axis], within(wanted[axis]), len(box), "bar")
    return figures


def write_calibration(root: Path, groups: Mapping[str, Any]) -> None:
    """Write metrics/calibration.json and plots/classes.csv under `root`, and say how much of the table is met."""
    write_json(root / "metrics" / "calibration.json", groups)
    rows = [f"{kind}: {c},{v['ours']},{v['reference']}" for kind, shares in groups["frequencies"].items() for c, v in shares.items()]
    write_bytes(root / "plots" / "classes.csv", "\n".join(["class,ours,reference", *rows, ""]).encode())
    tables = [figures for figures in groups.values() if isinstance(figures, dict)]
    verdicts = [figure["ok"] for figures in tables for figure in figures.values() if "ok" in figure]
    sys.stdout.write(f"calibration: {sum(verdicts)} of {len(verdicts)} figures as in 3D-FRONT (metrics/calibration.json)\n")
