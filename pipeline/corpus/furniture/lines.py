"""Product lines: for each category its names in 3D-FUTURE, how many models it has, and in which forms they come."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

# 3D-FUTURE's super-category for each of our own (taxonomy.yaml: super); it has none for kitchens and baths.
SUPER_CATEGORIES: Mapping[str, str] = {
    "bed": "Bed",
    "cabinet": "Cabinet/Shelf/Desk",
    "table": "Table",
    "chair": "Chair",
    "stool": "Pier/Stool",
    "sofa": "Sofa",
    "lighting": "Lighting",
}
OTHER_SUPER_CATEGORY = "Others"


@dataclass(frozen=True, slots=True)
class Form:
    """One form of a category. `name` is what the builder knows it by, `future` the category name to write.

    A `round` form has one diameter: its depth is set to its width; of an `upright` round one, its height. A `still` form has nothing that moves. Models lower than
    `least_height` [m] take the category's first form instead.
    """

    name: str
    future: str
    round: bool = False
    upright: bool = False
    still: bool = False
    least_height: float = 0.0


@dataclass(frozen=True, slots=True)
class Line:
    """A category's models at size 1: `static` ones as 3D-FUTURE folders, `moving` ones as PartNet-Mobility folders."""

    forms: tuple[Form, ...]
    static: int
    moving: int = 0


def _line(future: str, names: str, static: int, moving: int = 0) -> Line:
    """Read a line from words: `name`, `name*` (round), `name^` (round and upright), `-name` (still), `name>1.2` (least height), `name=Other future name`."""
    forms = []
    for word in names.split(", "):
        left, _, other = word.partition("=")
        name, _, least = left.partition(">")
        form = Form(name.strip("-*^"), other or future, name.endswith("*"), name.endswith("^"), name.startswith("-"), float(least or 0))
        forms.append(form)
    return Line(tuple(forms), static, moving)


LINES: Mapping[str, Line] = {
    "double_bed": _line("King-size Bed", "panel, upholstered, slatted, tufted=Bed Frame", 24),
    "single_bed": _line("Single bed", "panel, upholstered, slatted", 14),
    "kids_bed": _line("Kids Bed", "rails, bunk>1.35=Bunk Bed, house>1.2", 12),
    "nightstand": _line("Nightstand", "drawers, shelf_drawer, door_drawer", 12, 10),
    "wardrobe": _line("Wardrobe", "doors, doors_drawers, doors_open", 12, 11),
    "cabinet": _line("Drawer Chest / Corner cabinet", "drawers, mixed, doors", 12, 10),
    "children_cabinet": _line("Children Cabinet", "-cubes, doors_drawers, cubes_doors", 10, 4),
    "sideboard": _line("Sideboard / Side Cabinet / Console Table", "doors, mixed, console", 14, 8),
    "bookshelf": _line("Bookcase / jewelry Armoire", "-open, doors_below, glass, -ladder", 14, 5),
    "shelf": _line("Shelf", "ladder, frame, cubes", 12),
    "tv_stand": _line("TV Stand", "drawers, doors, mixed", 12, 8),
    "wine_cabinet": _line("Wine Cabinet", "glass, rack", 8, 4),
    "shoe_cabinet": _line("Shoe Cabinet", "doors, flaps", 6, 4),
    "desk": _line("Desk", "pedestal, drawers, -plain", 14, 8),
    "dressing_table": _line("Dressing Table", "mirror, round_mirror", 10, 5),
    "dining_table": _line("Dining Table", "legs, trestle, pedestal*, slab", 22),
    "coffee_table": _line("Coffee Table", "-legs, -drum*, -sled, drawer", 24, 4),
    "corner_side_table": _line("Corner/Side Table", "-legs, -pedestal*, -c_shape, drawer", 22, 4),
    "round_end_table": _line("Round End Table", "tripod*, drum*", 8),
    "dining_chair": _line("Dining Chair", "wood, shell, upholstered, spindle", 26),
    "lounge_chair": _line("Lounge Chair / Cafe Chair / Office Chair", "easy, office, wing", 24),
    "dressing_chair": _line("Dressing Chair", "stool*, back", 8),
    "chinese_chair": _line("Classic Chinese Chair", "official", 9),
    "barstool": _line("Barstool", "legs, pedestal", 12),
    "stool": _line("Footstool / Sofastool / Bed End Stool / Stool", "bench, ottoman, legs", 16),
    "multi_seat_sofa": _line("Three-Seat / Multi-seat Sofa", "track, legs, roll", 22),
    "loveseat_sofa": _line("Loveseat Sofa", "track, legs, roll", 18),
    "l_shaped_sofa": _line("L-shaped Sofa", "left, right", 16),
    "armchair": _line("armchair", "track, legs, roll, tub", 24),
    "lazy_sofa": _line("Lazy Sofa", "bean", 10),
    "chaise_longue_sofa": _line("Chaise Longue Sofa", "chaise", 8),
    "pendant_lamp": _line("Pendant Lamp", "shade*, globe*, linear, cluster", 26),
    "ceiling_lamp": _line("Ceiling Lamp", "disc*, square, ring*", 16),
    "floor_lamp": _line("Floor Lamp", "shade*, arc, tripod*", 14),
    "wall_lamp": _line("Wall Lamp", "shade, bar", 10),
    "kitchen_cabinet": _line("Kitchen Base Cabinet", "doors, drawers, mixed", 6, 7),
    "wall_cabinet": _line("Kitchen Wall Cabinet", "doors, glass", 6, 4),
    "sink_cabinet": _line("Kitchen Sink Cabinet", "doors", 6, 3),
    "refrigerator": _line("Refrigerator", "two_doors, side_by_side, french", 6, 4),
    "oven": _line("Oven", "range, built_in", 6, 4),
    "dishwasher": _line("Dishwasher", "plain", 6, 3),
    "microwave": _line("Microwave", "plain", 6, 3),
    "washing_machine": _line("Washing Machine", "front", 6, 3),
    "toilet": _line("Toilet", "tank, lever", 6, 3),
    "vanity": _line("Bathroom Vanity", "doors, drawers", 6, 4),
    "bathtub": _line("Bathtub", "apron, free", 6),
    "shower": _line("Shower", "cabin", 6),
    "trash_can": _line("Trash Can", "round*, box, slider", 6, 4),
    "plant": _line("Plant", "bush*, palm*, tall*", 18),
    "rug": _line("Rug", "woven, fringed, shaggy, round*", 14),
    "curtain": _line("Curtain", "drawn, closed", 8),
    "pillow": _line("Pillow", "loose, round*", 10),
    "table_lamp": _line("Table Lamp", "shade*, globe*, desk", 14),
    "cup": _line("Cup", "mug, tumbler*, tea", 7),
    "plate": _line("Plate", "flat*, deep*", 6),
    "bowl": _line("Bowl", "glazed*, wood*", 6),
    "vase": _line("Vase", "bottle*, belly*, upright*, twigs*", 10),
    "book": _line("Book", "closed, open", 6),
    "book_stack": _line("Book Stack", "pile, row", 6),
    "basket": _line("Basket", "round, square", 6),
    "picture": _line("Picture", "framed, canvas, pair", 12),
    "mirror": _line("Mirror", "rectangle, round^, sunburst^", 8),
    "clock": _line("Clock", "dial^, marks^", 6),
}
