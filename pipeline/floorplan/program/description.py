"""A program in words: in one English sentence for the scenes table where nobody wrote a prompt, and what of it nobody said."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from textwrap import fill

from pipeline.floorplan.program.areas import usual_area
from pipeline.floorplan.program.defaults import OUTSIDE
from pipeline.floorplan.program.floor_program import FloorProgram, RoomType

NUMBERS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")
PLURALS = {"storage": "storage rooms", "library": "libraries", "office": "offices", "balcony": "balconies", "wc": "WCs"}
SINGULAR = {"wc": "WC", "storage": "storage room", "utility": "utility room", "studio_room": "studio room", "entry": "entrance hall"}
COLUMNS = 80  # of the terminal
NEAR = 0.015  # factors on usual areas that differ by less are one
SIGNS = {"open": "=", "portal": "=", "wall": "|"}


def describe(program: FloorProgram) -> str:
    """Return a sentence or two that name the rooms, storey by storey, what is open to what, and the area."""
    area = sum(r.area.target or 0.0 for r in program.rooms if r.type not in OUTSIDE)
    if program.storeys == 1:
        counts = Counter(r.type for r in program.rooms)
        beds = counts.pop("bedroom", 0)
        kind = "studio" if "studio_room" in counts else ("home" if not beds else f"{_number(beds)}-bedroom home")
        rest = [_phrase(name, count) for name, count in counts.items() if name != "studio_room"]
        article = "An" if kind[0] in "aeiou" and not kind.startswith("one") else "A"
        text = f"{article} {kind} of {area:.0f} m²"
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
    fronts = [{program.select(i)[0].type for i in k.ends} for k in program.links if k.kind == "open"]
    named = [f"the {_one(min(f))} open to the {_one(max(f))}" for f in fronts if "staircase" not in f]
    children = sum(r.role == "child" for r in program.rooms)
    theirs = f"; {_number(children)} of the bedrooms for {'a child' if children == 1 else 'children'}" if children else ""
    return text + theirs + "".join(f"; {n}" for n in named[:1]) + "".join(f", {n}" for n in named[1:]) + "."


def _missing(counts: Counter[RoomType], beds: int) -> list[str]:
    """Return what a reader would take for granted."""
    needed = {
        "a kitchen of its own": beds and not counts["kitchen"],
        "a living room": beds and not counts["living_room"],
        "a hallway": beds > 1 and not counts["hallway"] and not counts["entry"],
    }
    return [room for room, lacks in needed.items() if lacks]


def _list(parts: list[str]) -> str:
    return ", ".join(parts[:-1]) + " and " + parts[-1] if len(parts) > 1 else parts[0]


def _number(count: int) -> str:
    return NUMBERS[count] if count < len(NUMBERS) else str(count)


def _one(kind: str) -> str:
    return SINGULAR.get(kind, kind.replace("_", " "))


def _phrase(kind: str, count: int) -> str:
    one = _one(kind)
    if count == 1:
        return f"{'an' if one[0] in 'aeiou' and one != 'utility room' else 'a'} {one}"
    return f"{_number(count)} {PLURALS.get(kind, one + 's')}"


def assumptions(program: FloorProgram) -> list[dict[str, str]]:
    """Return {field, text} for each kind of default in a completed program; areas with their factor on what is usual.

    Every room, area, link, way in, outline and shell that the request left open is named; `stated: false` marks them in the program.
    """
    outline, shell = program.footprint, program.shell
    walls = f"walls {shell.inner_wall:g} m inside, {shell.outer_wall:g} m outside, ceilings {shell.ceiling:g} m"
    texts = {
        "rooms": ", ".join(f"{r.id} ({r.type})" for r in program.rooms if not r.stated),
        "areas": _areas(program),
        "links": ", ".join(f"{k.a}{SIGNS.get(k.kind, '-')}{k.b}" for k in program.links if not k.stated),
        "entrance": "" if program.entrance.stated else f"into {program.entrance.into}",
        "outline": "" if outline.stated else f"{outline.shape}, sides at most {outline.max_aspect:g} : 1",
        "shell": "" if shell.stated else walls,
    }
    return [{"field": field, "text": text} for field, text in texts.items() if text]


def format_assumptions(assumed: Sequence[Mapping[str, str]]) -> str:
    """Return what was assumed as paragraphs for a terminal."""
    text = "assumed, for nobody said it:\n" if assumed else ""
    for each in assumed:
        line = f"{each['field']:9s} {each['text']}"
        text += fill(line, COLUMNS, initial_indent="  ", subsequent_indent=" " * 12, break_on_hyphens=False) + "\n"
    return text


def notes(program: FloorProgram, assumed: Sequence[Mapping[str, str]]) -> str:
    """Return what was assumed, what is not built, and the words that were not understood."""
    left_out = {"not built here": program.unbuilt, "not understood": program.unparsed}
    lines = (f"{why}: {', '.join(s.text for s in spans)}\n" for why, spans in left_out.items() if spans)
    return format_assumptions(assumed) + "".join(lines)


def _areas(program: FloorProgram) -> str:
    """Name the rooms whose area nobody stated, and how far their areas lie from what is usual, and why."""
    groups: dict[float, list[str]] = {}
    for room in program.rooms:
        if room.area.target is not None and not room.area.stated:
            factor = room.area.target / usual_area(room, program)
            factor = 1.0 if abs(factor - 1.0) < NEAR else round(factor, 2)
            groups.setdefault(factor, []).append(f"{room.id} {room.area.target:.1f}")
    texts = [f"{', '.join(names)} m²" + ("" if factor == 1.0 else f" (usual x {factor:g})") for factor, names in sorted(groups.items())]
    reasons = list(_area_reasons(program)) if set(groups) - {1.0} else []
    return "; ".join(texts) + (f"; fitted to {' and '.join(reasons)}" if reasons else "")


def _area_reasons(program: FloorProgram) -> Iterator[str]:
    """Yield what moves areas away from the usual ones."""
    whole = program.total_area
    if whole.stated or whole.min is not None or whole.max is not None:
        yield "the total"
    if any(k.kind.startswith("area") or k.kind == "largest" for k in program.relations):
        yield "how rooms compare"
    if any(not r.area.stated and (r.area.min is not None or r.area.max is not None) for r in program.rooms):
        yield "bounds"
    if program.storeys > 1:
        yield "the storey above or below"
