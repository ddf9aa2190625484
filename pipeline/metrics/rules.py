"""What a person sees at once in a furnished room: the chair at its table, the back at the wall, a shower in the bathroom.

Each rule yields one verdict for each case of a room, none where the room has no case. Thresholds are of the eye, not of a
corpus; what a corpus says of its own is in `pipeline.relations`.
"""

from collections.abc import Callable, Iterator, Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from pipeline.arrays import Bools
from pipeline.relations.arrangement import Arrangement
from pipeline.relations.frames import Boxes, Frames, relate, wrap_angle
from pipeline.relations.walls import AROUND, measure

Rule = Callable[[Arrangement], Iterator[bool]]
Indices = NDArray[np.intp]

TABLES = ("dining_table",)
CHAIRS = ("dining_chair", "chinese_chair")
SOFAS = ("multi_seat_sofa", "loveseat_sofa", "l_shaped_sofa", "chaise_longue_sofa")
SEATS = (*SOFAS, "armchair", "lounge_chair", "lazy_sofa")
BEDS = ("double_bed", "single_bed", "kids_bed")
KITCHEN = ("kitchen_cabinet", "sink_cabinet", "oven", "dishwasher", "refrigerator", "tall_unit")
STORAGE = ("wardrobe", "cabinet", "children_cabinet")
DESK_CHAIRS = ("lounge_chair", "dining_chair", "dressing_chair", "chinese_chair", "stool")
HANGING = ("pendant_lamp", "ceiling_lamp")
SLIGHT = (*HANGING, "wall_lamp", "floor_lamp", "plant")  # darken no room
LIVING = ("living_room", "living_dining_room")

AT_TABLE = 0.25  # m between chair and table
BEFORE_SOFA = 0.9  # m between coffee table and sofa
AT_BED = 0.25  # m between nightstand and bed
AT_DESK = 0.5  # m between chair and desk
NEXT = 0.1  # m between units of a run, and
NEXT_BACKS = 0.12  # between their backs
AT_WALL = 0.15  # m between back and wall
APART = 0.28  # m between sink and cooker: the narrowest unit
TALL = 1.2  # m above the floor; what reaches higher
AT_WINDOW = 0.6  # m before a window's wall, and
ACROSS = 0.15  # m across the glass, blocks it
STRAIGHT = np.radians(3.0)
SIGHT = np.radians(35.0)  # to a screen's middle, from a seat's front
SAME = np.radians(10.0)


def of(room: Arrangement, names: tuple[str, ...]) -> Indices:
    """Return the indices of a room's things of these categories."""
    return np.flatnonzero(np.isin(np.array(room.categories, object), names)) if room.categories else np.zeros(0, np.intp)


def frames_of(room: Arrangement, anchors: Indices, members: Indices) -> Frames:
    """Relate each member to every anchor (M * A,), a member's anchors in a row."""
    boxes = Boxes(room.position, room.yaw, room.size)
    return relate(boxes[np.tile(anchors, len(members))], boxes[np.repeat(members, len(anchors))])


def hits(frames: Frames, slack: float = 0.1) -> Bools:
    """Tell whose look straight ahead, from the middle, meets the anchor's box grown by `slack` [m]."""
    look = np.stack([np.sin(frames.turn), -np.cos(frames.turn)], -1)
    look = np.where(np.abs(look) < 1e-9, 1e-9, look)
    half = frames.anchor / 2 + slack
    ends = np.sort(np.stack([(-half - frames.place) / look, (half - frames.place) / look]), axis=0)
    return np.asarray((ends[0].max(1) <= ends[1].min(1)) & (ends[1].min(1) > 0))


def any_of(room: Arrangement, anchors: tuple[str, ...], members: tuple[str, ...], holds: Callable[[Frames], Bools]) -> Iterator[bool]:
    """Yield for each member whether it holds at one of the anchors; nothing in rooms without an anchor."""
    a, m = of(room, anchors), of(room, members)
    if len(a) and len(m):
        by_member = holds(frames_of(room, a, m)).reshape(len(m), len(a))
        yield from (bool(row.any()) for row in by_member)


def chair_at_table(room: Arrangement) -> Iterator[bool]:
    """Chairs of rooms with a dining table: near one, and facing it."""
    yield from any_of(room, TABLES, CHAIRS, lambda f: (f.apart() <= AT_TABLE) & hits(f))


def coffee_table_before_sofa(room: Arrangement) -> Iterator[bool]:
    """Coffee tables of rooms with a sofa: in front of one, or in the corner of an L."""
    yield from any_of(
        room,
        SOFAS,
        ("coffee_table",),
        lambda f: (f.place[:, 1] < 0) & (np.abs(f.place[:, 0]) < f.anchor[:, 0] / 2) & (f.apart() <= BEFORE_SOFA),
    )


def sofa_looks_at_screen(room: Arrangement) -> Iterator[bool]:
    """Rooms with sofas and a TV stand: the middle of a screen is before one of the sofas, and looks back."""
    a, m = of(room, ("tv_stand",)), of(room, SOFAS)
    if len(a) and len(m):
        frames = frames_of(room, a, m)
        there = np.abs(wrap_angle(frames.turn - np.arctan2(-frames.place[:, 0], frames.place[:, 1]))) < SIGHT
        back = np.abs(np.arctan2(frames.place[:, 0], -frames.place[:, 1])) < SIGHT
        yield bool((there & back).any())


def nightstand_at_bed(room: Arrangement) -> Iterator[bool]:
    """Nightstands of rooms with a bed: beside its head, same front."""

    def holds(f: Frames) -> Bools:
        head = np.abs(f.place[:, 1] + f.extent[:, 1] / 2 - f.anchor[:, 1] / 2) < 0.3
        return np.asarray((np.abs(f.turn) < SAME) & head & (np.abs(f.gaps()[:, 0]) <= AT_BED))

    yield from any_of(room, BEDS, ("nightstand",), holds)


def unit_in_run(room: Arrangement) -> Iterator[bool]:
    """Kitchen units of rooms with several: side by side with another, same front, backs in line."""
    units = of(room, KITCHEN)
    if room.layout_type == "kitchen" and len(units) > 1:
        f = frames_of(room, units, units)
        line = np.abs(f.place[:, 1] + f.extent[:, 1] / 2 - f.anchor[:, 1] / 2) < NEXT_BACKS
        beside = (np.abs(f.turn) < STRAIGHT) & line & (np.abs(f.gaps()[:, 0]) <= NEXT)
        table = beside.reshape(len(units), -1) & ~np.eye(len(units), dtype=bool)
        yield from table.any(1).tolist()


def sink_and_cooker_apart(room: Arrangement) -> Iterator[bool]:
    """Kitchens with both: a unit or more between each sink and the cookers."""
    if room.layout_type == "kitchen":
        yield from (not near for near in any_of(room, ("oven",), ("sink_cabinet",), lambda f: f.apart() < APART))


def wall_unit_over_base(room: Arrangement) -> Iterator[bool]:
    """Wall units of kitchens: over a base unit, or a seam beside it."""
    if room.layout_type == "kitchen":
        for k in of(room, ("wall_cabinet",)):
            frames = frames_of(room, of(room, KITCHEN), np.array([k]))
            yield bool((np.abs(frames.place) <= frames.anchor / 2 + NEXT).all(1).any())


def window_is_free(room: Arrangement) -> Iterator[bool]:
    """Windows: nothing that is tall or hangs on the wall stands before them."""
    tall = [k for k, name in enumerate(room.categories) if name not in SLIGHT]
    floor = room.position[tall, 2].min(initial=0.0) if tall else 0.0
    tall = [k for k in tall if room.position[k, 2] + room.size[k, 2] > floor + TALL]
    for start, end in (opening.segment for opening in room.openings if opening.kind == "window"):
        along = (end - start) / np.linalg.norm(end - start)
        off = np.array([-along[1], along[0]])
        turn = room.yaw[tall] - np.arctan2(along[1], along[0])
        c, s = np.abs(np.cos(turn)), np.abs(np.sin(turn))
        w, d = room.size[tall, :2].T / 2
        middle = room.position[tall, :2] - start
        low, high = middle @ along - c * w - s * d, middle @ along + c * w + s * d
        across = np.minimum(high, np.linalg.norm(end - start)) - np.maximum(low, 0.0)
        yield not bool(((across > ACROSS) & (np.abs(middle @ off) - s * w - c * d < AT_WINDOW)).any())


def straight(room: Arrangement) -> Iterator[bool]:
    """Floor things: parallel to a wall, to 3 degrees. What has no front of its own to speak of counts as well."""
    edge = np.roll(room.polygon, -1, axis=0) - room.polygon
    ways = np.arctan2(edge[:, 1], edge[:, 0])
    for k in (k for k, name in enumerate(room.categories) if name not in HANGING):
        off = np.mod(room.yaw[k] - ways + np.pi / 4, np.pi / 2) - np.pi / 4
        yield bool(np.abs(off).min() <= STRAIGHT)


def backs(names: frozenset[str]) -> Rule:
    """Return the rule for things of these categories: the back at a wall, and along it."""
    back = AROUND.index("back")

    def rule(room: Arrangement) -> Iterator[bool]:
        own = of(room, tuple(names))
        if len(own):
            gap, turn = measure(room)
            yield from ((np.abs(gap[own, back]) <= AT_WALL) & (np.abs(turn[own, back]) < SAME)).tolist()

    return rule


def has(types: tuple[str, ...], *groups: tuple[str, ...]) -> Rule:
    """Return the rule for rooms of these types: at least one thing of each group."""

    def rule(room: Arrangement) -> Iterator[bool]:
        if room.layout_type in types:
            own = set(room.categories)
            yield all(own & set(group) for group in groups)

    return rule


def has_facing_member(anchors: tuple[str, ...], members: tuple[str, ...], reach: float) -> Rule:
    """Return the rule for anchors: some member stands within `reach` [m] and faces it."""

    def rule(room: Arrangement) -> Iterator[bool]:
        a, m = of(room, anchors), of(room, members)
        for k in a:
            if not len(m):
                yield False
                continue
            frames = frames_of(room, np.array([k]), m)
            yield bool(((frames.apart() <= reach) & hits(frames)).any())

    return rule


RULES: Mapping[str, Rule] = MappingProxyType(
    {
        "chair at its table": chair_at_table,
        "coffee table before a sofa": coffee_table_before_sofa,
        "sofa looks at the TV stand": sofa_looks_at_screen,
        "nightstand at the bed": nightstand_at_bed,
        "kitchen unit in a run": unit_in_run,
        "sink and cooker apart": sink_and_cooker_apart,
        "wall unit over a base unit": wall_unit_over_base,
        "window kept free": window_is_free,
        "straight, to 3 degrees": straight,
        "bathroom has toilet and vanity": has(("bathroom",), ("toilet",), ("vanity",)),
        "bathroom has shower or tub": has(("bathroom",), ("shower", "bathtub")),
        "bedroom has a bed": has(("bedroom", "kids_room"), BEDS),
        "bedroom has wardrobe or cabinet": has(("bedroom", "kids_room"), STORAGE),
        "living room has seats": has(LIVING, SEATS),
        "living room has TV and seats": has(LIVING, SEATS, ("tv_stand",)),
        "dining table has chairs": has_facing_member(TABLES, (*CHAIRS, "lounge_chair", "stool"), AT_TABLE),
        "desk has its chair": has_facing_member(("desk",), DESK_CHAIRS, AT_DESK),
        "kitchen has sink, cooker, fridge, worktop": has(
            ("kitchen",), ("sink_cabinet",), ("oven",), ("refrigerator",), ("kitchen_cabinet", "dishwasher")
        ),
    }
)
