"""Wishes for furniture: which categories and groups there are, where they can stand, and which wishes no room can meet."""

import functools
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from pipeline import style, taxonomy, yaml_text
from pipeline.card import cards
from pipeline.floorplan.program.floor_program import FloorProgram, Furniture, RoomReq, Things

LEXICON = Path(__file__).resolve().parents[3] / "manifests" / "lexicon" / "furniture.yaml"
TABLES, CHAIRS = ("dining_table", "any_table"), "any_chair"  # at which one eats, and on which
LAID = frozenset({"rug"})  # what the layout model does not know and finishing lays, where it is wished for in any case
LEAST_FLOOR = 0.25  # [m2] of floor that a piece takes in the mean, lamps and wall units among them
CROWDED = 0.9  # share of a room's floor that pieces may take at most
SLACK = 1.1  # areas may turn out this much larger than their target


@functools.cache
def lexicon() -> Mapping[str, Any]:
    """Read the words of furniture: those of categories stand on their cards, of groups and of all around them in the lexicon."""
    entries: dict[str, Any] = yaml_text.parse(LEXICON.read_text(encoding="utf-8"))
    names = {name: card.words for name, card in cards().items() if card.words}
    groups = {group: tuple(name for name, card in cards().items() if group in card.groups) for group in entries["groups"]}
    looks = {name: look.words for name, look in style.load().styles.items() if look.words}
    return entries | {"names": entries["groups"] | names, "groups": groups, "styles": looks}


def members(selector: str) -> tuple[str, ...]:
    """Return the categories that a category or a group means, () for an unknown one."""
    groups: Mapping[str, list[str]] = lexicon()["groups"]
    if selector in groups:
        return tuple(groups[selector])
    return (selector,) if selector in LAID or selector in taxonomy.load().names else ()


def arranged(wish: Furniture) -> tuple[Things, ...]:
    """Return the wishes for things that the layout model arranges: not for what is laid when it is done."""
    return tuple(c for c in wish.counts if c.category not in LAID)


def matching_categories(things: Things, kind: str) -> tuple[str, ...]:
    """Return the categories that meet a wish in a room of type `kind`: a table wished for in a dining room is no coffee table.

    Where a group is bounded from above alone, all its members count.
    """
    if not things.min:
        return members(things.category)
    by_room: Mapping[str, list[str]] = lexicon()["meant"].get(things.category, {})
    categories = next((names for kinds, names in by_room.items() if kind in kinds.split()), by_room.get("*"))
    return tuple(categories) if categories else members(things.category)


def is_furnished(kind: str) -> bool:
    """Whether rooms of a type are furnished at all."""
    known = taxonomy.load()
    return kind in known.layouts or (kind in known.types and known.types[kind].furnished_as != "")


def natural(selector: str) -> tuple[str, ...]:
    """Return the room types in which what one calls so usually stands, the likeliest first."""
    meant = [kind for kinds in lexicon()["meant"].get(selector, {}) for kind in kinds.split() if kind != "*"]
    return tuple(dict.fromkeys([*(kind for name in members(selector) for kind in cards()[name].usual), *meant]))


def impossible(kind: str, category: str) -> bool:
    """Whether a category cannot stand in a room of that type."""
    return category in cards() and kind in cards()[category].never


def merge_wishes(low: Furniture, high: Furniture) -> Furniture:
    """Lay one set of wishes over another: what `high` says of a category or a field goes first."""
    said = {c.category for c in high.counts}
    covered = {m for c in high.counts for m in members(c.category)}
    counts = tuple(c for c in low.counts if c.category not in said and not (c.max == 0 and set(members(c.category)) <= covered))
    update = {k: getattr(high, k) for k in ("least", "most", "style", "openable", "walkable") if getattr(high, k) is not None}
    return low.model_copy(update={**update, "counts": (*counts, *high.counts)})


def spread(program: FloorProgram) -> FloorProgram:
    """Hand the whole home's wishes to its rooms: style, free floor and what is ruled out to each, things to the room that usually has them."""
    wish = program.furniture
    if wish == Furniture():
        return program
    everywhere = wish.model_copy(update={"counts": tuple(c for c in wish.counts if not c.min)})
    each = everywhere.model_copy(update={"least": None, "most": None, "openable": None})
    rooms = [r.model_copy(update={"furniture": merge_wishes(each, r.furniture)}) if is_furnished(r.type) else r for r in program.rooms]
    kept: list[Things] = []
    put: dict[str, int] = {}
    for things in (c for c in wish.counts if c.min):
        home = next((k for kind in natural(things.category) for k, r in enumerate(rooms) if r.type == kind), None)
        if set(members(things.category)) & set(members(CHAIRS)):  # "a dining table for six"
            home = next((put[name] for name in TABLES if name in put), home)
        if home is None:
            kept.append(things)
            continue
        put[things.category] = home
        own = Furniture(counts=(things,))
        rooms[home] = rooms[home].model_copy(update={"furniture": merge_wishes(rooms[home].furniture, own)})
    left = everywhere.model_copy(update={"counts": (*everywhere.counts, *kept)})
    return program.model_copy(update={"rooms": tuple(rooms), "furniture": left})


def allot_pieces(program: FloorProgram) -> FloorProgram:
    """Share the home's number of pieces, and of pieces that open, among its rooms by their areas; what a room states stays."""
    wish, rooms = program.furniture, list(program.rooms)
    bound = wish.most if wish.most is not None else wish.least
    if bound is not None:
        chosen = [k for k, r in enumerate(rooms) if is_furnished(r.type) and r.furniture.least is None and r.furniture.most is None]
        spare = bound - sum(max(r.furniture.least or 0, r.furniture.most or 0) for r in rooms)
        for k, n in _shares(rooms, chosen, spare, [least_pieces(rooms[k].furniture) for k in chosen]):
            own = {"least": n if wish.least is not None else None, "most": n if wish.most is not None else None}
            rooms[k] = rooms[k].model_copy(update={"furniture": rooms[k].furniture.model_copy(update=own)})
    if wish.openable is not None:
        chosen = [k for k, r in enumerate(rooms) if is_furnished(r.type) and r.furniture.openable is None]
        spare = wish.openable - sum(r.furniture.openable or 0 for r in rooms)
        for k, n in _shares(rooms, chosen, spare, [0] * len(chosen)):
            rooms[k] = rooms[k].model_copy(update={"furniture": rooms[k].furniture.model_copy(update={"openable": n})})
    return program.model_copy(update={"rooms": tuple(rooms)})


def _shares(rooms: Sequence[RoomReq], chosen: Sequence[int], total: int, least: Sequence[int]) -> list[tuple[int, int]]:
    """Return (room, number): `least` each, the rest of `total` by area, the largest remainders first."""
    if not chosen:
        return []
    rest = max(total - sum(least), 0)
    areas = [rooms[k].area.target or 1.0 for k in chosen]
    exact = [rest * a / sum(areas) for a in areas]
    whole = [int(e) for e in exact]
    for i in sorted(range(len(chosen)), key=lambda i: (whole[i] - exact[i], i))[: rest - sum(whole)]:
        whole[i] += 1
    return [(k, n + low) for k, n, low in zip(chosen, whole, least, strict=True)]


def faults(program: FloorProgram) -> Iterable[tuple[str, str, tuple[str, ...]]]:
    """Yield (message, remedy, fields of the evidence) for every wish that cannot be met."""
    for things in program.furniture.counts:
        field = f"furniture.{things.category}"
        if not members(things.category):
            yield f"no furniture is called {things.category!r}", "see docs/floorplan.md for the categories", (field,)
        elif things.min:
            yield f"no room of the home is one for a {plain(things.category)}", "say which room it shall stand in", (field,)
    for room in program.rooms:
        yield from _room_faults(room)
    named, most = sum(max(r.furniture.least or 0, least_pieces(r.furniture)) for r in program.rooms), program.furniture.most
    if most is not None and named > most:
        fields = ("furniture", *(f"rooms.{r.id}.furniture" for r in program.rooms))
        yield f"the home is to have {most} pieces, and its rooms {named}", "ask for more pieces or for fewer things", fields


def plain(category: str) -> str:
    """Return a category as words."""
    return category.removeprefix("any_").replace("_", " ")


def _room_faults(room: RoomReq) -> Iterable[tuple[str, str, tuple[str, ...]]]:
    wish, here = room.furniture, f"rooms.{room.id}.furniture"
    if wish == Furniture():
        return
    if not is_furnished(room.type):
        yield f"{room.id} is a {plain(room.type)}, which sfgen leaves empty", "wish for furniture in other rooms", (here,)
        return
    for things in wish.counts:
        named = members(things.category)
        field = (f"{here}.{things.category}",)
        if not named:
            yield f"no furniture is called {things.category!r}", "see docs/floorplan.md for the categories", field
        elif things.min and all(impossible(room.type, name) for name in named):
            yield f"a {plain(things.category)} cannot stand in {room.id}, a {plain(room.type)}", "wish for it in another room", field
        if things.max is not None and things.max < things.min:
            yield f"{room.id} is to have at least {things.min} and at most {things.max} {plain(things.category)}", "change one", field
    yield from _sums(room, wish, here)


def _sums(room: RoomReq, wish: Furniture, here: str) -> Iterable[tuple[str, str, tuple[str, ...]]]:
    fields = (here, f"{here}.pieces", *(f"{here}.{c.category}" for c in wish.counts))
    least, most = least_pieces(wish), wish.most
    if wish.least is not None and most is not None and wish.least > most:
        yield f"{room.id} is to have at least {wish.least} and at most {most} pieces", "swap the two", fields
    if most is not None and least > most:
        yield f"{room.id} is to have {most} pieces, and the wishes name {least}", "ask for more pieces or for fewer things", fields
    for a in wish.counts:
        for b in wish.counts:
            inside = a is not b and set(members(a.category)) <= set(members(b.category))
            if inside and b.max is not None and a.min > b.max:
                message = f"{room.id} is to have {a.min} {plain(a.category)} and at most {b.max} {plain(b.category)}"
                yield message, "keep one of the two", fields
    area = room.area.max or (room.area.target or 0.0) * SLACK
    pieces = max(least, wish.least or 0)
    share = CROWDED - (wish.walkable or 0.0)
    if area and pieces and pieces * LEAST_FLOOR > max(share, 0.0) * area:
        free = f" with {wish.walkable:.0%} of it free" if wish.walkable else ""
        words = (*fields, f"{here}.walkable", f"rooms.{room.id}.area")
        yield f"{pieces} pieces do not fit into {room.id}, {area:.0f} m2{free}", "ask for fewer, or for a larger room", words


def least_pieces(wish: Furniture) -> int:
    """Return how many pieces the wishes name at least; a thing of a narrow category also counts for a group around it."""
    total = 0
    for things in arranged(wish):
        inner = sum(c.min for c in wish.counts if c is not things and set(members(c.category)) < set(members(things.category)))
        total += max(things.min - inner, 0)
    return max(total, wish.openable or 0)
