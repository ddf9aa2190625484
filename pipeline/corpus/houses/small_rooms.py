"""Bathrooms, halls, studies, balconies, utility and storage rooms."""

from pipeline.corpus.houses.arranger import Arranger


def furnish_bathroom(arranger: Arranger) -> None:
    """Furnish a bathroom: tub or shower in a corner, toilet, vanity, sometimes the washing machine."""
    arranger.space.blind = True  # a high window above tub or shower is usual
    tub = arranger.space.area > 4.6 and arranger.wants("bathtub") and arranger.at_wall("bathtub", corner=1.0)
    if not tub:
        arranger.at_wall("shower", corner=1.0)
    arranger.space.blind = False
    arranger.at_wall("toilet", corner=0.5, tries=5)
    arranger.at_wall("vanity", corner=0.5, tries=5)
    if arranger.wants("washing_machine"):
        arranger.at_wall("washing_machine", corner=0.95)
    if arranger.wants("trash_can"):
        arranger.in_corner("trash_can")
    if arranger.wants("wall_lamp"):
        arranger.on_wall("wall_lamp", 1.75)
    arranger.light()


def furnish_hall(arranger: Arranger, *, rich: bool) -> None:
    """Furnish a hall or corridor: shoes and a lamp; in a `rich` one also cabinets and a place to sit."""
    if arranger.wants("shoe_cabinet"):
        arranger.at_wall("shoe_cabinet", corner=0.7, tries=5)
    if rich:
        for category in arranger.wishes("pieces") or ["cabinet"]:
            arranger.at_wall(category, corner=0.8)
        if arranger.wants("stool"):
            arranger.in_corner("stool")
    if arranger.wants("plant"):
        arranger.in_corner("plant")
    if arranger.wants("wall_lamp"):
        arranger.on_wall("wall_lamp", 1.6)
    arranger.light()


def furnish_study(arranger: Arranger) -> None:
    """Furnish a study: a desk with a chair, shelves, a seat to read in."""
    arranger.pair_at_wall("desk", arranger.choose("desk_seat"))
    for category in arranger.wishes("pieces"):
        arranger.at_wall(category, corner=0.75)
    for category in arranger.wishes("extras"):
        arranger.in_corner(category)
    arranger.light()


def furnish_balcony(arranger: Arranger) -> None:
    """Furnish a balcony: plants, a chair and a small table, sometimes the washing machine."""
    arranger.space.blind = True  # all its outer walls are windows
    if arranger.wants("washing_machine"):
        arranger.at_wall("washing_machine", corner=1.0)
    for category in arranger.wishes("pieces"):
        arranger.in_corner(category, front=0.0)
    arranger.space.blind = False
    arranger.light()


def furnish_utility(arranger: Arranger) -> None:
    """Furnish a laundry: machine, cabinet, shelf, bin."""
    arranger.at_wall("washing_machine", corner=1.0)
    for category in arranger.wishes("pieces"):
        arranger.at_wall(category, corner=0.9)
    arranger.light()


def furnish_storage(arranger: Arranger, *, rich: bool) -> None:
    """Furnish a storage room or walk-in closet; one that is not `rich` has a shelf or wardrobe and nothing else."""
    arranger.at_wall(arranger.choose("first"), corner=0.9, tries=5)
    if not rich:
        return
    for category in arranger.wishes("pieces"):
        arranger.at_wall(category, corner=0.9)
    if arranger.wants("stool"):
        arranger.at_wall("stool", corner=0.9)
    arranger.light()
