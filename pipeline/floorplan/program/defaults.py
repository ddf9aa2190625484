"""Documented defaults per room type: what is filled in when a request leaves it open.

Areas [m2] are usual sizes of European and North American dwellings (between inner wall faces). `width` [m] is the least clear
width, `exterior` whether the type needs an outside wall, `window` whether it gets windows where it has one, `habitable` whether
daylight matters (energy terms 6 and 7), `useful` whether its area counts as useful (term 9), `through` whether one may walk
through it to another room, `square` whether a square shape is wanted (term 3).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class TypeDefault:
    """What a room type is like unless the request says otherwise."""

    area: float
    width: float
    exterior: bool = False
    window: bool = False
    habitable: bool = False
    useful: bool = True
    through: bool = False
    square: bool = True


DEFAULTS: Mapping[str, TypeDefault] = {
    "living_room": TypeDefault(22.0, 3.0, exterior=True, window=True, habitable=True, through=True),
    "family_room": TypeDefault(18.0, 3.0, exterior=True, window=True, habitable=True, through=True),
    "kitchen": TypeDefault(11.0, 1.8, exterior=True, window=True, habitable=True, through=True),
    "dining_room": TypeDefault(13.0, 2.5, exterior=True, window=True, habitable=True, through=True),
    "bedroom": TypeDefault(12.0, 2.5, exterior=True, window=True, habitable=True),
    "bathroom": TypeDefault(5.5, 1.5, window=True),
    "wc": TypeDefault(2.0, 0.9, window=True, useful=False),
    "hallway": TypeDefault(7.0, 1.1, useful=False, through=True, square=False),
    "entry": TypeDefault(5.0, 1.2, exterior=True, useful=False, through=True, square=False),
    "closet": TypeDefault(4.0, 1.3, useful=False, through=True),
    "utility": TypeDefault(5.0, 1.5, window=True, useful=False, through=True),
    "storage": TypeDefault(3.0, 1.1, useful=False),
    "garage": TypeDefault(18.0, 2.8, exterior=True, useful=False, through=True),
    "balcony": TypeDefault(7.0, 1.4, exterior=True, window=True, useful=False, square=False),
    "staircase": TypeDefault(6.0, 1.8, useful=False, through=True, square=False),
    "office": TypeDefault(10.0, 2.2, exterior=True, window=True, habitable=True),
    "studio_room": TypeDefault(22.0, 3.0, exterior=True, window=True, habitable=True, through=True),
    "media_room": TypeDefault(18.0, 3.0, window=True),
    "gym": TypeDefault(14.0, 2.6, window=True),
    "library": TypeDefault(15.0, 2.6, window=True, habitable=True),
    "playroom": TypeDefault(12.0, 2.5, exterior=True, window=True, habitable=True),
    "meeting_room": TypeDefault(12.0, 2.6, window=True, habitable=True),
    "workshop": TypeDefault(14.0, 2.6, window=True, useful=False),
    "sunroom": TypeDefault(10.0, 2.2, exterior=True, window=True, habitable=True),
}
PRIMARY_BEDROOM = 16.0  # the first of several bedrooms, or one that is called main, master or primary
ENSUITE = 5.5
EATIN_KITCHEN = 16.0
OUTSIDE = frozenset({"balcony", "garage"})  # not part of the total area
HUBS = ("hallway", "entry", "living_room", "family_room", "studio_room", "dining_room", "kitchen", "office")
DOOR, DOOR_HEIGHT = 0.8, 2.05
