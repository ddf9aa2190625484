"""From rooms and facts to a FloorProgram, with the words that each field was read from."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable
from typing import Any

from pipeline.errors import RefusedError
from pipeline.floorplan.defaults import DEFAULTS
from pipeline.floorplan.language import lexicon
from pipeline.floorplan.language.facts import HALLS, Fact, Reading
from pipeline.floorplan.language.inventory import Inventory, Named
from pipeline.floorplan.language.items import Item
from pipeline.floorplan.language.spelling import vocabulary
from pipeline.floorplan.language.tokens import MARKS, Token
from pipeline.floorplan.program import FloorProgram, Style

ROLES = {"primary", "guest", "child", "elder", "staff", "carer", "shared"}
MERGE_ORDER = ("living_room", "family_room", "dining_room", "kitchen", "studio_room")
OPPOSITE, FAR = 0.45, 0.35  # "at the other end" and "away from", as shares of the diagonal
MOST_STOREYS = 3
PANORAMA = 8.5  # outside wall of a living room with panoramic glazing [m]
ABOUT = 0.1  # "about 75 m2" allows this much either way


class Draft:
    """The program while it is put together, as plain data for pydantic."""

    def __init__(self, prompt: str, tokens: list[Token]) -> None:
        self.prompt, self.tokens = prompt, tokens
        self.links: dict[tuple[str, str], dict[str, Any]] = {}
        self.forbids: list[dict[str, Any]] = []
        self.relations: list[dict[str, Any]] = []
        self.evidence: list[dict[str, Any]] = []
        self.fields: dict[str, Any] = {}

    def cite(self, first: int, last: int, field: str) -> None:
        """Note that `field` was read from tokens[first:last]."""
        start, end = self.tokens[first].start, self.tokens[last - 1].end
        self.evidence.append({"start": start, "end": end, "text": self.prompt[start:end], "field": field})

    def link(self, a: str, b: str, kind: str, fact: Fact) -> None:
        """Add a link, or sharpen the one there is."""
        if a == b:
            return
        key = (min(a, b), max(a, b))
        old = self.links.get(key)
        if old is None or (old["kind"] in {"any", "wall"} and kind not in {"any", "wall"}):
            self.links[key] = {"a": a, "b": b, "kind": kind, "stated": True}
        self.cite(fact.first, fact.last, f"links.{a}-{b}")

    def linked(self, a: str) -> set[str]:
        """Return the rooms that a room is joined to by an opening."""
        return {k[1] if k[0] == a else k[0] for k, v in self.links.items() if a in k and v["kind"] != "wall"}

    def relate(self, kind: str, a: str, b: str | None, value: float, fact: Fact) -> None:
        """Add a relation once."""
        made = {"kind": kind, "a": a, "b": b, "value": value}
        if made not in self.relations:
            self.relations.append(made)
            self.cite(fact.first, fact.last, f"relations.{kind}.{a}")

    def forbid(self, what: str, a: str, b: str | None, avoid: str | None, first: int, last: int) -> None:
        """Add a prohibition once."""
        made = {"what": what, "a": a, "b": b, "avoid": avoid}
        if made not in self.forbids:
            self.forbids.append(made)
            self.cite(first, last, f"forbids.{what}.{a}")


def assemble(prompt: str, tokens: list[Token], parsed: list[list[Item]], state: Reading) -> FloorProgram:
    """Return the program of what was read; nothing is filled in."""
    draft = Draft(prompt, tokens)
    stock = state.inventory
    text = re.sub(r"[-–\s]+", " ", prompt.lower().replace("’", "'"))
    _studio(state)
    _ban_rooms(draft, state)
    _belongings(draft, stock, state.facts)
    _joined(draft, stock, state.facts)
    _everything(draft, stock, state.facts)
    _suites(draft, stock, state.facts)
    _apart(draft, stock, state.facts, text)
    _sizes(draft, state)
    _comparisons(draft, stock, text)
    _whole(draft, state, text)
    _style(draft, re.sub(r"(square|sq\.?) ?(m|f)\w*", " ", text))
    spans = sorted((s, e, t) for s, e, t in _rest(state, draft) if not any(v["start"] <= s < v["end"] for v in draft.evidence))
    return FloorProgram.model_validate(
        {
            **draft.fields,
            "rooms": [_room(r) for r in stock.rooms],
            "links": list(draft.links.values()),
            "forbids": draft.forbids,
            "relations": draft.relations,
            "language": "en",
            "evidence": [*_named(parsed, draft), *draft.evidence],
            "unparsed": [{"start": s, "end": e, "text": t} for s, e, t in spans],
        }
    )


def _room(room: Named) -> dict[str, Any]:
    area: dict[str, Any] = {"min": room.low, "max": room.high, "target": room.target}
    stated = any(v is not None for v in area.values())
    if not stated and room.size != 1.0:
        area["target"] = round(DEFAULTS[room.type].area * room.size, 2)
    return {
        "id": room.id,
        "type": room.type,
        "role": room.role if room.role in ROLES else "",
        "functions": tuple(sorted(room.functions)),
        "area": {**area, "stated": stated},
        "level": room.level,
        "exterior": room.exterior,
        "exterior_length": room.exterior_length,
        "window": room.window,
        "objects": room.objects,
        "walkable": room.walkable,
        "min_width": room.min_width,
    }


def _named(parsed: list[list[Item]], draft: Draft) -> list[dict[str, Any]]:
    """Evidence for the rooms themselves."""
    found = []
    for item in (i for s in parsed for i in s if i.ids and i.kind == "room"):
        start, end = draft.tokens[item.first].start, draft.tokens[item.last - 1].end
        found += [{"start": start, "end": end, "text": draft.prompt[start:end], "field": f"rooms.{i}"} for i in item.ids]
    return found


def _rest(state: Reading, draft: Draft) -> Iterable[tuple[int, int, str]]:
    """Words that nothing was read from and that are not mere function words."""
    for k, token in enumerate(draft.tokens):
        plain = token.text in MARKS or token.text in vocabulary()[0] or token.text.endswith("'s")
        if k not in state.used and not plain and token.number is None:
            yield token.start, token.end, draft.prompt[token.start : token.end]


def _studio(state: Reading) -> None:
    """Make a studio without a named main room one room to live and sleep in."""
    stock = state.inventory
    if state.studio is not None and not stock.of("studio_room") and not stock.of("bedroom"):
        living = stock.of("living_room")
        room = living[0] if living else stock.add("studio_room", "", "studio", 0)
        room.type = "studio_room"
        room.functions |= {"living", "sleeping"}
        if not stock.of("kitchen"):
            room.functions.add("cooking")
    for room in stock.of("studio_room"):
        room.functions |= {"living", "sleeping"}


def _ban_rooms(draft: Draft, state: Reading) -> None:
    for kind, item in state.banned:
        draft.forbid("room_type", kind, None, None, item.first, item.last)


def _pairs(a: tuple[str, ...], b: tuple[str, ...]) -> list[tuple[str, str]]:
    """Return who is meant with whom: neighbours of one list, all with a single one, else one by one."""
    if not a or not b:
        return list(itertools.pairwise(a or b))
    if len(a) == 1 or len(b) == 1:
        return [(x, y) for x in a for y in b]
    if len(a) == len(b):
        return list(zip(a, b, strict=True))
    return [(x, b[0]) for x in a]


def _belongings(draft: Draft, stock: Inventory, facts: list[Fact]) -> None:
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


def _joined(draft: Draft, stock: Inventory, facts: list[Fact]) -> None:  # noqa: C901, PLR0912 - one branch per kind of fact
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


def _everything(draft: Draft, stock: Inventory, facts: list[Fact]) -> None:
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


def _suites(draft: Draft, stock: Inventory, facts: list[Fact]) -> None:
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


def _apart(draft: Draft, stock: Inventory, facts: list[Fact], text: str) -> None:
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


def _sizes(draft: Draft, state: Reading) -> None:
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


TIMES = re.compile(
    r"(?:the )?(master|main bedroom|main office|living room|kitchen|bedroom|office)[^.;]{0,40}?(one and a half times|1\.5 times|1½ times|twice|two times|three times|at least as (?:large|big))"
    r"[^.;]{0,30}?(?:size of|as large as|as big as|bigger than|larger than|as) the (second bedroom|other bedrooms?|guest bedroom|kitchen|living room|bedroom|meeting room)"
)
FACTORS = {"one and a half times": 1.5, "1.5 times": 1.5, "1½ times": 1.5, "twice": 2.0, "two times": 2.0, "three times": 3.0}


def _comparisons(draft: Draft, stock: Inventory, text: str) -> None:
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


def _whole(draft: Draft, state: Reading, text: str) -> None:
    """Read what concerns the whole home: storeys, outline, whether the list of rooms is closed, access and entrance."""
    stock = state.inventory
    levels = [r.level for r in stock.rooms if r.level is not None]
    storeys = state.storeys[0] if state.storeys else 1
    if state.storeys:
        draft.cite(state.storeys[1].first, state.storeys[1].last, "storeys")
    if storeys > MOST_STOREYS:
        raise RefusedError(f"{storeys} storeys are asked for", f"ask for {MOST_STOREYS} at most")
    draft.fields["storeys"] = max(storeys, max(levels, default=0) + 1)
    if draft.fields["storeys"] == 1:
        for room in stock.rooms:
            room.level = 0
    if re.search(r"\b(that's it|nothing else|nothing more|only these|no other rooms)\b", text):
        draft.fields["only"] = True
    if re.search(r"\bno wasted (corridor|hall)|\bno (corridor|hallway)s?\b(?! (narrower|less|smaller))", text):
        draft.forbid("room_type", "hallway", None, None, 0, 1)
    if re.search(r"\b(luxury|luxurious|generous airy|palatial|lavish)\b", text):
        draft.fields["scale"] = 1.3
    _outline(draft, text)
    _access(draft, state, text)
    if re.search(r"eat in kitchen|big enough to eat in|kitchen diner|dining kitchen|kitchen to eat in", text):
        for room in (r for r in stock.of("kitchen") if not r.role):
            room.functions.add("dining")
    if "panoramic" in text:
        for room in stock.of("living_room")[:1]:
            room.exterior_length = PANORAMA


def _outline(draft: Draft, text: str) -> None:
    shape = "L" if re.search(r"\bl shaped?\b", text) else ("T" if re.search(r"\bt shaped?\b", text) else "rectangle")
    if re.search(r"\b[lt] shaped? (living|kitchen|bedroom|sofa|room)", text):
        shape = "rectangle"
    if re.search(r"\b(narrow|elongated)\b[^.]{0,40}\b(house|townhouse|home|plot|site|lot|footprint|outline|building)", text):
        draft.fields["footprint"] = {"shape": shape, "min_aspect": 1.5, "max_aspect": 2.1, "stated": True}
    elif shape != "rectangle" or re.search(r"rectangular (outline|footprint|plan)", text):
        draft.fields["footprint"] = {"shape": shape, "stated": True}


def _access(draft: Draft, state: Reading, text: str) -> None:
    access = draft.fields.setdefault("accessibility", {})
    if re.search(r"wheelchair|step free|barrier free|rollator|no steps", text):
        access["step_free"] = True
    if re.search(r"wheelchair|rollator", text):
        access["min_door"] = max(access.get("min_door", 0.9), 0.9)
        access["min_corridor"] = max(access.get("min_corridor", 1.2), 1.2)
    entrance: dict[str, Any] = {"into": state.entrance, "stated": True} if state.entrance else {}
    if re.search(r"own (front )?door to the outside|own entrance|separate entrance|own outside door", text):
        stock = state.inventory
        owners = [r for kind in ("kitchen", "bedroom") for r in stock.of(kind) if r.role in {"elder", "guest", "staff", "carer"}]
        entrance["separate"] = [owners[0].id] if owners else []
    draft.fields["entrance"] = entrance


def _style(draft: Draft, text: str) -> None:
    knobs: dict[str, int] = {}
    for phrase, changes in lexicon.STYLES.items():
        found = re.search(rf"\b{re.escape(phrase)}\b", text)
        if not found:
            continue
        for knob, value in changes.items():
            if abs(value) > abs(knobs.get(knob, 0)):
                knobs[knob] = value
        if phrase in lexicon.IRREGULAR_WORDS:
            draft.fields["nonrect"] = 1
        at = re.search(phrase.replace(" ", r"[-–\s]+"), draft.prompt, re.IGNORECASE)
        if at:
            draft.evidence.append({"start": at.start(), "end": at.end(), "text": at.group(), "field": "style"})
    if knobs:
        draft.fields["style"] = Style.model_validate(knobs).model_dump()
