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

# 3D-FUTURE's styles that the finishes and forms know, and how often they come.
STYLES: Mapping[str, float] = {
    "Modern": 0.28,
    "Nordic": 0.16,
    "Minimalist": 0.12,
    "Light Luxury": 0.10,
    "Industrial": 0.08,
    "Japanese": 0.07,
    "American Country": 0.07,
    "New Chinese": 0.05,
    "Vintage/Retro": 0.04,
    "Mediterranean": 0.03,
}


@dataclass(frozen=True, slots=True)
class Form:
    """One form of a category. `name` is what the builder knows it by, `future` the category name to write.

    A `round` form has one diameter: its depth is set to its width. A `still` form has nothing that moves. Models lower than
    `least_height` [m] take the category's first form instead.
    """

    name: str
    future: str
    round: bool = False
    still: bool = False
    least_height: float = 0.0


@dataclass(frozen=True, slots=True)
class Line:
    """A category's models at size 1: `static` ones as 3D-FUTURE folders, `moving` ones as PartNet-Mobility folders."""

    forms: tuple[Form, ...]
    static: int
    moving: int = 0


def _line(future: str, names: str, static: int, moving: int = 0) -> Line:
    """Read a line from words: `name`, `name*` (round), `-name` (still), `name>1.2` (least height), `name=Other future name`."""
    forms = []
    for word in names.split(", "):
        left, _, other = word.partition("=")
        name, _, least = left.partition(">")
        forms.append(Form(name.strip("-*"), other or future, name.endswith("*"), name.startswith("-"), float(least or 0)))
    return Line(tuple(forms), static, moving)


LINES: Mapping[str, Line] = {
    "double_bed": _line("King-size Bed", "panel, upholstered, slatted, tufted=Bed Frame", 8),
    "single_bed": _line("Single bed", "panel, upholstered, slatted", 4),
    "kids_bed": _line("Kids Bed", "rails, bunk>1.35=Bunk Bed, house>1.2", 4),
    "nightstand": _line("Nightstand", "drawers, shelf_drawer, door_drawer", 6, 10),
    "wardrobe": _line("Wardrobe", "doors, doors_drawers, doors_open", 6, 11),
    "cabinet": _line("Drawer Chest / Corner cabinet", "drawers, mixed, doors", 4, 10),
    "children_cabinet": _line("Children Cabinet", "-cubes, doors_drawers, cubes_doors", 3, 4),
    "sideboard": _line("Sideboard / Side Cabinet / Console Table", "doors, mixed, console", 5, 8),
    "bookshelf": _line("Bookcase / jewelry Armoire", "-open, doors_below, glass, -ladder", 4, 5),
    "shelf": _line("Shelf", "ladder, frame, cubes", 3),
    "tv_stand": _line("TV Stand", "drawers, doors, mixed", 5, 8),
    "wine_cabinet": _line("Wine Cabinet", "glass, rack", 2, 4),
    "shoe_cabinet": _line("Shoe Cabinet", "doors, flaps", 2, 4),
    "desk": _line("Desk", "pedestal, drawers, -plain", 4, 8),
    "dressing_table": _line("Dressing Table", "mirror, round_mirror", 3, 5),
    "dining_table": _line("Dining Table", "legs, trestle, pedestal*, slab", 7),
    "coffee_table": _line("Coffee Table", "-legs, -drum*, -sled, drawer", 6, 4),
    "corner_side_table": _line("Corner/Side Table", "-legs, -pedestal*, -c_shape, drawer", 5, 4),
    "round_end_table": _line("Round End Table", "tripod*, drum*", 2),
    "dining_chair": _line("Dining Chair", "wood, shell, upholstered, spindle", 8),
    "lounge_chair": _line("Lounge Chair / Cafe Chair / Office Chair", "easy, office, wing", 6),
    "dressing_chair": _line("Dressing Chair", "stool*, back", 2),
    "chinese_chair": _line("Classic Chinese Chair", "official", 2),
    "barstool": _line("Barstool", "legs, pedestal", 2),
    "stool": _line("Footstool / Sofastool / Bed End Stool / Stool", "bench, ottoman, legs", 4),
    "multi_seat_sofa": _line("Three-Seat / Multi-seat Sofa", "track, legs, roll", 6),
    "loveseat_sofa": _line("Loveseat Sofa", "track, legs, roll", 4),
    "l_shaped_sofa": _line("L-shaped Sofa", "left, right", 4),
    "armchair": _line("armchair", "track, legs, roll, tub", 5),
    "lazy_sofa": _line("Lazy Sofa", "bean", 2),
    "chaise_longue_sofa": _line("Chaise Longue Sofa", "chaise", 2),
    "pendant_lamp": _line("Pendant Lamp", "shade*, globe*, linear, cluster", 7),
    "ceiling_lamp": _line("Ceiling Lamp", "disc*, square, ring*", 4),
    "floor_lamp": _line("Floor Lamp", "shade*, arc, tripod*", 3),
    "wall_lamp": _line("Wall Lamp", "shade, bar", 2),
    "kitchen_cabinet": _line("Kitchen Base Cabinet", "doors, drawers, mixed", 4, 7),
    "wall_cabinet": _line("Kitchen Wall Cabinet", "doors, glass", 2, 4),
    "sink_cabinet": _line("Kitchen Sink Cabinet", "doors", 2, 3),
    "refrigerator": _line("Refrigerator", "two_doors, side_by_side, french", 2, 4),
    "oven": _line("Oven", "range, built_in", 2, 4),
    "dishwasher": _line("Dishwasher", "plain", 1, 3),
    "microwave": _line("Microwave", "plain", 1, 3),
    "washing_machine": _line("Washing Machine", "front", 2, 3),
    "toilet": _line("Toilet", "tank, lever", 2, 3),
    "vanity": _line("Bathroom Vanity", "doors, drawers", 3, 4),
    "bathtub": _line("Bathtub", "apron, free", 2),
    "shower": _line("Shower", "cabin", 2),
    "trash_can": _line("Trash Can", "round*, box, slider", 2, 4),
    "plant": _line("Plant", "bush*, palm*, tall*", 4),
}
