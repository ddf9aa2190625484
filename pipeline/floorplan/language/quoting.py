"""The words that a language model's answer was read from: its quotes looked up in the prompt, and what it states without any."""

from __future__ import annotations

import logging
import re
from collections.abc import Sequence
from typing import Any

from pipeline.errors import RefusedError, UsageError
from pipeline.floorplan.language.parser import understand
from pipeline.floorplan.program.floor_program import Evidence, FloorProgram

LOG = logging.getLogger(__name__)
MOST_QUOTES, LONGEST_FIELD = 400, 80


def quoted(program: FloorProgram, prompt: str, quotes: object, *, ours: bool = False) -> FloorProgram:
    """Return the program with its evidence: each quote of the model at its place in the prompt, whatever offsets it gave.

    Rooms that it quotes nothing for get the words that the built-in parser reads their type from. Rooms, links and a total area that
    have no words at all stay, as defaults (`stated: false`), and a warning names them. Quotes that the prompt does not hold are dropped.
    `ours`: the quotes were looked up before and come from the cache.
    """
    evidence = list(_looked_up(prompt, quotes, ours))
    fields = {e.field for e in evidence}
    bare = [r for r in program.rooms if r.stated and not any(f == f"rooms.{r.id}" or f.startswith(f"rooms.{r.id}.") for f in fields)]
    for e, room in _read_off(prompt, bare):
        evidence.append(e.model_copy(update={"field": f"rooms.{room}"}))
        fields.add(f"rooms.{room}")
    unsaid = {r.id for r in bare} - {f.split(".")[1] for f in fields if f.startswith("rooms.")}
    total = program.total_area
    if total.stated and "total_area" not in fields:
        found = _number(prompt, total.target or total.min or total.max or 0.0)
        evidence += [found] if found else []
        total = total if found else total.model_copy(update={"stated": False})
    if unsaid or total != program.total_area:
        names = ", ".join([*sorted(unsaid), *(["total_area"] if total != program.total_area else [])])
        LOG.warning("the language model states what no words of the prompt say; it counts as a default: %s", names)
    return program.model_copy(
        update={
            "rooms": tuple(r.model_copy(update={"stated": False}) if r.id in unsaid else r for r in program.rooms),
            "links": tuple(k.model_copy(update={"stated": False}) if {k.a, k.b} & unsaid else k for k in program.links),
            "total_area": total,
            "evidence": tuple(evidence),
        }
    )


def _looked_up(prompt: str, quotes: object, ours: bool) -> list[Evidence]:
    """Return the quotes that stand in the prompt; anything else that the model put there is passed over."""
    made = []
    for quote in quotes[:MOST_QUOTES] if isinstance(quotes, list) else []:
        text, field = (quote.get("text"), quote.get("field")) if isinstance(quote, dict) else (None, None)
        if not isinstance(text, str) or not isinstance(field, str) or not text.strip() or len(field) > LONGEST_FIELD:
            continue
        pattern = r"\s+".join(re.escape(w) for w in text.split())
        if match := re.search(pattern, prompt, re.IGNORECASE):
            kept = ours and quote.get("source", "rule") == "rule"
            made.append(Evidence(start=match.start(), end=match.end(), text=match.group(), field=field, source="rule" if kept else "llm"))
    return made


def _read_off(prompt: str, rooms: Sequence[Any]) -> list[tuple[Evidence, str]]:
    """Return for rooms the words that the built-in parser reads rooms of their type from, one each, the last for all that are left."""
    if not rooms:
        return []
    try:
        read = understand(prompt)
    except (RefusedError, UsageError):
        return []
    types = {r.id: r.type for r in read.rooms}
    words: dict[str, list[Evidence]] = {}
    for e in read.evidence:
        parts = e.field.split(".")
        if parts[0] == "rooms" and len(parts) == 2 and parts[1] in types:
            words.setdefault(types[parts[1]], []).append(e)
    made = []
    for room in rooms:
        mine = words.get(room.type, [])
        if mine:
            made.append((mine.pop(0) if len(mine) > 1 else mine[0], room.id))
    return made


def _number(prompt: str, value: float) -> Evidence | None:
    """Return where the prompt says a number of m2 in figures, to the nearest whole."""
    match = re.search(rf"(?<![\d.,]){round(value)}(?:[.,]\d+)?(?!\d)", prompt) if value else None
    return None if match is None else Evidence(start=match.start(), end=match.end(), text=match.group(), field="total_area", source="llm")
