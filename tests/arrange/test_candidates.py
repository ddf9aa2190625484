import math

import numpy as np

from pipeline.arrange.candidates import hides, near_by
from pipeline.arrange.item import make_item
from pipeline.arrange.learnt_relations import LearntRelations
from pipeline.arrange.settings import SeparateSettings
from pipeline.arrange.walls import edges
from pipeline.relations.model import relations
from tests.arrange.known import drafted, wall
from tests.geometry.furniture import block, one_room
from tests.judging import site

MIRROR = block("mirror", "mirror", (0.6, 0.04, 0.8))


def test_what_hangs_pays_for_a_door_only_at_the_wall_that_has_it():
    """Its back turned to the wall of the entrance: at that wall there is nothing to hang on, in the room's middle it costs nothing."""
    room = site(one_room(np.array([[0.0, 0.0], [5.0, 0.0], [5.0, 4.0], [0.0, 4.0]])))
    item = make_item(drafted(MIRROR, 0.75, 2.0, math.pi, z=1.4), {"mirror": MIRROR}, LearntRelations(relations([], [wall("mirror")])), 0.5)
    walls = edges(room)
    middle, door = np.array([0.75, 2.0, 1.4, math.pi]), np.array([0.75, 0.03, 1.4, math.pi])
    assert not hides(item, middle, walls)
    assert hides(item, door, walls)
    _, costs = near_by(item, middle, walls, np.zeros((0, 4, 2)), room, SeparateSettings())
    assert not np.isnan(costs).any()
    assert (np.diff(costs) >= 0).all()
