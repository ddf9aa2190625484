import numpy as np
import torch

from pipeline.diffusion.articulated_collision import Furniture, Obstacles, articulated_collision
from pipeline.diffusion.batch import Objects, bucket_of, collate, moved_objects, moved_rooms, reflections
from pipeline.diffusion.codec import Codec
from pipeline.diffusion.relations import boxes_of, pair_relations, wall_relations
from pipeline.diffusion.set_transformer import polygon_area
from tests.diffusion.small_world import make_context


def batch(examples, norm):
    codec = Codec(norm)
    return (codec, *collate(examples, codec, 24))


def turns(count, seed):
    """Any orthogonal matrices: the net's training draws reflections alone, the maps must hold for all."""
    angle = torch.rand(count, generator=torch.Generator().manual_seed(seed)) * 6.28
    cos, sin = angle.cos(), angle.sin()
    turn = torch.stack([torch.stack([cos, -sin], -1), torch.stack([sin, cos], -1)], -2)
    return turn @ reflections(torch.Generator().manual_seed(seed), count)


def test_half_of_the_reflections_reflect():
    found = torch.linalg.det(reflections(torch.Generator().manual_seed(0), 400))
    assert set(found.tolist()) == {-1.0, 1.0}
    assert 150 < int((found < 0).sum()) < 250


def test_rooms_are_padded_to_the_next_bucket():
    assert bucket_of(np.array([1, 4, 5, 12, 13, 24])).tolist() == [4, 4, 8, 12, 16, 24]


def test_a_motion_and_its_inverse_give_the_room_back(examples, norm):
    _, rooms, objects = batch(examples, norm)
    m = turns(len(rooms), 1)
    back = m.transpose(1, 2)
    again = moved_rooms(moved_rooms(rooms, m), back)
    torch.testing.assert_close(again.ends, rooms.ends, atol=1e-5, rtol=0)
    torch.testing.assert_close(again.normal, rooms.normal, atol=1e-5, rtol=0)
    assert torch.equal(again.hinge, rooms.hinge)
    objects_again = moved_objects(moved_objects(objects, m), back)
    torch.testing.assert_close(objects_again.channels, objects.channels, atol=1e-5, rtol=0)
    torch.testing.assert_close(objects_again.sweeps, objects.sweeps, equal_nan=True)


def test_a_moved_room_is_the_same_room(examples, norm):
    """Areas, collisions and the geometry of every pair do not change when a room is turned or mirrored."""
    codec, rooms, objects = batch(examples, norm)
    m = turns(len(rooms), 2)
    moved, shifted = moved_rooms(rooms, m), moved_objects(objects, m)
    torch.testing.assert_close(polygon_area(moved), polygon_area(rooms))
    assert (polygon_area(rooms) > 0).all()
    occupied = objects.classes < codec.classes
    here, there = (boxes_of(codec.metric(o.channels, objects.classes)) for o in (objects, shifted))
    before, after = (
        articulated_collision(
            codec.metric(o.channels, o.classes)[..., :8].numpy(), Furniture.of(occupied.numpy(), o.sweeps.double().numpy()), Obstacles.of(r)
        )[0]
        for o, r in ((objects, rooms), (shifted, moved))
    )
    np.testing.assert_allclose(before, after, atol=1e-4, rtol=1e-4)
    gaps, distances = slice(8, 16), slice(0, 4)
    mask = occupied[:, :, None] & occupied[:, None]
    blur = torch.ones(len(rooms), 2)
    torch.testing.assert_close(
        pair_relations(here, blur).far[..., gaps][mask], pair_relations(there, blur).far[..., gaps][mask], atol=1e-4, rtol=0
    )
    seen = occupied[:, :, None] & rooms.mask[:, None]
    torch.testing.assert_close(
        wall_relations(here, rooms, blur).far[..., distances][seen],
        wall_relations(there, moved, blur).far[..., distances][seen],
        atol=1e-4,
        rtol=0,
    )


def test_normals_point_into_the_room(examples, norm):
    _, rooms, _ = batch(examples, norm)
    inside = rooms.ends.mean(2) + 0.05 * rooms.normal
    outside = rooms.ends.mean(2) - 0.05 * rooms.normal
    assert (inside.abs() <= outside.abs().amax(1, keepdim=True) + 1e-6)[rooms.mask].all()
    assert ((inside.norm(dim=-1) < outside.norm(dim=-1)) | ~rooms.mask).all()


def test_trimming_keeps_every_token(examples, norm):
    _, rooms, _ = batch(examples, norm)
    short = rooms.trimmed()
    assert short.mask.shape[1] == 6  # four walls, a door, a window
    assert torch.equal(short.mask.sum(1), rooms.mask.sum(1))
    torch.testing.assert_close(polygon_area(short), polygon_area(rooms))


def test_a_door_is_on_its_wall_and_keeps_its_hinge():
    from pipeline.diffusion.context import KINDS, floor_tokens

    context = make_context(0)
    floor = floor_tokens(context)
    door = int((floor.kind == KINDS.index("door")).nonzero()[0][0])
    bottom = context.polygon[:, 1].min() - context.centre[1]
    assert abs(floor.ends[door][:, 1] - bottom).max() < 1e-6
    assert floor.normal[door].tolist() == [0, 1]
    hinge = floor.ends[door][floor.hinge[door]] + context.centre
    assert abs(hinge[0] - context.openings[0].segment[0][0]) < 1e-6


def test_objects_take_rows(examples, norm):
    _, _, objects = batch(examples, norm)
    part = objects.rows(torch.tensor([3, 1]))
    assert isinstance(part, Objects)
    assert torch.equal(part.classes[0], objects.classes[3])
