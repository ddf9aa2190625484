import numpy as np
import pytest
import torch

from pipeline import seeds
from pipeline.diffusion.poses import (
    BACK,
    CORNER,
    FREE,
    POSES,
    SIDE,
    TURNED,
    UNTOLD,
    PoseModel,
    draw_poses,
    fit_poses,
    pose_classes,
    pose_weights,
)
from pipeline.relations.arrangement import make_arrangement
from tests.diffusion.small_world import CLASSES

SQUARE = [[0, 0], [4, 0], [4, 3], [0, 3]]
FEATURES, BED, CHAIR, PADDING = 3, 0, 1, 2


def stand(*things, polygon=SQUARE):
    return [
        POSES[p]
        for p in pose_classes(make_arrangement("r", "bedroom", polygon, [("x", (x, y, 0), yaw, size) for x, y, yaw, size in things]))
    ]


@pytest.mark.parametrize(
    ("thing", "pose"),
    [
        ((2.0, 1.5, 0.0, (1, 1, 1)), "free"),
        ((2.0, 1.5, 0.3, (1, 1, 1)), "turned"),
        ((2.0, 1.5, 0.03, (1, 1, 1)), "free"),
        ((2.0, 2.45, 0.0, (1, 1, 1)), "back"),
        ((2.0, 0.52, np.pi, (1, 1, 1)), "back"),
        ((3.45, 2.45, 0.0, (1, 1, 1)), "corner"),
        ((0.5, 2.5, np.pi / 2, (1, 1, 1)), "corner"),
        ((2.0, 2.5, np.pi / 2, (1, 1, 1)), "side"),
        ((3.45, 1.5, 0.0, (1, 1, 1)), "side"),
        ((2.0, 0.5, 0.0, (1, 1, 1)), "side"),
        ((2.0, 2.39, 0.0, (1, 1, 1)), "free"),
    ],
)
def test_a_pose_says_which_sides_are_at_walls(thing, pose):
    assert stand(thing) == [pose]


def test_poses_do_not_hang_on_how_the_room_is_turned_or_mirrored():
    things = [(2.0, 2.45, 0.0, (1.5, 1, 1)), (3.7, 2.7, 0.0, (0.5, 0.5, 1)), (1.0, 1.0, 0.4, (0.5, 0.5, 1)), (0.3, 0.8, 0.0, (0.5, 0.5, 1))]
    plain = stand(*things)
    assert plain == ["back", "corner", "turned", "side"]
    c, s = np.cos(0.7), np.sin(0.7)
    turn = np.array([[c, -s], [s, c]])
    moved = [(*(turn @ t[:2]), t[2] + 0.7, t[3]) for t in things]
    assert stand(*moved, polygon=np.array(SQUARE) @ turn.T) == plain
    mirrored = [(-x, y, -yaw, size) for x, y, yaw, size in things]
    assert stand(*mirrored, polygon=[[-x, y] for x, y in SQUARE[::-1]]) == plain


def test_an_empty_room_has_none():
    assert stand() == []


@pytest.fixture(scope="module")
def rooms():
    """Two beds and a chair each: one bed in a corner and the other not; a bed comes in a corner where the room's first feature says so. Chairs: a third turned."""
    rng = seeds.generator(0, "pose-rooms")
    features = rng.standard_normal((4000, FEATURES)).astype(np.float32)
    first = np.where(features[:, 0] > 0, CORNER, BACK)
    chair = np.where(rng.random(4000) < 1 / 3, TURNED, FREE)
    poses = np.stack([first, np.where(first == CORNER, BACK, CORNER), chair, np.full(4000, UNTOLD)], 1)
    classes = np.tile([BED, BED, CHAIR, PADDING], (4000, 1))
    return tuple(torch.from_numpy(v) for v in (features, np.zeros(4000, np.int64), classes, poses))


@pytest.fixture(scope="module")
def net(rooms):
    torch.manual_seed(0)
    made = PoseModel(2, 1, FEATURES, 16)
    made.learn_shares(*rooms[1:])
    fit_poses(made, rooms, 300, 256, 1e-2, 0)
    return made.eval()


def draw(net, rooms, seed=0):
    features, layouts, classes, _ = rooms
    return draw_poses(net, features, layouts, classes, seeds.generator(seed, "draws").random(classes.shape)).numpy()


def test_what_is_learnt_is_drawn(net, rooms):
    drawn, real = draw(net, rooms), rooms[3].numpy()
    sure = np.abs(rooms[0][:, 0].numpy()) > 0.3
    assert (drawn[sure, 0] == real[sure, 0]).mean() > 0.95  # the room says
    assert (drawn[:, 0] != drawn[:, 1]).mean() > 0.95  # the bed before says
    assert set(drawn[:, 2]) == {FREE, TURNED}
    assert abs((drawn[:, 2] == TURNED).mean() - 1 / 3) < 0.04  # nothing says: the rate is kept
    assert (drawn[:, 3] == UNTOLD).all()


def test_a_new_model_knows_the_shares(rooms):
    made = PoseModel(2, 1, FEATURES, 16)
    made.learn_shares(*rooms[1:])
    share = made.own[CHAIR, 0].softmax(-1).detach().numpy()
    assert abs(share[TURNED] - 1 / 3) < 0.03
    assert share[[UNTOLD, BACK, CORNER, SIDE]].max() < 0.01


def test_what_cannot_be_known_is_not_learnt_by_heart(rooms):
    features, layouts, classes, poses = (part[:120] for part in rooms)
    poses = poses[torch.randperm(120, generator=torch.Generator().manual_seed(3))]  # nothing tells which room is which
    made, shares = PoseModel(2, 1, FEATURES, 64), PoseModel(2, 1, FEATURES, 64)
    for net in (made, shares):
        net.learn_shares(layouts, classes, poses)
    fit_poses(made, (features, layouts, classes, poses), 400, 64, 1e-2, 0)
    others = tuple(part[2000:] for part in rooms)
    assert -made(*others).mean() < -shares(*others).mean() + 0.2


def test_draws_hang_on_their_numbers_alone(net, rooms):
    assert (draw(net, rooms) == draw(net, rooms)).all()
    assert (draw(net, rooms) != draw(net, rooms, 1)).any()
    padded = (*rooms[:2], torch.nn.functional.pad(rooms[2], (0, 3), value=PADDING), rooms[3])
    uniform = seeds.generator(0, "draws").random(rooms[2].shape)
    wide = draw_poses(net, *padded[:3], np.pad(uniform, ((0, 0), (0, 3)))).numpy()
    assert (wide[:, :4] == draw(net, rooms)).all()
    assert (wide[:, 4:] == UNTOLD).all()


def test_padding_is_not_likely_or_unlikely(net, rooms):
    features, layouts, classes, poses = rooms
    wide = net(features, layouts, torch.nn.functional.pad(classes, (0, 2), value=PADDING), torch.nn.functional.pad(poses, (0, 2)))
    torch.testing.assert_close(wide, net(*rooms))


def test_rooms_of_training_are_told_how_their_objects_stand(examples):
    poses = {name: set() for name in ("double_bed", "nightstand", "dining_chair", "pendant_lamp")}
    for e in examples:
        assert len(e.poses) == len(e.classes)
        for c, p in zip(e.classes, e.poses, strict=True):
            if CLASSES[c] in poses:
                poses[CLASSES[c]].add(int(p))
    assert poses["double_bed"] <= {BACK, CORNER}
    assert poses["pendant_lamp"] == {FREE}


def test_the_rarer_a_pose_is_in_its_class_the_more_its_errors_weigh():
    classes = torch.tensor([[BED] * 8 + [CHAIR] * 2 + [PADDING] * 2])
    poses = torch.tensor([[BACK] * 6 + [CORNER] * 2 + [FREE] * 2 + [UNTOLD] * 2])
    weights = pose_weights(classes, poses, PADDING)
    assert weights.shape == classes.shape
    beds, chairs = weights[0, :8], weights[0, 8:10]
    assert float(beds[7] / beds[0]) == pytest.approx((6 / 2) ** 0.5, rel=1e-5)
    assert float(beds.mean()) == pytest.approx(1.0, rel=1e-5)
    assert chairs.tolist() == pytest.approx([1.0, 1.0])
