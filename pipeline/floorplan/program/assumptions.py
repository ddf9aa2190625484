"""What nobody said and a default filled in, in words: for the terminal and for the plan's JSON."""

from collections.abc import Iterator, Mapping, Sequence
from textwrap import fill

from pipeline.floorplan.program.areas import usual_area
from pipeline.floorplan.program.floor_program import FloorProgram

COLUMNS = 80  # of the terminal
NEAR = 0.015  # factors on usual areas that differ by less are one
SIGNS = {"open": "=", "portal": "=", "wall": "|"}


def assumptions(program: FloorProgram) -> list[dict[str, str]]:
    """Return {field, text} for each kind of default in a completed program; areas with their factor on what is usual.

    Every room, area, link, way in, outline and shell that the request left open is named; `stated: false` marks them in the program.
    """
    texts = {
        "rooms": _rooms(program),
        "areas": _areas(program),
        "links": ", ".join(f"{k.a}{SIGNS.get(k.kind, '-')}{k.b}" for k in program.links if not k.stated),
        "entrance": "" if program.entrance.stated else f"into {program.entrance.into}",
        "outline": _outline(program),
        "shell": _shell(program),
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


def _rooms(program: FloorProgram) -> str:
    return ", ".join(f"{r.id} ({r.type})" for r in program.rooms if not r.stated)


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


def _outline(program: FloorProgram) -> str:
    shape = program.footprint
    return "" if shape.stated else f"{shape.shape}, sides at most {shape.max_aspect:g} : 1"


def _shell(program: FloorProgram) -> str:
    shell = program.shell
    text = f"walls {shell.inner_wall:g} m inside, {shell.outer_wall:g} m outside, ceilings {shell.ceiling:g} m"
    return "" if shell.stated else text
