"""What the corpus is like, beside what is known of 3D-FRONT: class frequencies, objects per room, areas, walkable floor.

Counted over the labels of ATISS and after its filters, as the reference was. Reference numbers: dataset_stats.txt of the
ATISS family for bedrooms (19,372 objects) and living rooms (7,265), and 12 real scenes for the rest.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from shapely.geometry import Polygon
from shapely.ops import unary_union

from pipeline.corpus.houses.records import House, Item

SOFAS = ("multi_seat_sofa", "loveseat_sofa", "l_shaped_sofa", "lazy_sofa", "chaise_longue_sofa")
# Our category -> ATISS label where they differ.
BEDROOM_LABELS = dict.fromkeys(SOFAS, "sofa") | {
    "dining_chair": "chair",
    "lounge_chair": "chair",
    "chinese_chair": "chair",
    "corner_side_table": "table",
    "round_end_table": "table",
    "dining_table": "table",
    "sideboard": "cabinet",
    "wine_cabinet": "cabinet",
    "shoe_cabinet": "cabinet",
}
LIVING_LABELS = {"sideboard": "console_table", "children_cabinet": "cabinet", "shoe_cabinet": "cabinet"}
# Objects counted in the filtered rooms of train and val.
BEDROOM_COUNTS = {
    "nightstand": 5278, "double_bed": 3320, "wardrobe": 3115, "pendant_lamp": 2459, "ceiling_lamp": 1222, "tv_stand": 579, "chair": 442,
    "single_bed": 411, "dressing_table": 404, "cabinet": 391, "table": 381, "desk": 315, "stool": 222, "shelf": 158, "kids_bed": 158,
    "bookshelf": 139, "children_cabinet": 139, "dressing_chair": 119, "armchair": 72, "sofa": 29, "coffee_table": 19,
}  # fmt: skip
LIVING_COUNTS = {
    "dining_chair": 1852, "pendant_lamp": 965, "coffee_table": 626, "corner_side_table": 526, "dining_table": 505, "tv_stand": 452,
    "multi_seat_sofa": 385, "armchair": 351, "console_table": 269, "lounge_chair": 235, "stool": 192, "cabinet": 168, "bookshelf": 160,
    "loveseat_sofa": 152, "ceiling_lamp": 132, "wine_cabinet": 88, "l_shaped_sofa": 75, "round_end_table": 42, "shelf": 26,
    "chinese_chair": 23, "wardrobe": 20, "chaise_longue_sofa": 8, "desk": 7, "lazy_sofa": 6,
}  # fmt: skip
# Mean room areas of 12 scenes [m2]; and two shares of the same scenes.
REFERENCE_AREAS = {
    "MasterBedroom": 16.82, "SecondBedroom": 11.91, "Bedroom": 14.45, "LivingDiningRoom": 32.85, "LivingRoom": 17.63, "DiningRoom": 18.36,
    "Kitchen": 6.26, "Bathroom": 4.76, "Balcony": 3.05, "Library": 9.02, "Hallway": 3.52, "Aisle": 2.41, "KidsRoom": 8.49, "StorageRoom": 2.62,
}  # fmt: skip
REFERENCE_RECTANGULAR, REFERENCE_WALKABLE = 0.614, 0.673


@dataclass(frozen=True, slots=True)
class Peers:
    """A room kind as the peers see it: words in the type's name, label map, reference counts and mean, filter bounds."""

    word: str
    labels: Mapping[str, str]
    counts: Mapping[str, int]
    mean: float
    most: int
    side: float


PEERS = {
    "bedroom": Peers("bed", BEDROOM_LABELS, BEDROOM_COUNTS, 4.98, 13, 6.0),
    "living": Peers("living", LIVING_LABELS, LIVING_COUNTS, 11.18, 21, 12.0),
}


def statistics(houses: Sequence[House]) -> dict[str, Any]:
    """Return figures of the corpus, each as {"ours": ..., "reference": ...} where a reference exists."""
    rooms = [(house, k) for house in houses for k in range(len(house.plan.rooms))]
    areas: dict[str, list[float]] = defaultdict(list)
    for house, k in rooms:
        areas[house.plan.rooms[k].type].append(house.plan.rooms[k].area)
    rectangular = [_rectangularity(house, k) > 0.99 for house, k in rooms]
    peopled = [(house, k, [i for i in house.items if i.room == k]) for house, k in rooms]
    walkable = [_walkable(house, k, items) for house, k, items in peopled if len(items) >= 3]
    figures: dict[str, Any] = {
        "houses": len(houses),
        "rooms": len(rooms),
        "rooms_with_2_objects": sum(len(items) >= 2 for _, _, items in peopled),
        "rectangular": {"ours": float(np.mean(rectangular)), "reference": REFERENCE_RECTANGULAR},
        "walkable": {"ours": float(np.mean(walkable)) if walkable else 1.0, "reference": REFERENCE_WALKABLE},
        "areas": {t: {"ours": float(np.mean(v)), "n": len(v), "reference": REFERENCE_AREAS.get(t)} for t, v in sorted(areas.items())},
        "oblique": float(np.mean([abs(np.sin(2 * i.yaw)) > 0.035 for h in houses for i in h.items])),
    }
    for name, peers in PEERS.items():
        figures[name] = class_figures(
            [(h.plan.rooms[k].polygon, i) for h, k, i in peopled if peers.word in h.plan.rooms[k].type.lower()], peers
        )
    return figures


def class_figures(rooms: Sequence[tuple[Any, Sequence[Item]]], peers: Peers) -> dict[str, Any]:
    """Return the total variation distance of class frequencies and the mean number of objects, after the peers' filters."""
    kept = []
    for polygon, items in rooms:
        labels = [peers.labels.get(i.model.category, i.model.category) for i in items]
        if 3 <= len(labels) <= peers.most and set(labels) <= set(peers.counts) and np.ptp(polygon, axis=0).max() <= peers.side:
            kept.append(labels)
    counted = Counter(label for labels in kept for label in labels)
    total, reference = max(1, sum(counted.values())), sum(peers.counts.values())
    distance = 0.5 * sum(abs(counted[c] / total - n / reference) for c, n in peers.counts.items())
    return {
        "rooms": len(kept),
        "total_variation": distance,
        "objects_per_room": {"ours": total / max(1, len(kept)), "reference": peers.mean},
        "frequencies": {c: {"ours": counted[c] / total, "reference": n / reference} for c, n in peers.counts.items()},
    }


def _rectangularity(house: House, k: int) -> float:
    """Return a room's area over that of its bounds; rooms are square to the axes."""
    room = house.plan.rooms[k]
    return float(room.area / np.prod(np.ptp(room.polygon, axis=0)))


def _walkable(house: House, k: int, items: Sequence[Item]) -> float:
    """Return the share of a room's floor under no piece that stands on it."""
    room = house.plan.rooms[k]
    covered = unary_union([Polygon(i.corners()) for i in items if i.position[2] < 1.0]).intersection(Polygon(room.polygon))
    return float(1.0 - covered.area / room.area)
