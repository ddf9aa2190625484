"""How exactly prompts are read: the share of prompts whose program states what they say, per language and half.

`python -m benchmarks.language [--half held|tuned] [--language en] [--faults]`. Ground truth: `manifests/prompts/languages.yaml`.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import yaml

from pipeline.errors import RefusedError
from pipeline.floorplan import FloorProgram, parse
from pipeline.floorplan.program import Range

CASES = Path(__file__).resolve().parents[1] / "manifests" / "prompts" / "languages.yaml"
CLOSE = 0.12  # relative error of an area that is still "about" it


def load() -> list[dict[str, Any]]:
    """Return the cases in file order."""
    cases: list[dict[str, Any]] = yaml.safe_load(CASES.read_text(encoding="utf-8"))
    return cases


def faults(case: Mapping[str, Any]) -> list[str]:
    """Return what the program of a case states wrongly; empty when it is exact."""
    try:
        program = parse(case["prompt"])
    except RefusedError as error:
        return [] if case.get("refused") else [f"refused: {error}"]
    if case.get("refused"):
        return ["not refused"]
    return [*_rooms(program, case), *_links(program, case), *_amounts(program, case), *_relations(program, case)]


def _rooms(program: FloorProgram, case: Mapping[str, Any]) -> Iterator[str]:
    made = Counter(r.type for r in program.rooms if r.stated)
    wanted: Counter[str] = Counter(case["rooms"])
    if made != wanted:
        yield f"rooms: more {dict(made - wanted)}, fewer {dict(wanted - made)}"
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
    made = Counter((min(p), max(p)) for k in stated if k.kind != "wall" for p in [(kinds[k.a], kinds[k.b])])
    if "links" in case and made - wanted:
        yield f"links not asked for: {dict(made - wanted)}"


def _amounts(program: FloorProgram, case: Mapping[str, Any]) -> Iterator[str]:
    if not _meets(program.total_area, case.get("total")):
        yield f"total area {program.total_area}"
    for kind, area in case.get("areas", {}).items():
        if not any(_meets(r.area, area) for r in program.rooms if r.type == kind):
            yield f"area of {kind}"


def _meets(made: Range, wanted: float | Sequence[float | None] | None) -> bool:
    if wanted is None:
        return not made.stated
    if isinstance(wanted, (int, float)):
        return made.stated and made.target is not None and abs(made.target - wanted) < 0.01 * wanted
    ends = [(made.min, wanted[0]), (made.max, wanted[1])]
    return made.stated and all(w is None or (m is not None and abs(m - w) < 0.01 * w) for m, w in ends)


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


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the share of exact prompts and of exact facts."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--half", choices=("held", "tuned"))
    parser.add_argument("--language")
    parser.add_argument("--faults", action="store_true")
    asked = parser.parse_args(arguments)
    exact: Counter[tuple[str, str]] = Counter()
    count: Counter[tuple[str, str]] = Counter()
    spent = 0.0
    for case in load():
        key = (case["id"][:2], case["half"])
        if (asked.half and asked.half != key[1]) or (asked.language and asked.language != key[0]):
            continue
        start = time.process_time()
        wrong = faults(case)
        spent += time.process_time() - start
        count[key] += 1
        exact[key] += not wrong
        if wrong and asked.faults:
            print(f"{case['id']}: {case['prompt']}\n    " + "\n    ".join(wrong))
    for key in sorted(count):
        print(f"{key[0]} {key[1]}: {exact[key]} of {count[key]} exact")
    print(f"{1000 * spent / max(sum(count.values()), 1):.1f} ms a prompt (CPU, completion and checks with it)")
    return 0


if __name__ == "__main__":
    sys.exit(main())
