"""What furniture weighs [kg]: the range of each category, to which an estimate by volume and density is held.

An estimate is no better than the mesh: one that is a shell weighs too little, one whose hollows are filled too much. The
ranges are wide: from light to heavy products as makers and shipping lists state them, an empty cabinet, a plant with its pot.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from pipeline.entities.asset import Asset

RANGES: Mapping[str, tuple[float, float]] = {
    "double_bed": (35.0, 220.0), "single_bed": (20.0, 150.0), "kids_bed": (20.0, 180.0), "nightstand": (4.0, 45.0),
    "wardrobe": (35.0, 320.0), "cabinet": (12.0, 150.0), "children_cabinet": (10.0, 180.0), "sideboard": (12.0, 150.0),
    "bookshelf": (10.0, 250.0), "shelf": (3.0, 80.0), "tv_stand": (10.0, 120.0), "wine_cabinet": (15.0, 150.0),
    "shoe_cabinet": (8.0, 80.0), "desk": (10.0, 140.0), "dressing_table": (10.0, 80.0), "dining_table": (12.0, 200.0),
    "coffee_table": (4.0, 140.0), "corner_side_table": (2.0, 60.0), "round_end_table": (2.0, 40.0), "dining_chair": (2.5, 20.0),
    "lounge_chair": (5.0, 45.0), "dressing_chair": (2.5, 15.0), "chinese_chair": (6.0, 25.0), "barstool": (3.0, 18.0),
    "stool": (1.5, 30.0), "multi_seat_sofa": (35.0, 180.0), "loveseat_sofa": (25.0, 110.0), "l_shaped_sofa": (50.0, 220.0),
    "armchair": (10.0, 55.0), "lazy_sofa": (3.0, 45.0), "chaise_longue_sofa": (15.0, 70.0), "pendant_lamp": (0.4, 30.0),
    "ceiling_lamp": (0.5, 20.0), "floor_lamp": (1.5, 25.0), "wall_lamp": (0.3, 5.0), "table_lamp": (0.4, 10.0),
    "kitchen_cabinet": (12.0, 130.0), "wall_cabinet": (5.0, 45.0), "sink_cabinet": (15.0, 110.0), "tall_unit": (25.0, 160.0),
    "refrigerator": (30.0, 160.0), "oven": (20.0, 90.0), "dishwasher": (25.0, 65.0), "microwave": (8.0, 30.0),
    "washing_machine": (40.0, 100.0), "toilet": (18.0, 60.0), "vanity": (12.0, 110.0), "bathtub": (20.0, 220.0),
    "shower": (25.0, 140.0), "trash_can": (0.4, 12.0), "plant": (0.3, 60.0), "rug": (0.8, 45.0), "curtain": (0.4, 12.0),
    "pillow": (0.25, 2.5), "cup": (0.08, 0.7), "plate": (0.15, 1.5), "bowl": (0.12, 2.5), "vase": (0.2, 12.0), "book": (0.1, 2.5),
    "book_stack": (0.4, 12.0), "basket": (0.2, 4.0), "picture": (0.3, 15.0), "mirror": (0.6, 40.0), "clock": (0.15, 8.0),
    "alarm_clock": (0.08, 1.0), "bath_mat": (0.2, 3.0), "blind": (0.3, 6.0), "bottle": (0.1, 2.5), "candle": (0.05, 2.0),
    "canister": (0.1, 2.5), "coat_hooks": (0.2, 4.0), "cutting_board": (0.3, 4.0), "folded_towels": (0.2, 3.0), "fruit_bowl": (0.4, 5.0),
    "kettle": (0.4, 2.5), "paper_holder": (0.1, 1.5), "pen_cup": (0.05, 0.8), "photo_frame": (0.05, 1.5), "potted_herb": (0.2, 3.0),
    "television": (3.0, 40.0), "throw": (0.3, 2.5), "tissue_box": (0.05, 0.5), "towel": (0.15, 1.2), "toy": (0.03, 1.5), "tray": (0.2, 3.0),
    "laptop": (0.8, 3.5), "remote": (0.05, 0.4), "phone": (0.08, 1.2), "camera": (0.2, 2.5), "keyboard": (0.25, 2.0),
    "printer": (3.0, 25.0), "toaster": (0.9, 5.0), "coffee_machine": (1.2, 15.0), "kitchen_pot": (0.7, 6.0), "saucepan": (0.4, 3.5),
    "bucket": (0.3, 4.0), "storage_box": (0.3, 15.0), "suitcase": (1.5, 7.0), "briefcase": (0.8, 5.0), "safe": (6.0, 150.0),
    "drawer_organiser": (0.5, 12.0), "room_door": (12.0, 75.0),
}  # fmt: skip


def mass(asset: Asset) -> float:
    """Return what all links weigh together [kg]."""
    return float(sum(link.mass for link in asset.links))


def factor(category: str, kilograms: float) -> float:
    """Return by what an estimate is to be multiplied to lie in its category's range: 1 within it, or where none is known."""
    low, high = RANGES.get(category, (kilograms, kilograms))
    return min(max(kilograms, low), high) / kilograms


def held(asset: Asset) -> tuple[Asset, float]:
    """Return the asset with its mass in the range of its category, and the factor on all masses and inertias."""
    by = factor(asset.category, mass(asset))
    if by == 1.0:
        return asset, by
    links = tuple(replace(link, mass=round(link.mass * by, 5), inertia=link.inertia * by) for link in asset.links)
    return replace(asset, links=links), by
