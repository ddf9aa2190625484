"""A program in one English sentence: what the scenes table says where nobody wrote a prompt."""

from collections import Counter

from pipeline.floorplan.program.defaults import OUTSIDE
from pipeline.floorplan.program.floor_program import FloorProgram, RoomType

NUMBERS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")
PLURALS = {"storage": "storage rooms", "library": "libraries", "office": "offices", "balcony": "balconies", "wc": "WCs"}
SINGULAR = {"wc": "WC", "storage": "storage room", "utility": "utility room", "studio_room": "studio room", "entry": "entrance hall"}


def describe(program: FloorProgram) -> str:
    """Return a sentence or two that name the rooms, storey by storey, what is open to what, and the area."""
    area = sum(r.area.target or 0.0 for r in program.rooms if r.type not in OUTSIDE)
    if program.storeys == 1:
        counts = Counter(r.type for r in program.rooms)
        beds = counts.pop("bedroom", 0)
        kind = "studio" if "studio_room" in counts else ("home" if not beds else f"{_number(beds)}-bedroom home")
        rest = [_phrase(name, count) for name, count in counts.items() if name != "studio_room"]
        text = f"{_article(kind)} {kind} of {area:.0f} m²"
        if rest:
            text += " with " + _list(rest)
        missing = _missing(counts, beds)
        if missing:
            text += ", without " + " or ".join(missing)
    else:
        text = f"A home of {area:.0f} m² on {_number(program.storeys)} floors"
        for level, where in zip(range(program.storeys), ("downstairs", "upstairs", "on the second floor"), strict=False):
            counts = Counter(r.type for r in program.rooms if r.level == level)
            text += f"; {where}: " + _list([_phrase(name, count) for name, count in counts.items()])
    fronts = [{_type(program, k.a), _type(program, k.b)} for k in program.links if k.kind == "open"]
    named = [f"the {_one(min(f))} open to the {_one(max(f))}" for f in fronts if "staircase" not in f]
    return text + "".join(f"; {n}" for n in named[:1]) + "".join(f", {n}" for n in named[1:]) + "."


def _missing(counts: Counter[RoomType], beds: int) -> list[str]:
    """Return what a reader would take for granted."""
    missing = []
    if beds and not counts["kitchen"]:
        missing.append("a kitchen of its own")
    if beds and not counts["living_room"]:
        missing.append("a living room")
    if beds > 1 and not counts["hallway"] and not counts["entry"]:
        missing.append("a hallway")
    return missing


def _list(parts: list[str]) -> str:
    return ", ".join(parts[:-1]) + " and " + parts[-1] if len(parts) > 1 else parts[0]


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
