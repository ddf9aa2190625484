"""Amounts in a prompt → areas, widths, numbers of pieces, sizes of rooms against each other."""

from __future__ import annotations

import re
from typing import Any

from pipeline.floorplan.language.draft import Draft
from pipeline.floorplan.language.facts import HALLS, Reading
from pipeline.floorplan.language.inventory import Inventory, Named
from pipeline.floorplan.language.items import Item

ABOUT = 0.1  # "about 75 m2" allows this much either way
TIMES = re.compile(
    r"(?:the )?(master|main bedroom|main office|living room|kitchen|bedroom|office)[^.;]{0,40}?(one and a half times|1\.5 times|1½ times|twice|two times|three times|at least as (?:large|big))"
    r"[^.;]{0,30}?(?:size of|as large as|as big as|bigger than|larger than|as) the (second bedroom|other bedrooms?|guest bedroom|kitchen|living room|bedroom|meeting room)"
)
FACTORS = {"one and a half times": 1.5, "1.5 times": 1.5, "1½ times": 1.5, "twice": 2.0, "two times": 2.0, "three times": 3.0}


def attach(draft: Draft, state: Reading) -> None:
    """Attach amounts: areas, widths, numbers of pieces, free shares."""
    stock = state.inventory
    for item, ids in state.amounts:
        around = " ".join(t.text for t in draft.tokens[max(0, item.first - 4) : item.last + 3])
        value = item.number or 0.0
        rooms = [stock.get(i) for i in ids or ()]
        if item.unit == "area" and value > 0:
            where = [f"rooms.{r.id}.area" for r in rooms] or ["total_area"]
            box = _range(item)
            for room in rooms:
                room.low, room.high, room.target = box.get("min", room.low), box.get("max", room.high), box.get("target", room.target)
            if not rooms and "total_area" not in draft.fields:
                draft.fields["total_area"] = _whole_range(box)
            for field in where:
                draft.cite(item.first, item.last, field)
        elif item.unit == "length":
            _length(draft, item, rooms, around)
        elif item.unit == "share" and re.search(r"free|walkable|clear|empty|open floor|floor", around):
            for room in rooms or stock.rooms:
                room.walkable = min(value, 1.0)
            draft.cite(item.first, item.last, "rooms.walkable")
        elif item.unit == "pieces":
            for room in rooms:
                room.objects = int(value)
                draft.cite(item.first, item.last, f"rooms.{room.id}.objects")
        elif item.unit == "rooms" and value >= 2:
            while len(stock.rooms) < min(int(value), 40):
                missing = [k for k in ("living_room", "kitchen", "bathroom") if not stock.of(k)]
                stock.add(missing[0] if missing else "bedroom", "", "room", None)
            draft.fields["only"] = True
            draft.cite(item.first, item.last, "rooms")


def _range(item: Item) -> dict[str, float]:
    value = item.number or 0.0
    if item.high is not None:
        return {"min": value, "max": item.high}
    if item.bound == "least":
        return {"min": value}
    return {"max": value} if item.bound == "most" else {"target": value}


def _whole_range(box: dict[str, float]) -> dict[str, Any]:
    if "target" in box:
        return {"target": box["target"], "min": box["target"] * (1 - ABOUT), "max": box["target"] * (1 + ABOUT), "stated": True}
    return {**box, "stated": True}


def _length(draft: Draft, item: Item, rooms: list[Named], around: str) -> None:
    value = item.number or 0.0
    access = draft.fields.setdefault("accessibility", {})
    halls = [r for r in rooms if r.type in HALLS]
    if "door" in around and 0.6 <= value <= 1.2:
        access["min_door"] = max(value, 0.7)
        draft.cite(item.first, item.last, "accessibility.min_door")
    elif halls or "corridor" in around or "hallway" in around:
        if 0.7 <= value <= 3.0:
            access["min_corridor"] = max(value, 0.8)
            draft.cite(item.first, item.last, "accessibility.min_corridor")
    elif "wide" in around and 1.0 <= value <= 20.0:
        for room in rooms:
            room.min_width = value
            draft.cite(item.first, item.last, f"rooms.{room.id}.min_width")


def compare(draft: Draft, stock: Inventory, text: str) -> None:
    """Sizes of rooms against each other."""
    for match in TIMES.finditer(text):
        larger = _by_words(stock, match.group(1))
        smaller = [r for r in _by_words(stock, match.group(3)) if r not in larger]
        for a in larger[:1]:
            for b in smaller:
                draft.relations.append({"kind": "area_order", "a": a.id, "b": b.id, "value": FACTORS.get(match.group(2), 1.0)})
                at = draft.prompt.lower().find(match.group(2)[:8])
                end = at + len(match.group(2))
                if at >= 0:
                    draft.evidence.append({"start": at, "end": end, "text": draft.prompt[at:end], "field": f"relations.area_order.{a.id}"})


def _by_words(stock: Inventory, words: str) -> list[Named]:
    beds = stock.of("bedroom")
    if words in {"master", "main bedroom"}:
        return [r for r in beds if r.role == "primary"]
    if words in {"second bedroom", "other bedroom", "other bedrooms", "guest bedroom"}:
        return [r for r in beds if r.role != "primary"]
    kind = {"living room": "living_room", "main office": "office", "meeting room": "meeting_room"}.get(words, words)
    return stock.of(kind)
