"""The judge's one entry: a home in, its certificate out."""

from collections.abc import Mapping

from pipeline import taxonomy
from pipeline.entities.asset import Asset
from pipeline.entities.home import Home
from pipeline.geometry.walls import levels
from pipeline.verify.bodies import bodies
from pipeline.verify.certificate import Certificate
from pipeline.verify.floors import check_rooms, level_free_space
from pipeline.verify.joints import check_joints, check_leaves
from pipeline.verify.objects import check_objects
from pipeline.verify.settings import VerifySettings
from pipeline.verify.supports import find_supports


def verify_home(home: Home, assets: Mapping[str, Asset], settings: VerifySettings) -> Certificate:
    """Judge one home: every joint swept, every object at rest, every room's floor."""
    home_bodies = bodies(home.placements, assets)
    supports = find_supports(home.placements, home_bodies, settings.float_gap)
    spaces = {level: level_free_space(home, level, home_bodies, settings) for level in levels(home.plan)}
    rooms = check_rooms(home, spaces)
    small = taxonomy.load().small
    return Certificate(
        home.scene_id,
        (*check_joints(home, assets, home_bodies, supports, spaces, settings), *check_leaves(home, home_bodies, spaces, settings)),
        check_objects(home, home_bodies, supports, settings),
        tuple(rooms[room.room_id] for room in home.plan.rooms),
        frozenset(p.object_id for p in home.placements if p.category in small),
    )
