"""What rooms a house has, and how large they are meant to be."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

# Area by 3D-FRONT room type: mean, spread, least, most [m2]. From 12 real scenes (83 rooms); spreads widened.
AREAS: dict[str, tuple[float, float, float, float]] = {
    "MasterBedroom": (16.6, 3.6, 11.0, 25.0),
    "SecondBedroom": (12.2, 1.9, 9.2, 16.0),
    "Bedroom": (14.0, 2.8, 10.5, 20.5),
    "ElderlyRoom": (12.0, 1.5, 10.0, 15.0),
    "KidsRoom": (10.6, 1.6, 8.5, 14.0),
    "Library": (8.9, 1.0, 7.6, 11.0),
    "LivingDiningRoom": (33.5, 7.0, 19.0, 56.0),
    "LivingRoom": (17.0, 2.6, 13.5, 24.0),
    "DiningRoom": (17.5, 2.6, 12.0, 23.0),
    "Kitchen": (6.6, 1.3, 4.6, 9.5),
    "Bathroom": (4.9, 0.9, 3.6, 7.5),
    "SecondBathroom": (4.3, 0.7, 3.4, 6.0),
    "MasterBathroom": (4.4, 0.7, 3.5, 6.0),
    "CloakRoom": (3.8, 0.5, 3.0, 5.0),
    "StorageRoom": (2.9, 0.5, 2.2, 4.0),
    "LaundryRoom": (3.6, 0.6, 2.6, 5.0),
}


BEDROOMS = ("MasterBedroom", "SecondBedroom", "Bedroom", "ElderlyRoom", "KidsRoom")
PRIVATE = (*BEDROOMS, "Library")


@dataclass(frozen=True, slots=True)
class Program:
    """The rooms asked for, as (type, area [m2]); `living` is the public room, `dining` a second one or None.

    `wet` starts with the kitchen. `suite` is what is cut out of the first bedroom's corner (an en-suite bathroom, a walk-in closet) or None.
    """

    living: tuple[str, float]
    dining: tuple[str, float] | None
    bedrooms: tuple[tuple[str, float], ...]
    wet: tuple[tuple[str, float], ...]
    suite: tuple[str, float] | None
    storage: tuple[str, float] | None
    laundry: tuple[str, float] | None
    merged_corridor: bool
    hall: bool
    balconies: int


def area(rng: np.random.Generator, room_type: str) -> float:
    """Draw an area [m2] for a room type."""
    mean, spread, least, most = AREAS[room_type]
    return float(np.clip(rng.normal(mean, spread), least, most))


def sample(rng: np.random.Generator, furnished: Sequence[str]) -> Program:
    """Draw a program that has the rooms of these types, and what else an apartment cannot do without, or may have."""
    others = [t for t in furnished if t in PRIVATE]
    if not any(t in BEDROOMS for t in others):
        others.insert(0, "MasterBedroom" if rng.random() < 0.6 else "Bedroom")
    if len(others) < 3 and rng.random() < 0.35:
        others.append(str(rng.choice(["SecondBedroom", "Bedroom", "Library"], p=[0.5, 0.3, 0.2])))
    others.sort(key=lambda t: t != "MasterBedroom")
    if "LivingDiningRoom" in furnished:
        together = True
    else:
        together = "DiningRoom" not in furnished and "LivingRoom" not in furnished and rng.random() < 0.7
    wet = ["Kitchen", "Bathroom"]
    if len(others) >= 3 and rng.random() < 0.35:
        wet.append("SecondBathroom")
    suite = None
    if others[0] == "MasterBedroom":
        suite = "CloakRoom" if "CloakRoom" in furnished else "MasterBathroom" if rng.random() < 0.38 else None
        suite = "CloakRoom" if suite is None and rng.random() < 0.1 else suite
    dining = "DiningRoom" in furnished or (not together and rng.random() < 0.25)
    hall = bool({"Hallway", "Aisle", "Corridor"} & set(furnished))
    return Program(
        living=_wish(rng, "LivingDiningRoom" if together else "LivingRoom"),
        dining=_wish(rng, "DiningRoom") if dining else None,
        bedrooms=tuple(_wish(rng, t) for t in others),
        wet=tuple(_wish(rng, t) for t in wet),
        suite=None if suite is None else _wish(rng, suite),
        storage=_wish(rng, "StorageRoom") if "StorageRoom" in furnished or rng.random() < 0.24 else None,
        laundry=_wish(rng, "LaundryRoom") if rng.random() < 0.20 else None,
        merged_corridor=together and bool(rng.random() < 0.55),
        hall=hall or bool(rng.random() < 0.40),
        balconies=int(rng.choice([0, 1, 2], p=[0.28, 0.55, 0.17])),
    )


def _wish(rng: np.random.Generator, room_type: str) -> tuple[str, float]:
    return room_type, area(rng, room_type)
