"""An apartment's plan from one generator: program, draft, openings; drafts that do not work are drawn again."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from shapely.geometry import Polygon

from pipeline.corpus.houses import draft, openings, outline, room_list
from pipeline.entities.plan import Plan, Room
from pipeline.errors import ContentError

PROGRAMS, STRICT = 24, 16
DRAFTS = 30
SHAFT_SHARE = 0.33
NECK = 0.5
"""Narrowest place between two parts of a room [m]."""
# Narrowest clear side by room type [m].
NARROWEST = {"Kitchen": 1.55, "Balcony": 0.9, "Bathroom": 1.38, "SecondBathroom": 1.38, "MasterBathroom": 1.4, "LaundryRoom": 1.2}
NARROWEST |= {"StorageRoom": 1.05, "CloakRoom": 1.4, "Hallway": 1.0, "Aisle": 1.0, "Corridor": 1.0, "Library": 2.1, "KidsRoom": 2.4}


def make_plan(rng: np.random.Generator, furnished: Sequence[str]) -> Plan:
    """Draw a plan: rooms `room_<i>` with 3D-FRONT types, polygons of inner faces, doors, windows and an entrance.

    It has a room of every type in `furnished`; only where many programs fail at that, one may be missing.
    """
    for attempt in range(PROGRAMS):
        wanted = room_list.sample(rng, furnished)
        for _ in range(DRAFTS):  # redrawn for one program, so that hard programs are not crowded out by easy ones
            plan = _attempt(rng, wanted, furnished if attempt < STRICT else ())
            if plan is not None:
                return plan
    raise ContentError(f"no house plan after {PROGRAMS} programs", "choose another seed in params.yaml")


def lacking(types: Sequence[str], furnished: Sequence[str]) -> Counter[str]:
    """Return the furnished types of which there are too few rooms; any corridor serves as a hall."""
    wanted = Counter("Hallway" if t in openings.CORRIDORS else t for t in furnished)
    return wanted - Counter("Hallway" if t in openings.CORRIDORS else t for t in types)


def _attempt(rng: np.random.Generator, wanted: room_list.Program, furnished: Sequence[str]) -> Plan | None:
    make = draft.spine if rng.random() < 0.55 else draft.centre
    sketch = make(rng, wanted)
    if lacking(sketch.types, furnished):
        return None
    first_patches = [
        p
        for i, p in enumerate(sketch.patches)
        if sketch.types[p[0]] not in openings.CORRIDORS and p[0] not in {q[0] for q in sketch.patches[:i]}
    ]
    patches = draft.reorient(rng, draft.shafts(rng, sketch.patches, first_patches, SHAFT_SHARE))
    stretches = outline.walls(*outline.paint(patches))
    loops = [outline.outline(i, stretches) for i in range(len(sketch.types))]
    height = float(rng.choice([2.6, 2.8], p=[0.45, 0.55]))
    rooms = []
    for i, (room_type, loop) in enumerate(zip(sketch.types, loops, strict=True)):
        if loop is None or not _usable(loop, room_type):
            return None
        faces = outline.inset(loop)
        if not passable(faces):
            return None
        rooms.append(Room(f"room_{i}", room_type, faces, height=height))
    placed = openings.wall_openings(rng, sketch.types, sketch.parents, stretches)
    if placed is None:
        return None
    angle = float(rng.uniform(1.45, 1.57))
    ways = tuple(openings.opening(k, gap, stretches, angle) for k, gap in enumerate(placed))
    entrance = next(w.rooms[0] for w in ways if w.kind == "entrance")
    return Plan(tuple(rooms), ways, entrance)


def passable(faces: NDArray[np.float64]) -> bool:
    """Whether a room of these inner faces (n, 2) [m] is one piece, nowhere narrower than NECK: walls that are near each other may cross."""
    polygon = Polygon(faces)
    return bool(polygon.is_valid and polygon.buffer(-NECK / 2, join_style="mitre").geom_type == "Polygon")


def _usable(loop: Sequence[tuple[int, int]], room_type: str) -> bool:
    """Whether no edge is a sliver and the room is neither too narrow nor far from its type's usual area."""
    xs, ys = [x for x, _ in loop], [y for _, y in loop]
    steps = [abs(x - px) + abs(y - py) for (x, y), (px, py) in zip(loop, [loop[-1], *loop[:-1]], strict=True)]
    if min(steps) < 25:
        return False
    clear = min(max(xs) - min(xs), max(ys) - min(ys)) / 100 - 0.12
    if clear < NARROWEST.get(room_type, 2.6):
        return False
    # Between the faces: the loop's area less a strip of INSET along its edges, its corners counted once (4 more outer than inner ones).
    twice = sum(px * y - x * py for (x, y), (px, py) in zip(loop, [loop[-1], *loop[:-1]], strict=True))
    size = (abs(twice) / 2 - outline.INSET * sum(steps) + 4 * outline.INSET**2) / 1e4
    if room_type in room_list.AREAS:
        _, _, least, most = room_list.AREAS[room_type]
        return 0.82 * least <= size <= 1.15 * most
    return 0.9 <= size <= 12.0
