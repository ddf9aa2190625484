"""The calibration table: every figure of the corpus beside the reference, its interval, and whether it is met."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from pipeline.corpus import front_statistics as known
from pipeline.corpus.calibration.tally import HouseTally, RoomTally
from pipeline.corpus.front_statistics import Classes, Reference
from pipeline.corpus.furniture import sizes
from pipeline.corpus.furniture.catalogue import Model

TOTAL_VARIATION, RELATIVE = 0.05, 0.10
HISTOGRAM = ((1, 3), (4, 6), (7, 9), (10, 12), (13, 15), (16, 99))
LEAST_MODELS = 20
"""Sizes are held to the reference where it counted so many models."""

Line = dict[str, Any]


def line(ours: float, reference: float, low: float, high: float, n: int, basis: str) -> Line:
    """Return one figure; `n` is what it was measured on here, `basis` what the interval comes from."""
    figures = {"ours": ours, "reference": reference, "low": low, "high": high}
    return {k: round(float(v), 4) for k, v in figures.items()} | {"n": n, "basis": basis, "ok": bool(low <= ours <= high)}


def calibration(houses: Sequence[HouseTally], models: Sequence[Model], centimetres: int) -> dict[str, Any]:
    """Return the whole table by group and name; of the models, so many are written in `centimetres`."""
    reference = known.load()
    rooms = [room for house in houses for room in house.rooms]
    groups: dict[str, Any] = {"houses": len(houses), "rooms": len(rooms), "frequencies": {}, "histograms": {}}
    groups["classes"] = {}
    for name, kind in reference.classes.items():
        kept = filter_rooms(rooms, kind)
        groups["classes"] |= _class_lines(name, kept, kind)
        groups["frequencies"][name] = frequencies(kept, kind)
        groups["histograms"][name] = {
            f"{a}-{b}": {"ours": x, "reference": y} for (a, b), x, y in zip(HISTOGRAM, *_histograms(kept, kind), strict=True)
        }
    groups["rooms_by_house"] = _rooms_by_house(houses, reference)
    groups["areas"] = _areas(rooms, reference)
    groups["shares"] = _shares(houses, rooms, reference)
    groups["relations"] = _relations(houses, reference)
    groups["sizes"] = _sizes(models)
    groups["defects"] = _defects(houses, reference, len(models), centimetres)
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


def _class_lines(name: str, kept: Sequence[Sequence[str]], kind: Classes) -> dict[str, Line]:
    shares = frequencies(kept, kind).values()
    apart = 0.5 * sum(abs(s["ours"] - s["reference"]) for s in shares)
    mean = float(np.mean([len(labels) for labels in kept])) if kept else 0.0
    ours, theirs = _histograms(kept, kind)
    shape = 0.5 * sum(abs(a - b) for a, b in zip(ours, theirs, strict=True))
    noise = _histogram_noise(kind, theirs)
    return {
        f"{name}: total variation of class frequencies": line(apart, 0.0, 0.0, TOTAL_VARIATION, len(kept), "bar"),
        f"{name}: objects per room": line(mean, kind.mean, (1 - RELATIVE) * kind.mean, (1 + RELATIVE) * kind.mean, len(kept), "bar"),
        f"{name}: total variation of the histogram of objects per room": line(shape, 0.0, 0.0, noise, len(kept), "12 scenes, bootstrap"),
    }


def _histograms(kept: Sequence[Sequence[str]], kind: Classes) -> tuple[list[float], list[float]]:
    """Return the shares of rooms by number of objects, ours and those of the 12 scenes with three objects or more."""

    def shares(counts: Sequence[int]) -> list[float]:
        return [round(sum(a <= n <= b for n in counts) / max(1, len(counts)), 4) for a, b in HISTOGRAM]

    return shares([len(labels) for labels in kept]), shares([n for n in kind.objects if n >= 3])


def _histogram_noise(kind: Classes, theirs: Sequence[float]) -> float:
    """Return the 97.5 % quantile of the total variation between the 12 scenes' histogram and resamples of it."""
    from pipeline import seeds

    n = sum(v >= 3 for v in kind.objects)
    p = np.asarray(theirs) / sum(theirs)
    draws = seeds.generator(0, "corpus.calibration.histogram").multinomial(n, p, known.RESAMPLES) / n
    return float(np.percentile(0.5 * np.abs(draws - p).sum(axis=1), 97.5))


def count_furnished(house: HouseTally, reference: Reference) -> int:
    """Return how many of a house's rooms hold two objects or more, those beyond 3D-FRONT left out."""
    return sum(len(r.categories) >= 2 and r.type not in reference.beyond for r in house.rooms)


def _rooms_by_house(houses: Sequence[HouseTally], reference: Reference) -> dict[str, Line]:
    top = len(reference.furnished_rooms)
    counted = Counter(min(count_furnished(house, reference), top) for house in houses)
    whole, n = sum(reference.furnished_rooms), max(1, len(houses))
    lines = {}
    for k, count in enumerate(reference.furnished_rooms, 1):
        theirs = count / whole
        half = 1.96 * float(np.sqrt(theirs * (1 - theirs) / n)) + 0.5 / n
        name = f"{k}{'+' if k == top else ''} furnished rooms"
        lines[name] = line(counted[k] / n, theirs, max(0.0, theirs - half), theirs + half, n, "sampling of our houses")
    return lines


def _areas(rooms: Sequence[RoomTally], reference: Reference) -> dict[str, Line]:
    lines = {}
    for name, (n, mean, least, most) in reference.areas.items():
        ours = [r.area for r in rooms if r.type == name.lower()]
        if ours:
            low, high = known.from_range(n, mean, least, most)
            lines[f"{name} [m2]"] = line(float(np.mean(ours)), mean, low, high, len(ours), f"{n} rooms of 12 scenes, from their range")
    return lines


def _shares(houses: Sequence[HouseTally], rooms: Sequence[RoomTally], reference: Reference) -> dict[str, Line]:
    lines = {name: _share(houses, name, *counts) for name, counts in reference.shares.items()}
    n, mean, least, most = reference.walkable
    ours = [r.walkable for r in rooms if r.walkable is not None and r.type not in reference.beyond]
    low, high = known.from_range(n, mean, least, most)
    lines["walkable"] = line(float(np.mean(ours)) if ours else 1.0, mean, low, high, len(ours), f"{n} rooms of 12 scenes, from their range")
    return lines


def _share(houses: Sequence[HouseTally], name: str, count: int, of: int) -> Line:
    hits, cases = (sum(h.shares[name][k] for h in houses) for k in (0, 1))
    low, high = known.bootstrap_share(count, of)
    return line(hits / max(1, cases), count / of, low, high, cases, "12 scenes, bootstrap")


def _relations(houses: Sequence[HouseTally], reference: Reference) -> dict[str, Line]:
    lines = {}
    for name, values in reference.relations.items():
        ours = [v for h in houses for v in h.relations[name]]
        if ours:
            low, high = known.bootstrap(values)
            lines[f"{name} [m]"] = line(
                float(np.mean(ours)), float(np.mean(values)), low, high, len(ours), f"{len(values)} of 12 scenes, bootstrap"
            )
    return lines


def _sizes(models: Iterable[Model]) -> dict[str, Line]:
    """Return mean and spread of every axis over the distinct models of a category."""
    by: dict[str, list[tuple[float, float, float]]] = {}
    for model in models:
        by.setdefault(model.category, []).append(model.size)
    lines = {}
    for category, statistics in sizes.load().items():
        if statistics.models < LEAST_MODELS or category not in by:
            continue
        box = np.array(by[category], float)
        for axis, letter in enumerate("wdh"):
            for word, ours, theirs in (
                ("mean", box[:, axis].mean(), statistics.mean[axis]),
                ("spread", box[:, axis].std(), statistics.std[axis]),
            ):
                bounds = ((1 - RELATIVE) * float(theirs), (1 + RELATIVE) * float(theirs))
                lines[f"{category}, {letter}, {word} [m]"] = line(float(ours), float(theirs), *bounds, len(box), "bar")
    return lines


def _defects(houses: Sequence[HouseTally], reference: Reference, models: int, centimetres: int) -> dict[str, Line]:
    lines = {name: _share(houses, name, *counts) for name, counts in reference.defects.items() if name != "centimetres"}
    count, of = reference.defects["centimetres"]
    total = max(1, models)
    # One model is the least that can be in centimetres: of few models it is more than the observed share.
    high = max(known.bootstrap_share(count, of)[1], 1.5 / total)
    lines["centimetres"] = line(centimetres / total, count / of, 0.0, high, total, "release, bootstrap; at least one model")
    return lines


def table(groups: Mapping[str, Any]) -> Iterable[tuple[str, str, Line]]:
    """Yield (group, name, line) of every line that is held to something."""
    for group, lines in groups.items():
        if isinstance(lines, dict):
            yield from ((group, name, entry) for name, entry in lines.items() if "ok" in entry)
