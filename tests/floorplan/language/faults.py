"""What a prompt's program states wrongly, by the ground truth of `languages.yaml`, `sentences.yaml`, `speech.yaml`, `requests.yaml` and `everyday.yaml` in `manifests/prompts`."""

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import yaml

from pipeline.errors import RefusedError
from pipeline.floorplan import FloorProgram, parse
from pipeline.floorplan.language import llm
from pipeline.floorplan.program.floor_program import Furniture, Range

PROMPTS = Path(__file__).resolve().parents[3] / "manifests" / "prompts"
FILES = ("languages", "sentences", "speech", "requests", "everyday")
Engine = Callable[[str], FloorProgram]  # prompt -> completed program


def load(name: str = FILES[0]) -> list[dict[str, Any]]:
    """Return the cases of a file, in its order."""
    cases: list[dict[str, Any]] = yaml.safe_load((PROMPTS / f"{name}.yaml").read_text(encoding="utf-8"))
    return cases


def faults(case: Mapping[str, Any], engine: Engine | None = None) -> list[str]:
    """Return what the program of a case states wrongly; empty when it is exact."""
    try:
        program = (engine or parse)(case["prompt"])
    except llm.UnansweredError as error:
        return [f"no program: {error}"]
    except RefusedError as error:
        return [] if case.get("refused") else [f"refused: {error}"]
    if case.get("refused"):
        return ["not refused"]
    return [
        *_rooms(program, case),
        *_links(program, case),
        *_amounts(program, case),
        *_relations(program, case),
        *_shape(program, case),
        *_furniture(program, case),
        *_unsaid(program, case),
    ]


def _rooms(program: FloorProgram, case: Mapping[str, Any]) -> Iterator[str]:
    actual: Counter[str] = Counter(r.type for r in program.rooms if r.stated)
    wanted: Counter[str] = Counter(case["rooms"])
    if actual != wanted:
        yield f"rooms: more {dict(actual - wanted)}, fewer {dict(wanted - actual)}"
    there = Counter(r.type for r in program.rooms)
    for kind, count in case.get("has", {}).items():
        if there[kind] < count:
            yield f"{there[kind]} {kind}"
    for role, count in case.get("roles", {}).items():
        here = sum(r.role == role and r.type == "bedroom" for r in program.rooms)
        if here != count:
            yield f"{here} bedrooms of role {role}"
    absent = {f.a for f in program.forbids if f.what == "room_type"}
    if absent != set(case.get("absent", ())):
        yield f"absent: {sorted(absent)}"
    if program.storeys != case.get("storeys", 1):
        yield f"{program.storeys} storeys"
    if "entrance" in case and program.select(program.entrance.into or "")[0].type != case["entrance"]:
        yield f"entrance: {program.entrance.into}"


def _links(program: FloorProgram, case: Mapping[str, Any]) -> Iterator[str]:
    kinds = {r.id: r.type for r in program.rooms}
    stated = [k for k in program.links if k.stated]
    wanted: Counter[tuple[str, str]] = Counter()
    for a, b, kind, *count in case.get("links", ()):
        pair = (min(a, b), max(a, b))
        wanted[pair] += count[0] if count else 1
        here = sum(
            tuple(sorted((kinds[k.a], kinds[k.b]))) == pair and (k.kind == kind or (kind == "*" and k.kind != "wall")) for k in stated
        )
        if here < (count[0] if count else 1):
            yield f"link {a}-{b} {kind}: {here}"
    actual: Counter[tuple[str, str]] = Counter((min(p), max(p)) for k in stated if k.kind != "wall" for p in [(kinds[k.a], kinds[k.b])])
    if "links" in case and actual - wanted:
        yield f"links not asked for: {dict(actual - wanted)}"


def _amounts(program: FloorProgram, case: Mapping[str, Any]) -> Iterator[str]:
    if not _meets(program.total_area, case.get("total")):
        yield f"total area {program.total_area}"
    for kind, area in case.get("areas", {}).items():
        if not any(_meets(r.area, area) for r in program.rooms if r.type == kind):
            yield f"area of {kind}"


def _meets(actual: Range, wanted: float | Sequence[float | None] | None) -> bool:
    if wanted is None:
        return not actual.stated
    if isinstance(wanted, (int, float)):
        return actual.stated and actual.target is not None and abs(actual.target - wanted) < 0.01 * wanted
    ends = [(actual.min, wanted[0]), (actual.max, wanted[1])]
    return actual.stated and all(w is None or (m is not None and abs(m - w) < 0.01 * w) for m, w in ends)


def _relations(program: FloorProgram, case: Mapping[str, Any]) -> Iterator[str]:
    kinds = {r.id: r.type for r in program.rooms}
    for a, b in case.get("apart", ()):
        if not any({kinds.get(f.a, f.a), kinds.get(f.b or "", f.b)} == {a, b} for f in program.forbids if f.what == "adjacent"):
            yield f"{a} and {b} are not kept apart"
    for kind in case.get("equal", ()):
        if not any(r.kind == "area_equal" and kinds.get(r.a, r.a) == kind for r in program.relations):
            yield f"{kind}: not equal"
    for a, b, value in case.get("larger", ()):
        pairs = [(kinds.get(r.a, r.a), kinds.get(r.b or "", r.b), r.value) for r in program.relations if r.kind == "area_order"]
        if (a, b, value) not in pairs:
            yield f"{a} larger than {b}: {pairs}"
    for a, b in case.get("unlinked", ()):
        if not any({kinds.get(f.a, f.a), kinds.get(f.b or "", f.b)} == {a, b} for f in program.forbids):
            yield f"{a} and {b} may be joined"
    for a, b, c in case.get("between", ()):
        rows = [
            (kinds.get(r.a, r.a), {kinds.get(r.b or "", r.b), kinds.get(r.c or "", r.c)}) for r in program.relations if r.kind == "between"
        ]
        if (a, {b, c}) not in rows:
            yield f"{a} not between {b} and {c}"


def _shape(program: FloorProgram, case: Mapping[str, Any]) -> Iterator[str]:
    """Storeys, outline, height, widths and knobs."""
    for kind, level, count in case.get("levels", ()):
        here = sum(r.type == kind and r.level == level for r in program.rooms)
        if here != count:
            yield f"{here} {kind} on level {level}"
    if "zones" in case and not (program.zones or any(r.kind == "separation" for r in program.relations)):
        yield "no zones"
    if case.get("step_free", False) and not program.accessibility.step_free:
        yield "not step-free"
    if "min_door" in case and abs(program.accessibility.min_door - case["min_door"]) > 0.001:
        yield f"doors of {program.accessibility.min_door} m"
    if "footprint" in case and program.footprint.shape != case["footprint"]:
        yield f"footprint {program.footprint.shape}"
    if case.get("narrow", False) and program.footprint.min_aspect <= 1.0:
        yield "not narrow"
    for knob, sign in case.get("style", {}).items():
        if getattr(program.style, knob) * sign <= 0:
            yield f"{knob} {getattr(program.style, knob)}"
    if "ceiling" in case and program.shell.ceiling != case["ceiling"]:
        yield "ceiling"


def _furniture(program: FloorProgram, case: Mapping[str, Any]) -> Iterator[str]:
    """Furniture of the first room of a type, or of the home."""
    for kind, category, least, most in case.get("furniture", ()):
        if not any((t.category, t.min, t.max) == (category, least, most) for f in _wishes(program, kind) for t in f.counts):
            yield f"{category} in {kind}: {[f.counts for f in _wishes(program, kind)]}"
    for kind, least, most in case.get("pieces", ()):
        if not any((f.least, f.most) == (least, most) for f in _wishes(program, kind)):
            yield f"pieces in {kind}"
    for kind, share in case.get("walkable", ()):
        if not any(f.walkable == share for f in _wishes(program, kind)):
            yield f"walkable in {kind}"


def _unsaid(program: FloorProgram, case: Mapping[str, Any]) -> Iterator[str]:
    """Words that nothing can be made of, and that are not listed as such."""
    listed = "".join(s.text for s in (*program.unparsed, *program.unbuilt)).lower()
    for word in case.get("unread", ()):
        if word.lower().replace(" ", "") not in listed.replace(" ", ""):
            yield f"not said: {word}"


def _wishes(program: FloorProgram, kind: str) -> list[Furniture]:
    return [r.furniture for r in program.rooms if r.type == kind] if kind else [program.furniture]
