"""Which function builds which category."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from pipeline.corpus.furniture import appliances, bath, beds, decor, desks, kitchen, lamps, seating, shelves, sofas, storage, tables
from pipeline.corpus.furniture.finishes import Scheme
from pipeline.corpus.furniture.shape import Shape

Builder = Callable[[np.random.Generator, str, Sequence[float], Scheme], Shape]

BUILDERS: Mapping[str, Builder] = {
    "nightstand": storage.nightstand,
    "wardrobe": storage.wardrobe,
    "cabinet": storage.cabinet,
    "children_cabinet": storage.children_cabinet,
    "sideboard": storage.sideboard,
    "bookshelf": shelves.bookshelf,
    "shelf": shelves.shelf,
    "tv_stand": storage.tv_stand,
    "wine_cabinet": storage.wine_cabinet,
    "shoe_cabinet": storage.shoe_cabinet,
    "double_bed": beds.bed,
    "single_bed": beds.bed,
    "kids_bed": beds.kids_bed,
    "pendant_lamp": lamps.pendant_lamp,
    "ceiling_lamp": lamps.ceiling_lamp,
    "floor_lamp": lamps.floor_lamp,
    "wall_lamp": lamps.wall_lamp,
    "kitchen_cabinet": kitchen.kitchen_cabinet,
    "wall_cabinet": kitchen.wall_cabinet,
    "sink_cabinet": kitchen.sink_cabinet,
    "vanity": kitchen.vanity,
    "refrigerator": appliances.refrigerator,
    "oven": appliances.oven,
    "dishwasher": appliances.dishwasher,
    "microwave": appliances.microwave,
    "washing_machine": appliances.washing_machine,
    "toilet": bath.toilet,
    "bathtub": bath.bathtub,
    "shower": bath.shower,
    "plant": decor.plant,
    "trash_can": decor.trash_can,
    "desk": desks.desk,
    "dressing_table": desks.dressing_table,
    "dining_table": tables.dining_table,
    "coffee_table": tables.coffee_table,
    "corner_side_table": tables.corner_side_table,
    "round_end_table": tables.round_end_table,
    "dining_chair": seating.dining_chair,
    "lounge_chair": seating.lounge_chair,
    "dressing_chair": seating.dressing_chair,
    "chinese_chair": seating.chinese_chair,
    "barstool": seating.barstool,
    "stool": seating.stool,
    "multi_seat_sofa": sofas.sofa,
    "loveseat_sofa": sofas.sofa,
    "armchair": sofas.sofa,
    "l_shaped_sofa": sofas.l_shaped_sofa,
    "lazy_sofa": sofas.lazy_sofa,
    "chaise_longue_sofa": sofas.chaise_longue,
}

# 3D-FUTURE's word for the main material where it does not follow from the wood or lacquer; "soft": that of the cover.
SOFT = [
    "lounge_chair",
    "dressing_chair",
    "stool",
    "multi_seat_sofa",
    "loveseat_sofa",
    "armchair",
    "l_shaped_sofa",
    "lazy_sofa",
    "chaise_longue_sofa",
]
NEITHER = [
    "pendant_lamp",
    "ceiling_lamp",
    "floor_lamp",
    "wall_lamp",
    "refrigerator",
    "oven",
    "dishwasher",
    "microwave",
    "washing_machine",
    "toilet",
    "bathtub",
    "shower",
    "trash_can",
    "plant",
]
MATERIALS: Mapping[str, str] = {**dict.fromkeys(SOFT, "soft"), **dict.fromkeys(NEITHER, "Others")}
