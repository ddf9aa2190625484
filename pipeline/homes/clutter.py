"""Small things of a finished home: rugs, curtains, pictures and mirrors, and what lies on and in its furniture."""

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from pipeline import taxonomy
from pipeline.arrange import Hanging, SurfacePlacement, ThingsSettings
from pipeline.arrange.walls import EdgeOpening
from pipeline.arrays import Floats
from pipeline.card import Hangs, cards
from pipeline.entities.home import Home, Placement, rectangle
from pipeline.entities.plan import Room
from pipeline.floorplan.program.floor_program import Furniture
from pipeline.floorplan.program.furniture import LAID
from pipeline.geometry.convex import gap
from pipeline.geometry.door_sweeps import leaf_sweep
from pipeline.geometry.polygons import excess
from pipeline.geometry.prisms import join_prisms, solid
from pipeline.geometry.walls import leaves
from pipeline.homes.library import Library
from pipeline.homes.request import PARTS, layout_type
from pipeline.taxonomy import Layout, Rug

STYLE_WEIGHT = 3.0  # how much likelier a thing in the style of what it belongs to is taken than another
SPREAD = (0.25, 0.05)  # how far curtains and blinds reach beyond their window at either side [m]
FULL, SHORT = 0.03, 0.12  # foot of a curtain above the floor; how far below the sill a short one ends [m]
PLEATS = 0.6  # curtains hang so much flatter than they are made: a hand's breadth from the wall
DRAWN = 0.4  # how far a blind is drawn up, as a share of its window
IN_ROW = 0.06  # between pictures in a row [m]
MOST_IN_ROW = 3
STANDS_ON_RUGS = frozenset({"bed", "table", "chair", "stool", "sofa"})  # super-categories that may stand on a rug, wholly or in part
UNDER_BED = (0.05, 0.25)  # how far the middle of a rug lies within a bed's foot, as a share of the bed's depth
RUGS_TRIED = 3  # the largest of so many is laid
THICK = 0.004  # a flat weave: furniture stands on it without being lifted, robots and doors pass over it [m]
EDGE = 0.08  # least distance of a rug from the walls [m]
SHARES = (1.15, 1.0, 0.85, 0.7)  # shares of its size in which a rug is tried


Wishes = Mapping[str, Furniture]  # by room id


def small_things(
    home: Home, library: Library, settings: ThingsSettings, rng: np.random.Generator, touch: float, wishes: Wishes
) -> tuple[Placement, ...]:
    """Return small things for a home that is sound; what lies on furniture names its `support`.

    They depend on the home, the wishes and the generator alone. What finds no place is not missed, unless it was asked for: see `unlaid`.
    """
    if settings.rate <= 0:
        return ()
    rooms = (_Dressing(home, room, library, settings, rng, touch) for room in home.plan.rooms)
    return tuple(p for room in rooms for p in room.things(wishes.get(room.room.room_id, Furniture())))


def unlaid(things: Sequence[Placement], wishes: Wishes) -> str:
    """Return in words what was to be laid in a room and found no place there, "" where nothing is missing."""
    for room_id, wish in wishes.items():
        for asked in (c for c in wish.counts if c.category in LAID):
            have = sum((p.room_id, p.category) == (room_id, asked.category) for p in things)
            if have < asked.min:
                return f"{room_id}: {have} {asked.category}, asked for at least {asked.min}"
    return ""


class _Dressing:
    """One room while it gets its small things; `found` are those that it has."""

    def __init__(self, home: Home, room: Room, library: Library, settings: ThingsSettings, rng: np.random.Generator, touch: float) -> None:
        self.home, self.room, self.library, self.settings, self.rng, self.touch = home, room, library, settings, rng, touch
        kinds = (layout_type(room, home.plan, taxonomy.load()) or "").split(PARTS)
        self.layouts = [taxonomy.load().layouts.get(kind, Layout(())) for kind in kinds]
        self.furniture = home.in_room(room.room_id)
        self.floor = home.plan.elevation(room.room_id)
        self.found: list[Placement] = []
        self.count: Counter[str] = Counter()

    def things(self, wish: Furniture) -> list[Placement]:
        """Lay the rug, dress windows and walls, then lay things on and in the furniture."""
        if not self.furniture:
            return []
        known = self.layouts[0]
        surfaces = SurfacePlacement(self.room.polygon, self.furniture, self.library, self.settings, self.touch)
        for rug in (layout.rug for layout in self.layouts):
            if rug and self.rng.random() < rug.share * self.settings.rate and all(c.category != rug.category for c in wish.counts):
                self._rug(rug)
        for asked in (c for c in wish.counts if c.category in LAID):
            own = [lay.rug for lay in self.layouts if lay.rug and lay.rug.category == asked.category] or [Rug(asked.category, 1.0)]
            for k in range(asked.min):
                self._rug(replace(own[k % len(own)], middle=True))
        if known.windows or known.walls:
            hanging = self._hanging(surfaces)
            self._windows(hanging, known.windows)
            for category, expected in known.walls.items():
                if custom := cards()[category].hangs:
                    self._walls(hanging, category, expected, custom)
            surfaces.fix([p for p in self.found if p.position[2] > self.floor])
        for number, support in enumerate(self.furniture):
            self._load(surfaces, number, support)
        return self.found

    def _add(self, category: str, asset_id: str, position: Floats, yaw: float, scale: Floats | None = None, support: str = "") -> None:
        factor = np.ones(3) if scale is None else np.round(scale, 5)
        name = f"{self.room.room_id}_{category}_{self.count[category]}"
        size = np.round(self.library[asset_id].size * factor, 4)
        placed = np.round(position, 4) + 0.0
        self.found.append(Placement(name, self.room.room_id, category, asset_id, placed, yaw, size, factor, support=support))
        self.count[category] += 1

    def _of(self, *categories: str) -> list[Placement]:
        """Return the room's furniture of these categories, in the order of the categories."""
        return [p for name in categories for p in self.furniture if p.category == name]

    def _pick_asset(self, category: str, style: str = "") -> str:
        """Draw an asset of a category, rather one of that style; "" if the library has none."""
        shelf = self.library.of(category)
        if not shelf:
            return ""
        weights = np.array([STYLE_WEIGHT if style and self.library.rows[a]["style"] == style else 1.0 for a in shelf])
        return shelf[int(self.rng.choice(len(shelf), p=weights / weights.sum()))]

    def _draw_count(self, expected: float) -> int:
        return int(expected * self.settings.rate + self.rng.random())

    # -- floor -------------------------------------------------------------------------------------------------------

    def _rug(self, custom: Rug) -> None:
        drawn = {asset_id for _ in range(RUGS_TRIED) if (asset_id := self._pick_asset(custom.category))}
        supers = taxonomy.load().categories
        clear = [
            p
            for p in self.furniture
            if supers[p.category].mount == "floor" and (custom.category != "rug" or supers[p.category].super not in STANDS_ON_RUGS)
        ]
        clear += self.found  # rugs of the room's other parts
        polygon = np.ascontiguousarray(self.room.polygon, np.float64)
        for asset_id in sorted(drawn, key=lambda a: (-float(np.prod(self.library[a].size[:2])), a)):
            size = self.library[asset_id].size
            laid = lay_rug(polygon, size, self._rug_places(custom, size), clear)
            if laid is not None:
                position, yaw, scale = laid
                self._add(custom.category, asset_id, np.array([*position, self.floor]), yaw, scale)
                return

    def _rug_places(self, custom: Rug, size: Floats) -> list[tuple[float, float, float]]:
        """Return middles and directions (x, y, yaw) for a rug of `size`, the best first."""
        places = [(float(p.position[0]), float(p.position[1]), p.yaw) for p in self._of(*custom.under)]
        places += [self._ahead(p, -under * float(p.size[1])) for p in self._of(*custom.across) for under in UNDER_BED]
        places += [self._ahead(p, float(size[1]) / 2 + 0.05) for p in self._of(*custom.before)]
        if custom.middle:
            low, high = self.room.polygon.min(0), self.room.polygon.max(0)
            x, y = ((low + high) / 2).tolist()
            places.append((x, y, math.pi / 2 if (high - low)[1] > (high - low)[0] else 0.0))
        return places

    @staticmethod
    def _ahead(placement: Placement, away: float) -> tuple[float, float, float]:
        """Return (x, y, yaw) of a point `away` [m] before the front of an object."""
        out = float(placement.size[1]) / 2 + away
        x, y = placement.position[:2] + out * np.array([math.sin(placement.yaw), -math.cos(placement.yaw)])
        return float(x), float(y), placement.yaw

    # -- walls -------------------------------------------------------------------------------------------------------

    def _hanging(self, surfaces: SurfacePlacement) -> Hanging:
        """Return the room's walls with all that stands before them and all that moves there."""
        own = [o for o in self.home.plan.openings if self.room.room_id in o.rooms and o.level == self.room.level]
        ids = {o.opening_id for o in own}
        swung = join_prisms([leaf_sweep(leaf, self.floor).prisms for leaf in leaves(self.home.plan) if leaf.opening_id in ids])
        boxes = surfaces.sweeps.boxes[np.isfinite(surfaces.sweeps.boxes).all(1)]
        rest = surfaces.rest.prisms
        corners = np.concatenate([rest.corners, swung.corners, boxes[:, [0, 1, 3, 1, 3, 4, *[0, 4] * 9]].reshape(-1, 12, 2)])
        heights = np.concatenate([rest.z, swung.z, boxes[:, [2, 5]]]) - self.floor
        return Hanging(self.room.polygon, own, corners, heights, self.room.height)

    def _windows(self, hanging: Hanging, shares: Mapping[str, float]) -> None:
        mark = self.rng.random() / self.settings.rate
        chosen = next((name for name, most in zip(shares, np.cumsum(list(shares.values())), strict=True) if mark < most), None)
        if chosen is None:
            return
        kinds = [(name, self._pick_asset(name)) for name in dict.fromkeys((chosen, "blind"))]
        for wall, window in hanging.windows:
            for name, asset_id in kinds:
                if asset_id and self._dress_window(hanging, wall, window, name, asset_id):
                    break

    def _dress_window(self, hanging: Hanging, wall: int, window: EdgeOpening, category: str, asset_id: str) -> bool:
        """Hang a curtain to the floor or to the sill, or a blind that is half drawn up, before a window if there is room for it."""
        asset, long = self.library[asset_id], category == "curtain"
        rest = solid(asset).rest
        parts = np.concatenate([rest.boxes()[:, [0, 2]], rest.z], axis=1)
        bottoms = (FULL, max(window.sill - SHORT, FULL)) if long else (window.sill + DRAWN * (window.head - window.sill),)
        hung = hanging.before(wall, window, asset.size, parts, SPREAD[not long], bottoms, PLEATS if long else 1.0)
        if hung is not None:
            place, yaw, scale = hung
            self._add(category, asset_id, place + np.array([0.0, 0.0, self.floor]), yaw, scale)
        return hung is not None

    def _walls(self, hanging: Hanging, category: str, expected: float, custom: Hangs) -> None:
        anchors = [p.footprint() for p in self._of(*(custom.over or custom.beside))]
        for _ in range(self._draw_count(expected)):
            asset_id = self._pick_asset(category)
            if not asset_id:
                return
            size = self.library[asset_id].size
            number = 1
            while number < MOST_IN_ROW and self.rng.random() < custom.row:
                number += 1
            step = float(size[0]) + IN_ROW
            whole = np.array([number * step - IN_ROW, size[1], size[2]])
            hung = hanging.hang(self.rng, whole, custom.middle, anchors, beside=bool(custom.beside), tries=self.settings.tries)
            if hung is not None:
                place, yaw = hung
                across = np.array([math.cos(yaw), math.sin(yaw), 0.0])
                for k in range(number):
                    self._add(category, asset_id, place + (k - (number - 1) / 2) * step * across + (0, 0, self.floor), yaw)

    # -- furniture ---------------------------------------------------------------------------------------------------

    def _load(self, surfaces: SurfacePlacement, number: int, support: Placement) -> None:
        for category, expected in cards()[support.category].holds.items():
            for _ in range(self._draw_count(expected)):
                asset_id = self._pick_asset(category, self.library.rows[support.asset_id]["style"])
                if not asset_id:
                    break
                facing, centred, backed = (way in cards()[category].lies for way in ("facing", "centred", "backed"))
                place = surfaces.lay(self.rng, self.library[asset_id], number, facing=facing, centred=centred, backed=backed)
                if place is not None:
                    self._add(category, asset_id, *place, support=support.object_id)


def lay_rug(
    polygon: Floats, size: Floats, places: Sequence[tuple[float, float, float]], clear: Sequence[Placement]
) -> tuple[Floats, float, Floats] | None:
    """Return position (2,) [m], yaw [rad] and scale (3,) of a rug of `size` (3,) [m] at the first place that takes it, there as large as it can; None for none.

    `places` are middles and directions (x, y, yaw); the rug stays within the room and off the furniture `clear`.
    """
    blocked = [p.footprint() for p in clear]
    for x, y, yaw in places:
        for share in SHARES:
            half, middle = share * size[:2] / 2, np.array([x, y])
            outline = rectangle(half, middle, yaw)
            if excess(rectangle(half + EDGE, middle, yaw), polygon) <= 1e-6 and all(gap(outline, other) > 0 for other in blocked):
                return middle, yaw, np.array([share, share, THICK / size[2]])
    return None
