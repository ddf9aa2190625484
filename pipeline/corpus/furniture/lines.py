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
    "double_bed": _line(
        "King-size Bed", "panel, upholstered, slatted, tufted=Bed Frame, canopy>1.4=Bed Frame, sleigh, metal, platform, wing", 24
    ),
    "single_bed": _line("Single bed", "panel, upholstered, slatted, metal, tufted", 14),
    "kids_bed": _line("Kids Bed", "rails, bunk>1.35=Bunk Bed, loft>1.35=Bunk Bed, house>1.2, car, couch=Couch Bed", 12),
    "nightstand": _line("Nightstand", "drawers, shelf_drawer, door_drawer", 12, 18),
    "wardrobe": _line("Wardrobe", "doors, doors_drawers, doors_open, sliding, inner_drawers, mirror, top_boxes, sliding_mirror", 12, 24),
    "cabinet": _line("Drawer Chest / Corner cabinet", "drawers, mixed, doors, tallboy, apothecary", 12, 20),
    "children_cabinet": _line("Children Cabinet", "-cubes, doors_drawers, cubes_doors", 10, 6),
    "sideboard": _line("Sideboard / Side Cabinet / Console Table", "doors, mixed, console, sliding", 14, 14),
    "bookshelf": _line("Bookcase / jewelry Armoire", "-open, doors_below, glass, -ladder", 14, 8),
    "shelf": _line("Shelf", "ladder, frame, cubes", 12),
    "tv_stand": _line("TV Stand", "drawers, doors, mixed, flaps", 12, 14),
    "wine_cabinet": _line("Wine Cabinet", "glass, rack", 8, 5),
    "shoe_cabinet": _line("Shoe Cabinet", "doors, flaps", 6, 6),
    "desk": _line("Desk", "pedestal, drawers, -plain", 14, 14),
    "dressing_table": _line("Dressing Table", "mirror, round_mirror", 10, 9),
    "dining_table": _line("Dining Table", "legs, trestle, pedestal*, slab, cross, farm, tulip*, drum*, bar>0.8=Bar", 22),
    "coffee_table": _line("Coffee Table", "-legs, -drum*, -sled, drawer, -tray*, -block, -planks, -ming", 24, 9),
    "corner_side_table": _line("Corner/Side Table", "-legs, -pedestal*, -c_shape, drawer, -drum*, -hourglass*, -ming", 22, 9),
    "round_end_table": _line("Round End Table", "tripod*, drum*, tulip*, tray*", 8),
    "dining_chair": _line(
        "Dining Chair", "wood, shell, upholstered, spindle, wishbone, cantilever, medallion, cafe, folding=Folding chair", 26
    ),
    "lounge_chair": _line(
        "Lounge Chair / Cafe Chair / Office Chair",
        "easy, office>0.85, wing>0.85, lounger, tub, sling, rattan, hanging>1.0=Hanging Chair",
        24,
    ),
    "dressing_chair": _line("Dressing Chair", "stool*, back, drum*", 8),
    "chinese_chair": _line("Classic Chinese Chair", "official, rose, horseshoe", 9),
    "barstool": _line("Barstool", "legs, pedestal, saddle", 12),
    "stool": _line("Footstool / Sofastool / Bed End Stool / Stool", "bench, ottoman, legs, pouf*, drum*", 16),
    "multi_seat_sofa": _line(
        "Three-Seat / Multi-seat Sofa", "track, legs, roll, chesterfield, camelback, frame, cloud, u_shape=U-shaped Sofa", 22
    ),
    "loveseat_sofa": _line("Loveseat Sofa", "track, legs, roll, chesterfield, camelback, frame, cloud", 18),
    "l_shaped_sofa": _line("L-shaped Sofa", "left, right", 16),
    "armchair": _line("armchair", "track, legs, roll, tub, chesterfield, frame, cloud", 24),
    "lazy_sofa": _line("Lazy Sofa", "bean, floor, block", 10),
    "chaise_longue_sofa": _line("Chaise Longue Sofa", "chaise, recamier", 8),
    "pendant_lamp": _line("Pendant Lamp", "shade*, globe*, linear, cluster, chandelier*, lantern*, sputnik, cage*, hoops", 26),
    "ceiling_lamp": _line("Ceiling Lamp", "disc*, square, ring*, crystal*, frame, spots", 16),
    "floor_lamp": _line("Floor Lamp", "shade*, arc, tripod*, paper*, globes*, reading", 14),
    "wall_lamp": _line("Wall Lamp", "shade, bar, globe, candles", 10),
    "kitchen_cabinet": _line("Kitchen Base Cabinet", "doors, drawers, mixed, corner", 6, 14),
    "wall_cabinet": _line("Kitchen Wall Cabinet", "doors, glass, lift", 6, 9),
    "sink_cabinet": _line("Kitchen Sink Cabinet", "doors, drawer", 6, 7),
    "refrigerator": _line("Refrigerator", "two_doors, side_by_side, french, single, freezer_drawers", 6, 11),
    "oven": _line("Oven", "range, built_in, gas", 6, 9),
    "dishwasher": _line("Dishwasher", "plain, hidden", 6, 8),
    "microwave": _line("Microwave", "plain, knobs", 6, 8),
    "washing_machine": _line("Washing Machine", "front, top", 6, 8),
    "toilet": _line("Toilet", "tank, lever, dual", 6, 12),
    "vanity": _line("Bathroom Vanity", "doors, drawers", 6, 8),
    "bathtub": _line("Bathtub", "apron, free", 6),
    "shower": _line("Shower", "cabin", 6),
    "trash_can": _line("Trash Can", "round*, box, slider, pedal*, swing", 6, 11),
    "plant": _line("Plant", "bush*, palm*, swords*, monstera*, fig*, fern*, cactus*, olive*", 18),
    "rug": _line("Rug", "woven, fringed, shaggy, round*", 14),
    "curtain": _line("Curtain", "drawn, closed", 8),
    "pillow": _line("Pillow", "loose, round*", 10),
    "table_lamp": _line("Table Lamp", "shade*, globe*, desk, mushroom*", 14),
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
    "tall_unit": _line("Kitchen Tall Unit", "larder, pull_out, mixed", 1, 6),
    "laptop": _line("Laptop", "plain", 1, 7),
    "remote": _line("Remote Control", "grid, simple", 1, 7),
    "phone": _line("Telephone", "smart, keys, flip", 1, 6),
    "camera": _line("Camera", "compact, reflex", 1, 6),
    "keyboard": _line("Keyboard", "rows, figures", 1, 6),
    "printer": _line("Printer", "scanner, plain", 1, 6),
    "toaster": _line("Toaster", "two_slots, tray", 1, 6),
    "coffee_machine": _line("Coffee Machine", "jug, espresso, capsule", 1, 8),
    "kitchen_pot": _line("Kitchen Pot", "ears, bail*", 1, 5),
    "saucepan": _line("Saucepan", "stick", 1, 5),
    "bucket": _line("Bucket", "zinc*, plain*, lid*", 1, 7),
    "storage_box": _line("Storage Box", "hinged, flaps, slide", 1, 9),
    "suitcase": _line("Suitcase", "upright", 1, 5),
    "briefcase": _line("Briefcase", "lying", 1, 5),
    "safe": _line("Safe", "dial, keys", 1, 7),
    "drawer_organiser": _line("Drawer Organiser", "trays, grid", 1, 6),
    "room_door": _line("Room Door", "flush, panels, glazed", 1, 8),
    "television": _line("Television", "foot, feet", 6),
    "bath_mat": _line("Bath Mat", "terry, slats", 6),
    "blind": _line("Blind", "roller, roman, slats", 9),
    "towel": _line("Towel", "single, double, ring", 9),
    "folded_towels": _line("Folded Towels", "pile, rolled", 6),
    "throw": _line("Throw", "folded", 8),
    "paper_holder": _line("Paper Holder", "bare, lid", 6),
    "coat_hooks": _line("Coat Hooks", "bags, bare", 6),
    "photo_frame": _line("Photo Frame", "upright", 8),
    "candle": _line("Candle", "pillar*, glass*, stick*", 9),
    "tray": _line("Tray", "oblong, round*", 6),
    "potted_herb": _line("Potted Herb", "succulent*, herb*, grass*", 9),
    "bottle": _line("Bottle", "pump*, shampoo*, wine*, oil*", 8),
    "canister": _line("Canister", "glass*, pottery*", 8),
    "kettle": _line("Kettle", "electric, stove", 6),
    "cutting_board": _line("Cutting Board", "knife, bread", 6),
    "fruit_bowl": _line("Fruit Bowl", "low*, foot*", 6),
    "toy": _line("Toy", "bear, ball, car, blocks", 8),
    "pen_cup": _line("Pen Cup", "round*, square*", 6),
    "alarm_clock": _line("Alarm Clock", "round, box", 6),
    "tissue_box": _line("Tissue Box", "flat, cube", 6),
}
