"""Bathrooms, halls, studies, balconies, utility and storage rooms."""

from __future__ import annotations

from pipeline.corpus.houses.arranger import Arranger


def furnish_bathroom(arranger: Arranger) -> None:
    """Furnish a bathroom: tub or shower in a corner, toilet, vanity, sometimes the washing machine."""
    arranger.space.blind = True  # a high window above tub or shower is usual
    tub = arranger.space.area > 4.6 and arranger.chance(0.45) and arranger.at_wall("bathtub", corner=1.0)
    if not tub:
        arranger.at_wall("shower", corner=1.0)
    arranger.space.blind = False
    arranger.at_wall("toilet", corner=0.5, tries=5)
    arranger.at_wall("vanity", corner=0.5, tries=5)
    if arranger.chance(0.4):
        arranger.at_wall("washing_machine", corner=0.95)
    if arranger.chance(0.4):
        arranger.in_corner("trash_can")
    if arranger.chance(0.35):
        arranger.on_wall("wall_lamp", 1.75)
    arranger.light(0.0, 0.8)


def furnish_hall(arranger: Arranger) -> None:
    """Furnish a hall or corridor: shoes, a place to sit, a lamp."""
    if arranger.chance(0.85):
        arranger.at_wall("shoe_cabinet", corner=0.7, tries=5)
    for category, share in (("sideboard", 0.15), ("cabinet", 0.2), ("wardrobe", 0.12), ("shelf", 0.1)):
        if arranger.chance(share):
            arranger.at_wall(category, corner=0.8)
    for category, share in (("stool", 0.3), ("plant", 0.25)):
        if arranger.chance(share):
            arranger.in_corner(category)
    if arranger.chance(0.15):
        arranger.on_wall("wall_lamp", 1.6)
    arranger.light(0.15, 0.82)


def furnish_study(arranger: Arranger) -> None:
    """Furnish a study: a desk with a chair, shelves, a seat to read in."""
    arranger.pair_at_wall("desk", ("lounge_chair", "lounge_chair", "dining_chair"), 0.92)
    for category, share in (("bookshelf", 0.9), ("bookshelf", 0.3), ("cabinet", 0.22), ("shelf", 0.25), ("sideboard", 0.08)):
        if arranger.chance(share):
            arranger.at_wall(category, corner=0.75)
    for category, share in (
        ("armchair", 0.2),
        ("lazy_sofa", 0.06),
        ("lounge_chair", 0.1),
        ("plant", 0.3),
        ("floor_lamp", 0.15),
        ("corner_side_table", 0.15),
    ):
        if arranger.chance(share):
            arranger.in_corner(category)
    arranger.light(0.55, 0.35)


def furnish_balcony(arranger: Arranger) -> None:
    """Furnish a balcony: plants, a chair and a small table, sometimes the washing machine."""
    arranger.space.blind = True  # all its outer walls are windows
    if arranger.chance(0.3):
        arranger.at_wall("washing_machine", corner=1.0)
    for category, share in (("plant", 0.8), ("lounge_chair", 0.6), ("round_end_table", 0.4), ("plant", 0.5), ("lounge_chair", 0.2)):
        if arranger.chance(share):
            arranger.in_corner(category, front=0.0)
    arranger.space.blind = False
    arranger.light(0.0, 0.55)


def furnish_utility(arranger: Arranger) -> None:
    """Furnish a laundry: machine, cabinet, shelf, bin."""
    arranger.at_wall("washing_machine", corner=1.0)
    for category, share in (("cabinet", 0.5), ("shelf", 0.55), ("wall_cabinet", 0.0), ("trash_can", 0.4)):
        if arranger.chance(share):
            arranger.at_wall(category, corner=0.9)
    arranger.light(0.0, 0.7)


def furnish_storage(arranger: Arranger) -> None:
    """Furnish a storage room or walk-in closet."""
    first = "wardrobe" if arranger.chance(0.55) else "shelf"
    arranger.at_wall(first, corner=0.9, tries=5)
    for category, share in (("shelf", 0.5), ("cabinet", 0.4), ("shoe_cabinet", 0.3), ("stool", 0.2)):
        if arranger.chance(share):
            arranger.at_wall(category, corner=0.9)
    arranger.light(0.0, 0.6)
