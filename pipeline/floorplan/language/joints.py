"""Facts about rooms → links, prohibitions and relations between them."""

from __future__ import annotations

import itertools
import re

from pipeline.floorplan.language import lexicon
from pipeline.floorplan.language.draft import Draft
from pipeline.floorplan.language.facts import HALLS, Fact
from pipeline.floorplan.language.inventory import Inventory

MERGE_ORDER = ("living_room", "family_room", "dining_room", "kitchen", "studio_room")
OPPOSITE, FAR = 0.45, 0.35  # "at the other end" and "away from", as shares of the diagonal


def _pairs(a: tuple[str, ...], b: tuple[str, ...]) -> list[tuple[str, str]]:
    """Return who is meant with whom: neighbours of one list, all with a single one, else one by one."""
    if not a or not b:
        return list(itertools.pairwise(a or b))
    if len(a) == 1 or len(b) == 1:
        return [(x, y) for x in a for y in b]
    if len(a) == len(b):
        return list(zip(a, b, strict=True))
    return [(x, b[0]) for x in a]


def give_belongings(draft: Draft, stock: Inventory, facts: list[Fact]) -> None:
    """Join each room to the one it belongs to: own bathrooms, en suites, kitchens open to a social room."""
    for fact in facts:
        if fact.what == "own":
            owners = fact.b if len(fact.b) == len(fact.a) else fact.b[:1] * len(fact.a)
            for thing, owner in zip(fact.a, owners, strict=True):
                draft.link(owner, thing, "door", fact)
                if stock.get(thing).type in {"bathroom", "wc"}:
                    draft.relate("degree", thing, None, 1.0, fact)
        elif fact.what == "ensuite":
            beds = stock.of("bedroom")
            host = [r.id for r in beds if r.id in fact.b] or [r.id for r in beds if r.role == "primary"] or [r.id for r in beds]
            for thing in fact.a:
                if host and stock.get(thing).type == "bathroom":
                    draft.link(host[0], thing, "door", fact)
                    draft.relate("degree", thing, None, 1.0, fact)
    for room in stock.of("kitchen"):
        if any(f.what == "open_kitchen" and room.id in f.a for f in facts) and not draft.linked(room.id):
            social = [r for kind in ("living_room", "dining_room", "studio_room", "family_room") for r in stock.of(kind)]
            fact = next(f for f in facts if f.what == "open_kitchen")
            draft.link(social[0].id if social else "living_room", room.id, "open", fact)


def join_named(draft: Draft, stock: Inventory, facts: list[Fact]) -> None:  # noqa: C901, PLR0912 - one branch per kind of fact
    """Write each fact about rooms into the program."""
    owned = {i for f in facts if f.what in {"own", "ensuite"} for i in f.a}
    names = {lexicon.DOOR: "door", lexicon.LEADS: "door", lexicon.NEAR: "any", lexicon.OPEN: "open", lexicon.WALL: "wall"}
    for fact in facts:
        if any(i.startswith("*") for i in fact.a + fact.b):
            continue
        if fact.what in names:
            for a, b in _pairs(fact.a, fact.b):
                if fact.what == lexicon.DOOR and len(fact.b) > 1 and draft.linked(a) & set(fact.b):
                    continue
                if a in owned and len(fact.a) > 1 and stock.get(b).type in HALLS:
                    continue  # "two baths on the corridor, one en suite"
                kind = names[fact.what]
                if fact.what == lexicon.NEAR and stock.get(a).type == stock.get(b).type:
                    kind = "wall"  # bedrooms next to each other share a wall, no door
                stairs = "staircase" in {stock.get(a).type, stock.get(b).type}
                draft.link(a, b, "open" if stairs and fact.what != lexicon.WALL else kind, fact)
        elif fact.what == lexicon.BETWEEN and len(fact.b) == 2:
            for a in fact.a:
                for b in fact.b:
                    draft.link(a, b, "any", fact)
        elif fact.what == "merge":
            chain = sorted(fact.a, key=lambda i: MERGE_ORDER.index(stock.get(i).type) if stock.get(i).type in MERGE_ORDER else 9)
            for a, b in itertools.pairwise(chain):
                draft.link(a, b, "open", fact)
        elif fact.what == "only":
            for a in fact.a:
                if stock.get(a).type != "bedroom":  # rooms of its own may lie behind it
                    draft.relate("degree", a, None, 1.0, fact)
        elif fact.what == "largest":
            draft.relate("largest", fact.a[0], stock.get(fact.a[0]).type, 1.0, fact)
        elif fact.what == "area_order" and fact.a and fact.b:
            draft.relate("area_order", fact.a[0], fact.b[0], fact.value, fact)
        elif fact.what == "area_equal":
            for a, b in itertools.combinations(fact.a, 2):
                draft.relate("area_equal", a, b, fact.value, fact)
        elif fact.what == "window":
            for a in fact.a:
                stock.get(a).window = "required"
                draft.cite(fact.first, fact.last, f"rooms.{a}.window")
        elif fact.what == "no_window":
            for a in fact.a:
                stock.get(a).window = "forbidden"
        elif fact.what in {"not_open", "not_connected"}:
            for a, b in _pairs(fact.a, fact.b):
                draft.forbid("open" if fact.what == "not_open" else "connected", a, b, None, fact.first, fact.last)


def join_everything(draft: Draft, stock: Inventory, facts: list[Fact]) -> None:
    """Read "everything off a corridor": all rooms that hang on nothing yet."""
    for fact in facts:
        stars = [i for i in fact.a + fact.b if i.startswith("*")]
        if not stars or fact.what in {"away", lexicon.BAN}:
            continue
        fixed = [i for i in fact.a + fact.b if not i.startswith("*")]
        kind = stars[0][1:]
        for room in stock.rooms:
            if room.id in fixed or (kind and room.type != kind):
                continue
            inner = draft.linked(room.id) and (room.type in {"closet", "bathroom", "balcony", "storage", "wc", "utility"})
            if fixed and not inner and room.type not in HALLS:
                draft.link(fixed[0], room.id, "open" if fact.what == lexicon.OPEN else "door", fact)


def complete_suites(draft: Draft, stock: Inventory, facts: list[Fact]) -> None:
    """Give each suite a bathroom of its own, directly or through its closet."""
    for fact in facts:
        if fact.what != "suite":
            continue
        for bed in fact.a:
            near = draft.linked(bed)
            reach = near | {j for i in near if stock.get(i).type == "closet" for j in draft.linked(i)}
            if any(stock.get(i).type == "bathroom" for i in reach):
                continue
            loose = [r for r in stock.of("bathroom") if not draft.linked(r.id) and "suite" in r.surface]
            bath = loose[0] if loose else stock.add("bathroom", "", "en suite", None)
            draft.link(bed, bath.id, "door", fact)
            draft.relate("degree", bath.id, None, 1.0, fact)
    # an en suite that nobody placed belongs to the main bedroom
    for bath in stock.of("bathroom"):
        if "suite" in bath.surface and not draft.linked(bath.id):
            beds = [r for r in stock.of("bedroom") if r.role == "primary"] or stock.of("bedroom")
            if beds:
                span = next(((f.first, f.last) for f in facts if bath.id in f.a + f.b), (0, 1))
                draft.link(beds[0].id, bath.id, "door", Fact("own", (bath.id,), (beds[0].id,), 0.0, *span))
                draft.relate("degree", bath.id, None, 1.0, Fact("own", (bath.id,), (), 0.0, *span))


def keep_apart(draft: Draft, stock: Inventory, facts: list[Fact], text: str) -> None:
    """Forbid common walls and ways, and ask for distance, where rooms are to be away from each other."""
    share = OPPOSITE if re.search(r"other end|opposite (side|end)|far end", text) else FAR

    def expand(ids: tuple[str, ...]) -> list[str]:
        return [j for i in ids for j in ([r.id for r in stock.of(i[1:])] if i.startswith("*") else [i])]

    for fact in facts:
        if fact.what not in {"away", lexicon.BAN, lexicon.THROUGH}:
            continue
        for a in expand(fact.a):
            for b in expand(fact.b):
                if a == b:
                    continue
                if fact.what == lexicon.THROUGH:
                    draft.forbid("through", a, None, b, fact.first, fact.last)
                    continue
                draft.forbid("adjacent", a, b, None, fact.first, fact.last)
                if fact.what == "away":
                    draft.relate("separation", a, b, share, fact)
    for match in re.finditer(r"(?:two |both )?bedrooms (?:must |should |may |do )?not (?:share a wall|be next to each other|touch)", text):
        beds = [r.id for r in stock.of("bedroom")]
        del match
        for k, a in enumerate(beds):
            for b in beds[k + 1 :]:
                draft.forbid("adjacent", a, b, None, 0, 1)
