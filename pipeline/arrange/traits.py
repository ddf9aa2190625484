"""What people expect of furniture: what stands with its back to a wall, what is placed first, what belongs beside what."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from pipeline import taxonomy


@dataclass(frozen=True, slots=True)
class Trait:
    """`wall`: its back belongs to a wall (must), rather does (want), or it stands free. `order`: placed earlier when lower.

    `partners` are categories that it belongs beside, in the way of `relation`: "flank" (beside the partner's back, as a
    nightstand), "around" (facing the partner's sides, as a chair its table), "front" (before the partner, facing it).
    `access` is where people come to it: before its front, or at both its sides.
    """

    wall: Literal["must", "want", "free"] = "free"
    order: int = 2
    relation: Literal["", "flank", "around", "front"] = ""
    partners: tuple[str, ...] = ()
    access: Literal["", "front", "sides"] = ""


_BEDS = ("double_bed", "single_bed", "kids_bed")
_SOFAS = ("multi_seat_sofa", "l_shaped_sofa", "loveseat_sofa", "chaise_longue_sofa")

_BACKED = Trait("must", 0, access="front")
_SIDE = Trait("want", 2)
_TRAITS: dict[str, Trait] = {
    **dict.fromkeys(("wardrobe", "cabinet", "children_cabinet", "sideboard", "bookshelf", "shelf", "tv_stand"), _BACKED),
    **dict.fromkeys(("wine_cabinet", "shoe_cabinet", "dressing_table", "kitchen_cabinet", "sink_cabinet"), _BACKED),
    **dict.fromkeys(("refrigerator", "oven", "dishwasher", "washing_machine", "toilet", "vanity", "bathtub", "shower"), _BACKED),
    **dict.fromkeys(_BEDS, Trait("must", -1, access="sides")),
    **dict.fromkeys(_SOFAS, Trait("want", 0, access="front")),
    "desk": Trait("want", 0, access="front"),
    "nightstand": Trait("must", 1, "flank", _BEDS),
    "dining_table": Trait("free", 1),
    "coffee_table": Trait("free", 1, "front", _SOFAS),
    "corner_side_table": Trait("want", 2, "flank", _SOFAS),
    "round_end_table": Trait("want", 2, "flank", _SOFAS),
    "dining_chair": Trait("free", 3, "around", ("dining_table", "desk")),
    "chinese_chair": Trait("free", 3, "around", ("dining_table", "desk")),
    "barstool": Trait("free", 3, "around", ("dining_table",)),
    "dressing_chair": Trait("free", 3, "front", ("dressing_table",)),
    "lounge_chair": Trait("free", 3, "front", ("desk",)),
    "stool": Trait("free", 3, "front", ("dressing_table",)),
    "armchair": Trait("free", 2),
    "lazy_sofa": Trait("free", 3),
    "floor_lamp": Trait("want", 4),
    "plant": Trait("want", 4),
    "trash_can": Trait("want", 4),
}


def trait(category: str) -> Trait:
    """Return what is expected of a category; what hangs on walls must have one behind it, whatever it is."""
    known = taxonomy.load().categories.get(category)
    if known is not None and known.mount == "wall":
        return Trait("must", 2)
    if known is not None and known.mount == "ceiling":
        return Trait("free", 5)
    return _TRAITS.get(category, _SIDE)


def mount(category: str) -> Literal["floor", "wall", "ceiling"]:
    """Return where a category is fixed."""
    known = taxonomy.load().categories.get(category)
    return known.mount if known is not None else "floor"
