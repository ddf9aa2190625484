"""A program of the prior in the making: rooms with drawn areas, links, and the odds that decide between them."""

from typing import Any

import numpy as np

from pipeline.floorplan.program.defaults import OUTSIDE
from pipeline.floorplan.program.floor_program import (
    Accessibility,
    Entrance,
    FloorProgram,
    Footprint,
    Forbid,
    Link,
    LinkKind,
    Range,
    RoomReq,
    Style,
)

MOST_STRETCH = 1.4


class Sketch:
    """Collects rooms and links. Areas are log-normal about their means [m2]."""

    def __init__(self, rng: np.random.Generator) -> None:
        self.rng = rng
        self.rooms: list[RoomReq] = []
        self.links: list[Link] = []
        self.forbids: list[Forbid] = []

    def odds(self, share: float) -> bool:
        """Return True with that probability."""
        return bool(self.rng.random() < share)

    def room(self, name: str, kind: str, mean: float | None = None, spread: float = 0.16, **fields: Any) -> str:
        """Add a room; without a mean its area follows from the other rooms. Returns the id."""
        area = Range() if mean is None else Range(target=round(float(mean * np.exp(self.rng.normal(0.0, spread))), 2))
        self.rooms.append(RoomReq.model_validate({"id": name, "type": kind, "stated": False, "area": area, **fields}))
        return name

    def link(self, a: str, b: str, *kinds: LinkKind) -> None:
        """Join two rooms by one of the kinds; a door if none is given."""
        self.links.append(Link(a=a, b=b, kind=kinds[int(self.rng.integers(len(kinds)))] if kinds else "door"))

    def off(self, host: str, name: str, kind: str, mean: float | None = None, spread: float = 0.16, **fields: Any) -> str:
        """Add a room behind a door of `host`. Returns its id."""
        self.room(name, kind, mean, spread, **fields)
        self.link(host, name)
        return name

    def has(self, name: str) -> bool:
        """Whether a room of that id was added."""
        return any(r.id == name for r in self.rooms)

    def bedrooms(self, host: str, count: int, primary: float = 16.5, other: float = 13.0, **fields: Any) -> None:
        """Add bedrooms bed_1 ... off `host`; the first of several is the primary one."""
        for k in range(count):
            main = k == 0 and count > 1
            self.off(host, f"bed_{k + 1}", "bedroom", primary if main else other, 0.13, role="primary" if main else "", **fields)

    def balance(self) -> None:
        """Stretch the rooms of the smaller of two storeys, so that walls stand above walls."""
        sizes = [sum(r.area.target or 0.0 for r in self.rooms if r.level == v and r.type not in OUTSIDE) for v in (0, 1)]
        stairs = sum(r.area.target or 0.0 for r in self.rooms if r.type == "staircase")
        sizes[1] += stairs
        small = int(sizes[1] < sizes[0])
        factor = min((max(sizes) - stairs) / (min(sizes) - stairs), MOST_STRETCH)
        for k, r in enumerate(self.rooms):
            if r.level == small and r.area.target and r.type not in {*OUTSIDE, "staircase"}:
                self.rooms[k] = r.model_copy(update={"area": Range(target=round(r.area.target * factor, 2))})

    def program(
        self,
        *,
        into: str | None = None,
        corner: float = 0.15,
        aspects: tuple[float, ...] = (1.0, 1.0, 1.3),
        span: float = 0.5,
        storeys: int = 1,
    ) -> FloorProgram:
        """Return the program: entered through `into`, an L-shaped outline with probability `corner`, a least aspect of `aspects`.

        At most three knobs are turned.
        """
        low = float(self.rng.choice(aspects))
        ell = len(self.rooms) >= 6 and self.odds(corner)
        access = Accessibility(min_door=0.9, min_corridor=1.2) if self.odds(0.06) else Accessibility()
        return FloorProgram(
            rooms=tuple(self.rooms),
            links=tuple(self.links),
            forbids=tuple(self.forbids),
            entrance=Entrance(into=into),
            only=True,
            storeys=storeys,
            style=self._style(),
            accessibility=access,
            footprint=Footprint(shape="L" if ell else "rectangle", min_aspect=low, max_aspect=low + span),
        )

    def _style(self) -> Style:
        names = [n for n in Style.model_fields if not n.startswith("stair")]
        chosen = self.rng.choice(len(names), size=int(self.rng.integers(0, 4)), replace=False)
        return Style.model_validate({names[i]: int(self.rng.choice([-2, -1, 1, 2])) for i in sorted(chosen.tolist())})
