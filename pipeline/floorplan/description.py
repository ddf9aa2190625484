"""A program in one English sentence: what the scenes table says where nobody wrote a prompt."""

from __future__ import annotations

from collections import Counter

from pipeline.floorplan.defaults import OUTSIDE
from pipeline.floorplan.program import FloorProgram

NUMBERS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")
PLURALS = {"storage": "storage rooms", "library": "libraries", "office": "offices", "balcony": "balconies", "wc": "WCs"}
SINGULAR = {"wc": "WC", "storage": "storage room", "utility": "utility room", "studio_room": "studio room", "entry": "entrance hall"}


def describe(program: FloorProgram) -> str:
    """Return a sentence that names the rooms, what is open to what, and the area."""
    counts = Counter(r.type for r in program.rooms)
    beds = counts.pop("bedroom", 0)
    kind = "studio" if "studio_room" in counts else ("home" if not beds else f"{_number(beds)}-bedroom home")
    rest = [_phrase(name, count) for name, count in counts.items() if name != "studio_room"]
    area = sum(r.area.target or 0.0 for r in program.rooms if r.type not in OUTSIDE)
    text = f"{_article(kind)} {kind} of {area:.0f} m²"
    if rest:
        text += " with " + (", ".join(rest[:-1]) + " and " + rest[-1] if len(rest) > 1 else rest[0])
    fronts = [(_type(program, k.a), _type(program, k.b)) for k in program.links if k.kind == "open"]
    if fronts:
        text += "; " + ", ".join(f"the {_one(a)} open to the {_one(b)}" for a, b in fronts)
    if program.storeys > 1:
        text += f"; on {_number(program.storeys)} floors"
    return text + "."


def _number(count: int) -> str:
    return NUMBERS[count] if count < len(NUMBERS) else str(count)


def _article(noun: str) -> str:
    return "An" if noun[0] in "aeiou" and not noun.startswith("one") else "A"


def _one(kind: str) -> str:
    return SINGULAR.get(kind, kind.replace("_", " "))


def _phrase(kind: str, count: int) -> str:
    one = _one(kind)
    if count == 1:
        return f"{'an' if one[0] in 'aeiou' and one != 'utility room' else 'a'} {one}"
    return f"{_number(count)} {PLURALS.get(kind, one + 's')}"


def _type(program: FloorProgram, room_id: str) -> str:
    return program.select(room_id)[0].type
