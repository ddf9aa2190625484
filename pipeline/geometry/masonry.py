"""The building as what things bump into and stand on: as few convex solids as may be.

Rooms are shown one by one, but to an engine a storey has one floor, a ceiling per height, and walls whose lintels run on through the
wall between them. A window is wall: it does not open, and nothing stands in it. Solids may overlap: nothing of them moves.
"""

import functools
from collections.abc import Callable, Iterator, Sequence

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import Polygon

from pipeline.arrays import Floats
from pipeline.entities.plan import Plan
from pipeline.geometry.tiling import convex_cover, convex_pieces
from pipeline.geometry.walls import SLAB, Cut, Prism, Shell

EVEN = 1e-3  # [m] within which lintels run on, and floors and ceilings cover


def masonry(plan: Plan, level: int, built: Shell) -> list[Prism]:
    """Return all solids of a storey [m above its floor]: walls, lintels, what is below an opening, its floor, its ceilings."""
    windows = [Polygon(cut.quad) for cut in built.cuts if cut.opening.kind == "window"]
    others = [cut for cut in built.cuts if cut.opening.kind != "window"]
    prisms = [Prism("wall", piece, 0.0, built.top) for piece in convex_cover(_whole(shapely.union_all([built.region, *windows])))]
    prisms += _bands("lintel", [cut for cut in others if built.top - cut.top > EVEN], built, lambda cut: (cut.top, built.top))
    prisms += _bands("sill", [cut for cut in others if cut.bottom > EVEN], built, lambda cut: (0.0, cut.bottom))
    return [*prisms, *_floor(plan, level, built), *_ceilings(plan, level)]


def _bands(kind: str, cuts: Sequence[Cut], built: Shell, heights: Callable[[Cut], tuple[float, float]]) -> Iterator[Prism]:
    """Yield what bridges openings: one solid for those of a wall line between the same heights, where the wall between them is solid."""
    groups: dict[tuple[float, ...], list[Cut]] = {}
    for cut in cuts:
        groups.setdefault((*np.round(heights(cut), 4), *_line(cut)), []).append(cut)
    for group in groups.values():
        bottom, top = heights(group[0])
        along = group[0].quad[1] - group[0].quad[0]
        group.sort(key=lambda cut: float(cut.quad.mean(axis=0) @ along))
        run = group[0].quad
        for cut in group[1:]:
            around = shapely.minimum_rotated_rectangle(shapely.convex_hull(shapely.MultiPoint(np.concatenate([run, cut.quad]))))
            longer = np.asarray(shapely.geometry.polygon.orient(around).exterior.coords)[:-1]
            if _solid(longer, bottom, top, built):
                run = longer
            else:
                yield Prism(kind, run, bottom, top)  # type: ignore[arg-type]
                run = cut.quad
        yield Prism(kind, run, bottom, top)  # type: ignore[arg-type]


def _line(cut: Cut) -> tuple[float, ...]:
    """Return the wall that an opening is in: its direction, whichever way it is told, and where its two faces are."""
    along = cut.quad[1] - cut.quad[0]
    along = along / float(np.linalg.norm(along))
    if (round(float(along[0]), 6), along[1]) < (0.0, 0.0):
        along = -along
    across = cut.quad @ np.array([-along[1], along[0]])
    return tuple(np.round([*along, across.min(), across.max()], 4).tolist())


def _solid(quad: Floats, bottom: float, top: float, built: Shell) -> bool:
    """Whether nothing but wall is in the quad (4, 2) between two heights."""
    wall, holes = _wall_between(built, bottom, top)
    around = Polygon(quad)
    return bool(wall.covers(around)) and not bool((shapely.area(shapely.intersection(holes, around)) > EVEN).any())


@functools.lru_cache(16)
def _wall_between(built: Shell, bottom: float, top: float) -> tuple[shapely.Geometry, NDArray[np.object_]]:
    """Return what is wall between two heights, a little wider, and the holes there."""
    quads = np.array([Polygon(cut.quad) for cut in built.cuts], np.object_)
    open_there = np.array(
        [cut.opening.kind != "window" and cut.bottom < top - EVEN and cut.top > bottom + EVEN for cut in built.cuts], np.bool_
    )
    wall = shapely.union_all([built.region, *quads[~open_there]]).buffer(2 * EVEN, join_style="mitre")
    shapely.prepare(wall)
    return wall, quads[open_there]


def _floor(plan: Plan, level: int, built: Shell) -> Iterator[Prism]:
    """Yield the floor slab under all of a storey, walls too, but for shafts from below."""
    shafts = [Polygon(room.polygon) for room in plan.rooms if room.level < level and level in plan.levels_of(room)]
    for piece in convex_pieces(_whole(built.outline.difference(shapely.union_all(shafts)))):
        yield Prism("floor", piece, -SLAB, 0.0)


def _ceilings(plan: Plan, level: int) -> Iterator[Prism]:
    """Yield the ceiling slabs over the rooms whose highest storey this is, one slab for neighbours of the same height."""
    rooms = [room for room in plan.rooms if level in plan.levels_of(room)]
    top = [room for room in rooms if plan.levels_of(room)[-1] == level]
    for height in sorted({round(room.height, 4) for room in top}):
        under = [Polygon(room.polygon) for room in top if round(room.height, 4) == height]
        others = [Polygon(room.polygon) for room in rooms if room not in top or round(room.height, 4) != height]
        walled = shapely.union_all([room.buffer(plan.inner_wall, join_style="mitre") for room in under])
        for piece in convex_pieces(_whole(walled.difference(shapely.union_all(others)))):
            yield Prism("ceiling", piece, height, height + SLAB)


def _whole(region: shapely.Geometry) -> shapely.Geometry:
    """Return a region without films between rooms."""
    return shapely.set_precision(region.buffer(EVEN, join_style="mitre").buffer(-EVEN, join_style="mitre"), 1e-5)
