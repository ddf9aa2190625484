"""What rooms a house has, and how large they are meant to be."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

# Area by 3D-FRONT room type: mean, spread, least, most [m2]. From 12 real scenes (83 rooms); spreads widened.
AREAS: dict[str, tuple[float, float, float, float]] = {
    "MasterBedroom": (16.6, 3.6, 11.0, 25.0),
    "SecondBedroom": (12.2, 1.9, 9.2, 16.0),
    "Bedroom": (14.0, 2.8, 10.5, 20.5),
    "ElderlyRoom": (12.0, 1.5, 10.0, 15.0),
    "KidsRoom": (10.6, 1.6, 8.5, 14.0),
    "Library": (9.4, 1.3, 7.6, 12.5),
    "LivingDiningRoom": (31.0, 6.5, 19.0, 52.0),
    "LivingRoom": (18.0, 3.2, 14.0, 25.0),
    "DiningRoom": (14.5, 2.6, 10.5, 22.0),
    "Kitchen": (6.6, 1.3, 4.6, 9.5),
    "Bathroom": (4.9, 0.9, 3.6, 7.5),
    "SecondBathroom": (4.3, 0.7, 3.4, 6.0),
    "MasterBathroom": (4.4, 0.7, 3.5, 6.0),
    "CloakRoom": (3.8, 0.5, 3.0, 5.0),
    "StorageRoom": (2.9, 0.5, 2.2, 4.0),
    "LaundryRoom": (3.6, 0.6, 2.6, 5.0),
}


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


def sample(rng: np.random.Generator) -> Program:
    """Draw a program. Shares of room types follow the furnished rooms of the 2022 release."""
    count = int(rng.choice([1, 2, 3, 4], p=[0.12, 0.30, 0.38, 0.20]))
    first = "MasterBedroom" if count > 1 and rng.random() < 0.92 else "Bedroom"
    others = [
        str(rng.choice(["SecondBedroom", "Bedroom", "KidsRoom", "ElderlyRoom"], p=[0.46, 0.26, 0.22, 0.06])) for _ in range(count - 1)
    ]
    if rng.random() < 0.36:
        others.append("Library")
    together = rng.random() < 0.70
    wet = ["Kitchen", "Bathroom"]
    if count >= 3 and rng.random() < 0.35:
        wet.append("SecondBathroom")
    suite = None
    if first == "MasterBedroom" and rng.random() < 0.50:
        suite = "MasterBathroom" if rng.random() < 0.75 else "CloakRoom"
    return Program(
        living=_wish(rng, "LivingDiningRoom" if together else "LivingRoom"),
        dining=None if together else _wish(rng, "DiningRoom"),
        bedrooms=tuple(_wish(rng, t) for t in [first, *others]),
        wet=tuple(_wish(rng, t) for t in wet),
        suite=None if suite is None else _wish(rng, suite),
        storage=_wish(rng, "StorageRoom") if rng.random() < 0.24 else None,
        laundry=_wish(rng, "LaundryRoom") if rng.random() < 0.20 else None,
        merged_corridor=together and bool(rng.random() < 0.55),
        hall=bool(rng.random() < 0.40),
        balconies=int(rng.choice([0, 1, 2], p=[0.28, 0.55, 0.17])),
    )


def _wish(rng: np.random.Generator, room_type: str) -> tuple[str, float]:
    return room_type, area(rng, room_type)
