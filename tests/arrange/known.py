"""Relations as training tables would teach them, few and round."""

import math

import numpy as np

from pipeline.arrange import LearntRelations
from pipeline.entities.home import Placement
from pipeline.relations.model import Mode, PairRelation, Span, WallRelation, relations


def farthest(found, wished):
    """How far the object went that was moved farthest [m]; all that was wished is there."""
    return max(float(np.linalg.norm(a.position[:2] - b.position[:2])) for a, b in zip(found.placements, wished, strict=True))


def mode(side, out, along, turn, weight=0.5):
    """`out` (low, middle, high) from touching sides, `along` (reference, low, middle, high), `turn` from the anchor's."""
    return Mode(side, weight, Span("outside", *out), Span(*along), Span("anchor", turn, turn, turn))


def pair(anchor, member, *modes):
    return PairRelation(anchor, member, 100, 0.95, 0.05, modes)


def wall(category, share=0.98):
    return WallRelation(category, "back", 100, share, 0.05, Span("outside", 0.004, 0.01, 0.03), Span("wall", 0.0, 0.0, 0.0))


BESIDE = [mode(side, (0.03, 0.08, 0.15), ("high", 0.0, 0.0, 0.0), 0.0) for side in ("left", "right")]
SEATS = [
    mode(side, (-0.2, -0.1, 0.1), ("share", x - 0.03, x, x + 0.03), turn)
    for side, turn in (("front", math.pi), ("back", 0.0))
    for x in (-0.25, 0.25)
]
BEFORE = mode("front", (0.35, 0.45, 0.6), ("middle", -0.1, 0.0, 0.1), 0.0, 1.0)
OPPOSITE = mode("front", (1.5, 2.4, 3.3), ("middle", -0.1, 0.0, 0.1), math.pi, 1.0)

RELATIONS = relations(
    [
        pair("double_bed", "nightstand", *BESIDE),
        pair("dining_table", "dining_chair", *SEATS),
        pair("multi_seat_sofa", "coffee_table", BEFORE),
        pair("multi_seat_sofa", "tv_stand", OPPOSITE),
    ],
    [
        *(
            wall(name)
            for name in ("double_bed", "nightstand", "wardrobe", "cabinet", "tv_stand", "kitchen_cabinet", "sink_cabinet", "oven")
        ),
        wall("refrigerator"),
        wall("multi_seat_sofa", 0.6),
        wall("dining_table", 0.1),
    ],
)
LORE = LearntRelations(RELATIONS)


def drafted(asset, x, y, yaw=0.0, number=0, z=0.0):
    """A placement of an asset."""
    return Placement(f"{asset.asset_id}_{number}", "room", asset.category, asset.asset_id, np.array([x, y, z]), float(yaw), asset.size)
