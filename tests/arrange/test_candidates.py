import math

import numpy as np
import pytest

from pipeline.arrange.candidates import hides, near_by
from pipeline.arrange.item import make_item
from pipeline.arrange.learnt_relations import LearntRelations
from pipeline.arrange.settings import SeparateSettings
from pipeline.relations.model import relations
from tests.arrange.known import drafted, wall
from tests.geometry.furniture import block, one_room
from tests.judging import site

MIRROR = block("mirror", "mirror", (0.6, 0.04, 0.8))


def test_what_hangs_pays_for_a_door_only_at_the_wall_that_has_it():
    """Its back turned to the wall of the entrance: at that wall there is nothing to hang on, in the room's middle it costs nothing."""
    room = site(one_room(np.array([[0.0, 0.0], [5.0, 0.0], [5.0, 4.0], [0.0, 4.0]])))
    item = make_item(drafted(MIRROR, 0.75, 2.0, math.pi, z=1.4), {"mirror": MIRROR}, LearntRelations(relations([], [wall("mirror")])), 0.5)
    middle, door = np.array([0.75, 2.0, 1.4, math.pi]), np.array([0.75, 0.03, 1.4, math.pi])
    assert not hides(item, middle, room)
    assert hides(item, door, room)
    _, costs = near_by(item, middle, np.zeros((0, 4, 2)), room, SeparateSettings())
    assert not np.isnan(costs).any()
    assert (np.diff(costs) >= 0).all()


@pytest.mark.parametrize(("share", "walls_first"), [(0.98, 2.5), (0.6, 0.5)])
def test_what_belongs_to_a_wall_goes_to_a_wall_across_the_room_before_it_stands_free(share, walls_first):
    closet = block("closet", "wardrobe", (1.0, 0.6, 2.0))
    room = site(one_room(np.array([[0.0, 0.0], [5.0, 0.0], [5.0, 4.0], [0.0, 4.0]])))
    target = np.array([4.5, 3.68, 0.0, 0.0])
    learnt = LearntRelations(relations([], [wall("wardrobe", share)]))
    item = make_item(drafted(closet, *target[:2]), {"closet": closet}, learnt, 0.5)
    poses, _ = near_by(item, target, np.zeros((0, 4, 2)), room, SeparateSettings())
    depth = np.column_stack([poses[:, 0], 5.0 - poses[:, 0], poses[:, 1], 4.0 - poses[:, 1]]).min(1)
    backed = depth < 0.33
    first = int(np.argmin(backed))
    assert not backed[first]
    far = np.linalg.norm(poses[backed, :2] - target[:2], axis=1)
    nearer = np.linalg.norm(poses[:first, :2] - target[:2], axis=1).max()
    assert nearer > walls_first
    assert far.max() > nearer
