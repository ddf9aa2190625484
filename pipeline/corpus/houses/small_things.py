"""Small things: rugs under tables, curtains at windows, pictures on walls, and what lies on and in furniture.

A thing that lies on furniture lies on a level surface of the support's geometry, wholly inside it, and meets no part of the support,
no other thing and nothing else in the room.
"""

import dataclasses
import math
from collections.abc import Mapping, Sequence

import numpy as np

from pipeline.card import cards
from pipeline.corpus.furniture.catalogue import Model
from pipeline.corpus.houses.arranger import Arranger
from pipeline.corpus.houses.rates import load as load_rates
from pipeline.corpus.houses.records import Item, wrap
from pipeline.corpus.houses.room_occupancy import Solid, against, box_of, meets, problems, wall_of
from pipeline.corpus.houses.stock import Surfaces
from pipeline.entities.plan import Opening

MARGIN = 0.01  # least distance of a thing from the edge it lies at, and from another thing [m]
TRIES = 6
LOWEST, HIGHEST = 0.03, 1.75  # surfaces within these heights above the support's foot are used [m]
HUNG_AT = 1.35  # underside of pictures and mirrors [m]
Corners = tuple[np.ndarray, np.ndarray]


def add_small_things(arranger: Arranger, openings: Sequence[Opening], kind: str) -> None:
    """Add the small things of a furnished room of a layout type to its items."""
    items, rates = arranger.space.items, load_rates()["things"]
    if not items:
        return
    for category, expected in rates["floor"].get(kind, {}).items():
        for _ in range(draw_count(arranger.rng, expected)):
            _on_floor(arranger, category)
    lay_rug(arranger, rates["rug"].get(kind, 0.0))
    hang_curtains(arranger, rates["curtain"].get(kind, 0.0), openings)
    for category, share in rates["wall"].get(kind, {}).items():
        if arranger.chance(share):
            arranger.on_wall(category, HUNG_AT)
    for index in range(len(items)):
        wanted = cards()[items[index].model.category].corpus.holds
        if wanted:
            load(arranger, index, wanted)


def draw_count(rng: np.random.Generator, expected: float) -> int:
    """Draw a number with that mean: at most one where less than one is expected."""
    return int(expected) + int(rng.random() < expected - int(expected))


def load(arranger: Arranger, index: int, wanted: Mapping[str, float]) -> None:
    """Lay things on and into item `index`; `wanted` are expected numbers."""
    space, rng = arranger.space, arranger.rng
    support = space.items[index]
    surfaces = arranger.stock.surfaces(support.model)
    if surfaces is None:
        return
    others = [(i.rect(), i.position[2], i.position[2] + i.size[2]) for k, i in enumerate(space.items) if k != index]
    taken: list[Corners] = []
    for category, expected in wanted.items():
        for _ in range(draw_count(rng, expected)):
            model = arranger.pick(category)
            if model is None:
                break
            place = _place(rng, model, support, surfaces, taken, others)
            if place is not None:
                space.items.append(dataclasses.replace(place, support=index))


def _place(
    rng: np.random.Generator, model: Model, support: Item, surfaces: Surfaces, taken: list[Corners], others: list[Solid]
) -> Item | None:
    """Return the thing on one of the support's surfaces, or None where it found no room in a few tries."""
    w, d, h = model.size
    turn = float(rng.normal(0, 0.1) if cards()[model.category].corpus.facing else rng.uniform(-math.pi, math.pi))
    x0, y0, x1, y1 = box_of(0, 0, turn, w, d)
    tops = surfaces.tops
    slack = np.minimum(tops[:, 2] - tops[:, 0] - (x1 - x0), tops[:, 3] - tops[:, 1] - (y1 - y0)) - 2 * MARGIN
    usable = np.flatnonzero((slack >= 0) & (tops[:, 4] > LOWEST) & (tops[:, 4] < HIGHEST))
    if not len(usable):
        return None
    for _ in range(TRIES):
        top = tops[usable[int(rng.integers(len(usable)))]]
        x = float(rng.uniform(top[0] + MARGIN - x0, top[2] - MARGIN - x1))
        y = float(rng.uniform(top[1] + MARGIN - y0, top[3] - MARGIN - y1))
        low = np.array([x + x0, y + y0, top[4] + 1e-3])
        high = np.array([x + x1, y + y1, top[4] + h])
        if ((surfaces.boxes[:, 0] < high) & (surfaces.boxes[:, 1] > low)).all(axis=1).any():
            continue
        if any((a - MARGIN < high).all() and (b + MARGIN > low).all() for a, b in taken):
            continue
        px, py, pz = support.position
        c, s = math.cos(support.yaw), math.sin(support.yaw)
        item = Item(model, support.room, (px + c * x - s * y, py + s * x + c * y, pz + float(top[4])), wrap(support.yaw + turn))
        box, z = item.rect(), item.position[2]
        if any(z < t and b < z + h and meets(box, r) for r, b, t in others):
            continue
        taken.append((low, high))
        return item
    return None


def lay_rug(arranger: Arranger, share: float) -> None:
    """Lay a rug under the coffee table, before the bed, or in the middle of the room; what stands on it rises by its thickness."""
    space, rng = arranger.space, arranger.rng
    if not arranger.chance(share):
        return
    rugs = sorted(arranger.stock.by_category.get("rug", ()), key=lambda m: -m.size[0] * m.size[1])
    rugs = [m for m in rugs if rng.random() < 0.6]  # not always the largest that fits
    tables = [k for k, i in enumerate(space.items) if i.model.category == "coffee_table"]
    floor = [(k, i.rect()) for k, i in enumerate(space.items) if i.position[2] < 0.05]
    doors = space.clearances[: len(space.doors)]
    places = [space.items[k].position[:2] for k in tables] + arranger.middles()
    yaw = space.items[tables[0]].yaw if tables else float(rng.choice([0.0, math.pi / 2]))
    for rug in rugs:
        for x, y in places:
            for turn in (yaw, wrap(yaw + math.pi / 2)):
                box = box_of(x, y, turn, rug.size[0], rug.size[1])
                on = [(k, r) for k, r in floor if meets(box, r)]
                inside = all(box[0] <= r[0] and box[1] <= r[1] and r[2] <= box[2] and r[3] <= box[3] for _, r in on)
                if not inside or any(k not in tables for k, _ in on) or any(meets(box, r) for r in doors):
                    continue
                if any(meets(box, r) for r, low, _ in space.solids if low < -1.0):  # a wall
                    continue
                index = len(space.items)
                space.items.append(Item(rug, space.number, (x, y, 0.0), turn))
                for k, _ in on:
                    px, py, pz = space.items[k].position
                    space.items[k] = dataclasses.replace(space.items[k], position=(px, py, pz + rug.size[2]), support=index)
                return


def hang_curtains(arranger: Arranger, share: float, openings: Sequence[Opening]) -> None:
    """Hang a curtain before each window with free wall around it, scaled to the window and the room's height."""
    space = arranger.space
    if not arranger.chance(share):
        return
    model = arranger.pick("curtain")
    for opening in openings:
        if model is None or opening.kind != "window":
            continue
        side, low, high = wall_of(space.sides, opening)
        w, d, h = model.size
        width = min(high - low + 0.3, 2 * min(low + high, 2 * side.length - low - high) / 2 - 0.04)
        top = min(space.height - 0.04, opening.sill + opening.height + 0.25)
        bottom = 0.02 if opening.sill < 0.7 else max(opening.sill - 0.25, 0.02)
        scale = (width / w, 1.0, (top - bottom) / h)
        if not (0.2 < scale[0] < 4.0 and 0.3 < scale[2] < 1.6):
            continue
        x, y = side.point((low + high) / 2, d / 2 + 0.004)
        box = box_of(x, y, side.yaw, width, d)
        blocked = any(meets(box, r) and z0 < top and bottom < z1 for r, z0, z1 in space.solids)
        if not blocked and not any(meets(box, r) for r, low, _ in space.swept if low == 0.0):
            space.items.append(Item(model, space.number, (x, y, bottom), side.yaw, scale))
            space.solids.append((box, bottom, top))


def _on_floor(arranger: Arranger, category: str) -> None:
    """Stand something small at a wall, where nobody passes."""
    model = arranger.pick(category)
    if model is None:
        return
    space = arranger.space
    spot = against(arranger.rng, space, model, front=0.0, corner=0.8)
    cut_off = problems(space)[0]
    if spot is not None and space.try_add(model, spot) and problems(space)[0] > cut_off:
        space.take_back()
