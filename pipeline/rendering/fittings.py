"""Room doors and windows as assets, made to measure for their openings.

Fitting frame: x along the opening, z up from the floor, y to the left of x; a door's origin is the foot of its hinge.
"""

import itertools
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pipeline.entities.asset import Asset, Joint, Mesh
from pipeline.geometry.walls import LEAF_GAP, LEAF_THICKNESS, Cut, Leaf
from pipeline.rendering.boxes import box, join_meshes, solid_link
from pipeline.rendering.palette import ENTRANCE_LEAF, GLASS, JAMB, LEAF, METAL, WINDOW_FRAME

LINING = 0.003  # thickness of the door frame's lining, inside the gap around the leaf [m]
CASING = (0.06, 0.012)  # width and thickness of the trim around a door [m]
SEAM = 1e-4  # between its boards [m]
HANDLE_HEIGHT = 1.02  # [m]
PART = "line_fixed_handle"  # what its handle is in GAPartNet's words
LEAF_DENSITY = 320.0  # hollow-core door [kg/m3]


Size = tuple[float, ...]


def door(leaf: Leaf, *, entrance: bool) -> tuple[Asset, NDArray[np.float64], float]:
    """Make the door of an opening: an asset in the fitting frame, its position (2,) [m] and yaw [rad]."""
    return door_of(door_size(leaf), entrance=entrance), leaf.hinge, float(np.arctan2(leaf.along[1], leaf.along[0]))


def door_size(leaf: Leaf) -> Size:
    """Return all that a door's shape depends on, to the micrometre: most doors of most homes are alike."""
    return tuple(round(v, 6) for v in (leaf.turn, leaf.angle, leaf.width, leaf.bottom, leaf.top, leaf.front, leaf.back, leaf.clear))


def door_of(size: Size, *, entrance: bool) -> Asset:
    """Make the door of a size."""
    leaf = Leaf("door", np.zeros(2), np.array([1.0, 0.0]), np.array([0.0, size[0]]), int(size[0]), *size[1:])
    side = leaf.turn  # +1: the room it swings into lies towards +y
    # The lining is 3 mm before walls and lintel, which collide themselves.
    boards = _lining(leaf)
    frame = replace(solid_link("frame", (join_meshes("frame", (*boards, *_casing(leaf))),), boards, 12.0), colliders=())
    panel = _span("leaf", (LEAF_GAP, LEAF_GAP + leaf.width), (-side * LEAF_THICKNESS, 0.0), (leaf.bottom, leaf.top), 1)
    handles, levers = zip(*(_handle(leaf, name) for name in ("front", "back")), strict=True)
    mass = LEAF_DENSITY * leaf.width * LEAF_THICKNESS * (leaf.top - leaf.bottom)
    moving = solid_link("leaf", (panel, *handles), (panel, *levers), mass)
    hinge = Joint("hinge", "revolute", 0, 1, np.array([0.0, 0.0, float(side)]), np.zeros(3), 0.0, leaf.angle, "hinge_door")
    return Asset(
        asset_id="door",
        category="entrance_door" if entrance else "door",
        size=np.array([leaf.clear, leaf.front + leaf.back, leaf.top + LEAF_GAP]),
        links=(frame, moving),
        joints=(hinge,),
        materials=(JAMB, ENTRANCE_LEAF if entrance else LEAF, METAL),
        source="fitting",
        source_id="door",
        licence="Apache-2.0",
    )


def window(cut: Cut) -> tuple[Asset, NDArray[np.float64], float]:
    """Make the window of an opening: frame, mullion, glass; static, to look at: the wall about it collides. Position and yaw as for a door."""
    return window_of(window_size(cut)), *window_pose(cut)


def window_pose(cut: Cut) -> tuple[NDArray[np.float64], float]:
    """Return where a window begins, on its wall's centre line (2,) [m], and its yaw [rad]."""
    a, b = (cut.quad[0] + cut.quad[3]) / 2, (cut.quad[1] + cut.quad[2]) / 2
    return a, float(np.arctan2(*(b - a)[::-1]))


def window_size(cut: Cut) -> Size:
    """Return width, bottom and top of a window, to the micrometre [m]."""
    across = (cut.quad[1] + cut.quad[2] - cut.quad[0] - cut.quad[3]) / 2
    return round(float(np.linalg.norm(across)), 6), round(cut.bottom, 6), round(cut.top, 6)


def window_of(size: Size) -> Asset:
    """Make the window of a size."""
    (width, z0, z1), bar, depth = size, 0.05, 0.035
    panes = max(1, round(width / 0.8))
    edges = np.linspace(bar / 2, width - bar / 2, panes + 1)
    bars = (
        *(box("side", (x, -depth, z0), (x + bar, depth, z1)) for x in (0, width - bar)),
        *(box("rail", (bar + SEAM, -depth, z), (width - bar - SEAM, depth, z + bar)) for z in (z0, z1 - bar)),
        *(box("mullion", (x - bar / 2, -depth, z0 + bar + SEAM), (x + bar / 2, depth, z1 - bar - SEAM)) for x in edges[1:-1]),
    )
    glass = tuple(box("pane", (x0 + bar / 2, -0.01, z0 + bar), (x1 - bar / 2, 0.01, z1 - bar), 1) for x0, x1 in itertools.pairwise(edges))
    parts = join_meshes("frame", bars), join_meshes("glass", glass)
    return Asset(
        asset_id="window",
        category="window",
        size=np.array([width, 2 * depth, z1]),
        links=(replace(solid_link("frame", parts, (*bars, *glass), 30.0), colliders=()),),
        joints=(),
        materials=(WINDOW_FRAME, GLASS),
        source="fitting",
        source_id="window",
        licence="Apache-2.0",
    )


def _span(name: str, x: tuple[float, float], y: tuple[float, float], z: tuple[float, float], material: int, part: str = "") -> Mesh:
    """Make a box from unordered ranges."""
    low, high = (min(x), min(y), min(z)), (max(x), max(y), max(z))
    return box(name, low, high, material, part)


def _lining(leaf: Leaf) -> tuple[Mesh, ...]:
    """Line the hole: boards of LINING, whose inner faces leave the leaf its way."""
    y = (-leaf.turn * leaf.back, leaf.turn * leaf.front)
    top = leaf.top + LEAF_GAP
    return (
        _span("hinge", (0, LINING), y, (0, top), 0),
        _span("lock", (leaf.clear - LINING, leaf.clear), y, (0, top), 0),
        _span("top", (LINING + SEAM, leaf.clear - LINING - SEAM), y, (top - LINING, top), 0),
    )


def _casing(leaf: Leaf) -> tuple[Mesh, ...]:
    """Make the trim on both faces of the wall; to look at only, so that furniture may stand against it."""
    wide, thick = CASING
    top = leaf.top + LEAF_GAP
    parts: list[Mesh] = []
    for face, out in ((leaf.turn * leaf.front, leaf.turn), (-leaf.turn * leaf.back, -leaf.turn)):
        y = (face + out * SEAM, face + out * thick)
        parts += (
            _span("hinge", (-wide, 0), y, (0, top + wide), 0),
            _span("lock", (leaf.clear, leaf.clear + wide), y, (0, top + wide), 0),
            _span("top", (SEAM, leaf.clear - SEAM), y, (top, top + wide), 0),
        )
    return tuple(parts)


def _handle(leaf: Leaf, side: str) -> tuple[Mesh, Mesh]:
    """Make the handle of a face ("front" is where the leaf swings to), near the lock edge, pointing to the hinge; and its lever alone, which a hand presses."""
    x, z = leaf.width - 0.055, leaf.bottom + HANDLE_HEIGHT
    face, out = (0.0, leaf.turn) if side == "front" else (-leaf.turn * LEAF_THICKNESS, -leaf.turn)
    height = (z - 0.01, z + 0.01)
    neck = _span("neck", (x - 0.01, x + 0.01 - SEAM), (face, face + out * (0.045 - SEAM)), height, 2)
    lever = _span(f"handle_{side}_lever", (x - 0.12, x + 0.01), (face + out * 0.045, face + out * 0.06), height, 2, PART)
    return replace(join_meshes(f"handle_{side}", (neck, lever)), part=PART), lever
