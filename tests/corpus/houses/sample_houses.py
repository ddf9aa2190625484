"""Models and houses that the tests of this folder share: boxes of plausible sizes, no meshes."""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np

from pipeline import taxonomy
from pipeline.card import cards
from pipeline.corpus.houses.house import make_house
from pipeline.corpus.houses.records import House
from pipeline.corpus.houses.stock import Stock

SIZES = {
    "double_bed": (1.9, 2.15, 1.1), "single_bed": (1.3, 2.1, 1.0), "kids_bed": (1.4, 2.0, 1.4), "nightstand": (0.5, 0.42, 0.55),
    "wardrobe": (1.5, 0.6, 2.2), "cabinet": (1.0, 0.44, 0.95), "children_cabinet": (1.1, 0.45, 1.4), "sideboard": (1.3, 0.42, 0.9),
    "bookshelf": (1.2, 0.38, 2.0), "shelf": (0.56, 0.33, 1.27), "tv_stand": (1.8, 0.44, 0.55), "wine_cabinet": (1.0, 0.38, 1.9),
    "desk": (1.3, 0.65, 0.78), "dressing_table": (1.1, 0.5, 1.3), "dining_table": (1.4, 0.85, 0.76), "coffee_table": (1.0, 0.7, 0.45),
    "corner_side_table": (0.5, 0.5, 0.55), "round_end_table": (0.48, 0.48, 0.55), "dining_chair": (0.5, 0.54, 0.85),
    "lounge_chair": (0.68, 0.7, 0.88), "dressing_chair": (0.46, 0.5, 0.7), "chinese_chair": (0.58, 0.5, 0.95), "barstool": (0.4, 0.4, 1.0),
    "stool": (0.55, 0.45, 0.44), "multi_seat_sofa": (2.3, 0.92, 0.84), "loveseat_sofa": (1.8, 0.9, 0.83), "l_shaped_sofa": (2.7, 1.6, 0.84),
    "armchair": (0.82, 0.82, 0.84), "lazy_sofa": (0.9, 0.9, 0.7), "chaise_longue_sofa": (1.6, 0.85, 0.8), "pendant_lamp": (0.6, 0.55, 0.85),
    "ceiling_lamp": (0.6, 0.6, 0.25), "floor_lamp": (0.42, 0.42, 1.5), "wall_lamp": (0.2, 0.2, 0.4),
}  # fmt: skip


@dataclass(frozen=True)
class Box:
    model_id: str
    category: str
    size: tuple[float, float, float]
    style: str
    super_category: str
    future_name: str


@dataclass(frozen=True)
class Faces:
    boxes: np.ndarray
    tops: np.ndarray


def faces(model: Box) -> Faces:
    """A board on top, and in shelves one in the middle between two sides."""
    w, d, h = model.size
    boards = [(h - 0.02, h)] + ([(h / 2 - 0.02, h / 2)] if model.category in {"bookshelf", "shelf"} else [])
    boxes = [[[-w / 2, -d / 2, low], [w / 2, d / 2, high]] for low, high in boards]
    boxes += [[[s * w / 2 - 0.02 * (s > 0), -d / 2, 0.0], [s * w / 2 + 0.02 * (s < 0), d / 2, h]] for s in (-1, 1)]
    tops = [[-w / 2 + 0.02, -d / 2, w / 2 - 0.02, d / 2, high] for _, high in boards]
    return Faces(np.array(boxes), np.array(tops))


@functools.cache
def stock() -> Stock:
    rng = np.random.default_rng(3)
    models = []
    for category in taxonomy.load().categories.values():
        for k in range(4):
            stretch = rng.uniform(0.9, 1.1, 2)
            w, d, h = SIZES.get(category.name) or cards()[category.name].size.mean
            if category.super == "kitchen":  # units come in widths
                w = (0.4, 0.6, 0.8, 0.9)[k]
            size = (round(w * float(stretch[0]), 3), round(d * float(stretch[1]), 3), h)
            models.append(
                Box(f"{category.name}-{k}", category.name, size, ("Modern", "Nordic")[k % 2], category.super, category.names.future[0])
            )
    return Stock(models, faces)


@functools.cache
def house(index: int, seed: int = 5) -> House:
    return make_house(seed, index, stock())


def houses(count: int = 24) -> list[House]:
    return [house(k) for k in range(count)]
