"""A prior over programs for mass production: studios to homes of five bedrooms, varied and plausible."""

from __future__ import annotations

from typing import Any

import numpy as np

from pipeline.floorplan.completion import complete
from pipeline.floorplan.program import Accessibility, FloorProgram, Footprint, Forbid, Link, LinkKind, Range, RoomReq, Style

BEDROOMS = (0.12, 0.24, 0.28, 0.20, 0.11, 0.05)  # probability of 0 (studio) to 5 bedrooms
CLASSIC, OPEN, THROUGH = "classic", "open", "through"  # kitchen apart, open to the living room, behind the dining room


def prior(rng: np.random.Generator) -> FloorProgram:
    """Draw a completed program."""
    beds = int(rng.choice(len(BEDROOMS), p=BEDROOMS))
    return complete(_studio(rng) if beds == 0 else _home(rng, beds))


def _room(name: str, kind: str, **fields: Any) -> RoomReq:
    return RoomReq.model_validate({"id": name, "type": kind, "stated": False, **fields})


def _area(rng: np.random.Generator, mean: float, spread: float = 0.18) -> Range:
    return Range(target=round(float(mean * np.exp(rng.normal(0.0, spread))), 2))


def _kind(rng: np.random.Generator, *kinds: LinkKind) -> LinkKind:
    return kinds[int(rng.integers(len(kinds)))]


def _style(rng: np.random.Generator) -> Style:
    """Turn at most three knobs by one or two steps."""
    names = [n for n in Style.model_fields if not n.startswith("stair")]
    chosen = rng.choice(len(names), size=int(rng.integers(0, 4)), replace=False)
    return Style.model_validate({names[i]: int(rng.choice([-2, -1, 1, 2])) for i in sorted(chosen.tolist())})


def _footprint(rng: np.random.Generator, rooms: int) -> Footprint:
    low = float(rng.choice([1.0, 1.0, 1.3]))
    corner = rooms >= 6 and rng.random() < 0.15
    return Footprint(shape="L" if corner else "rectangle", min_aspect=low, max_aspect=low + 0.5)


def _studio(rng: np.random.Generator) -> FloorProgram:
    rooms = [
        _room("studio", "studio_room", functions=("living", "sleeping"), area=_area(rng, 22.0)),
        _room("bath", "bathroom", area=_area(rng, 4.2)),
    ]
    links = [Link(a="studio", b="bath")]
    if rng.random() < 0.7:
        rooms.append(_room("kitchen", "kitchen", area=_area(rng, 5.5)))
        links.append(Link(a="studio", b="kitchen", kind="open" if rng.random() < 0.6 else "door"))
    else:
        rooms[0] = rooms[0].model_copy(update={"functions": ("living", "sleeping", "cooking"), "area": _area(rng, 26.0)})
    if rng.random() < 0.35:
        rooms.append(_room("entry", "entry", area=_area(rng, 3.6)))
        links = [k if k.b != "bath" else Link(a="entry", b="bath") for k in links] + [Link(a="entry", b="studio")]
    if rng.random() < 0.25:
        rooms.append(_room("balcony", "balcony", area=_area(rng, 4.5)))
        links.append(Link(a="studio", b="balcony"))
    return FloorProgram(rooms=tuple(rooms), links=tuple(links), only=True, style=_style(rng), footprint=_footprint(rng, len(rooms)))


def _home(rng: np.random.Generator, beds: int) -> FloorProgram:
    rooms = [_room("living", "living_room", area=_area(rng, 20.0 + 3.0 * beds))]
    links: list[Link] = []
    forbids: list[Forbid] = []
    hub = _hub(rng, beds, rooms, links)
    _kitchen(rng, beds, rooms, links, hub)
    for k in range(beds):
        main = k == 0 and beds > 1
        rooms.append(_room(f"bed_{k + 1}", "bedroom", role="primary" if main else "", area=_area(rng, 15.5 if main else 12.0, 0.13)))
        links.append(Link(a=hub, b=f"bed_{k + 1}"))
    _wet(rng, beds, rooms, links, hub)
    _extras(rng, beds, rooms, links, hub)
    if beds >= 2 and rng.random() < 0.15:
        forbids.append(Forbid(what="adjacent", a="bed_1", b="kitchen", stated=False))
    access = Accessibility(min_door=0.9, min_corridor=1.2) if rng.random() < 0.06 else Accessibility()
    return FloorProgram(
        rooms=tuple(rooms),
        links=tuple(links),
        forbids=tuple(forbids),
        only=True,
        style=_style(rng),
        accessibility=access,
        footprint=_footprint(rng, len(rooms)),
    )


def _hub(rng: np.random.Generator, beds: int, rooms: list[RoomReq], links: list[Link]) -> str:
    """Add what bedrooms open off: a hallway, an entry, or the living room itself (as many plans of the tropics have it)."""
    draw = rng.random()
    if beds == 1 and draw < 0.35:
        return "living"
    if beds <= 2 and draw < 0.55:
        rooms.append(_room("entry", "entry", area=_area(rng, 5.0 + 1.2 * beds)))
        links.append(Link(a="entry", b="living", kind="door" if rng.random() < 0.8 else "portal"))
        return "entry"
    if beds == 2 and draw > 0.93:
        return "living"
    rooms.append(_room("hall", "hallway"))
    links.append(Link(a="living", b="hall", kind="door" if rng.random() < 0.75 else "portal"))
    if rng.random() < 0.3:
        rooms.append(_room("entry", "entry", area=_area(rng, 5.0)))
        links.append(Link(a="entry", b="living" if rng.random() < 0.5 else "hall"))
    return "hall"


def _kitchen(rng: np.random.Generator, beds: int, rooms: list[RoomReq], links: list[Link], hub: str) -> None:
    kind = str(rng.choice([CLASSIC, OPEN, THROUGH], p=[0.35, 0.45, 0.20] if beds >= 2 else [0.45, 0.50, 0.05]))
    rooms.append(_room("kitchen", "kitchen", area=_area(rng, 9.5 + 1.2 * beds)))
    if kind == THROUGH:
        rooms.append(_room("dining", "dining_room", area=_area(rng, 12.5)))
        links.append(Link(a="living", b="dining", kind=_kind(rng, "door", "open", "portal")))
        links.append(Link(a="dining", b="kitchen", kind=_kind(rng, "door", "open")))
    elif kind == OPEN:
        links.append(Link(a="living", b="kitchen", kind="open"))
    else:
        links.append(Link(a="living" if hub == "living" or rng.random() < 0.6 else hub, b="kitchen"))


def _wet(rng: np.random.Generator, beds: int, rooms: list[RoomReq], links: list[Link], hub: str) -> None:
    rooms.append(_room("bath", "bathroom", area=_area(rng, 5.5, 0.14)))
    links.append(Link(a=hub, b="bath"))
    if beds >= 2 and rng.random() < 0.25 + 0.15 * beds:
        rooms.append(_room("ensuite", "bathroom", area=_area(rng, 5.0, 0.14)))
        links.append(Link(a="bed_1", b="ensuite"))
    if beds >= 4:
        rooms.append(_room("bath_2", "bathroom", area=_area(rng, 5.0, 0.14)))
        links.append(Link(a=hub, b="bath_2"))
    if beds >= 2 and rng.random() < 0.25:
        rooms.append(_room("wc", "wc", area=_area(rng, 2.1, 0.1)))
        links.append(Link(a="entry" if any(r.id == "entry" for r in rooms) else hub, b="wc"))


def _extras(rng: np.random.Generator, beds: int, rooms: list[RoomReq], links: list[Link], hub: str) -> None:
    if rng.random() < 0.35:
        rooms.append(_room("balcony", "balcony", area=_area(rng, 6.5)))
        links.append(Link(a="living", b="balcony"))
    if rng.random() < 0.12 + 0.04 * beds:
        rooms.append(_room("office", "office", area=_area(rng, 9.5)))
        links.append(Link(a=hub, b="office"))
    if beds >= 2 and rng.random() < 0.2:
        rooms.append(_room("closet", "closet", area=_area(rng, 4.2)))
        links.append(Link(a="bed_1", b="closet"))
    if rng.random() < 0.1 + 0.05 * beds:
        rooms.append(_room("utility", "utility", area=_area(rng, 4.8)))
        links.append(Link(a="kitchen", b="utility"))
    if rng.random() < 0.15:
        rooms.append(_room("storage", "storage", area=_area(rng, 3.2)))
        links.append(Link(a=hub, b="storage"))
    if beds >= 3 and rng.random() < 0.2:
        rooms.append(_room("garage", "garage", area=_area(rng, 19.0)))
        links.append(Link(a="utility" if any(r.id == "utility" for r in rooms) else hub, b="garage"))
