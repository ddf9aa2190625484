from dataclasses import replace

import numpy as np
import pytest
import torch

from pipeline.diffusion.checkpoint import Header, build_net, save_weights
from pipeline.diffusion.context import Demand
from pipeline.diffusion.sampling import Sampler
from pipeline.diffusion.settings import ModelSettings, SampleSettings
from pipeline.errors import ContentError
from tests.diffusion.small_world import LAYOUTS, make_context

FEW = {"steps_coarse": 4, "steps_middle": 10, "steps_fine": 10, "batch": 4}


class Shelf:
    """A library in which everything is 0.5 m wide and opens to the front."""

    def lookup(self, categories, sizes, latents):
        assert sizes.shape == (*np.shape(categories), 3)
        placed = np.full_like(sizes, 0.5)
        sweeps = np.full((*sizes.shape[:2], 1, 2, 3), np.nan, np.float32)
        sweeps[..., 0, :, :] = [[-0.25, -0.6, 0.0], [0.25, -0.25, 0.5]]
        return placed, sweeps


@pytest.fixture(scope="module")
def weights(norm, tmp_path_factory):
    path = tmp_path_factory.mktemp("weights") / "denoiser.safetensors"
    header = Header(norm, LAYOUTS, 24, 1000, ModelSettings(32, 1, 4, 8))
    torch.manual_seed(0)
    net = build_net(header)
    with torch.no_grad():
        for p in net.parameters():
            if p.abs().max() == 0:
                p.normal_(0, 0.03)
    save_weights(path, header, dict(net.state_dict()))
    return path


def sampler(weights, library=None, seed=7, **over):
    return Sampler.load(weights, SampleSettings(**{**FEW, **over}), seed, library)


def same(a, b):
    return len(a) == len(b) and all(
        p.category == q.category
        and p.yaw == q.yaw
        and all(np.array_equal(getattr(p, k), getattr(q, k)) for k in ("position", "size", "latent"))
        for p, q in zip(a, b, strict=True)
    )


def test_a_room_does_not_know_who_shares_its_batch(weights):
    s = sampler(weights, Shelf())
    rooms = [make_context(i, n_target=5) for i in range(6)]
    keys = [(i, 0, 0) for i in range(6)]
    together = s.sample_rooms(rooms, keys)
    alone = [s.sample_rooms([r], [k])[0] for r, k in zip(rooms, keys, strict=True)]
    turned = s.sample_rooms(rooms[::-1], keys[::-1])[::-1]
    assert all(map(same, together, alone))
    assert all(map(same, together, turned))


def test_the_key_and_the_seed_decide(weights):
    s, room = sampler(weights), make_context(0)
    one, two, three = s.sample_rooms([room] * 3, [(0, 0, 0), (0, 0, 1), (0, 0, 0)])
    assert same(one, three)
    assert not same(one, two)
    assert not same(one, sampler(weights, seed=8).sample_rooms([room], [(0, 0, 0)])[0])


@pytest.mark.parametrize("count", [0, 5, 16, 24])
def test_the_quantity_guidance_gives_the_exact_count(weights, count):
    """Even with a net that knows nothing and is told nothing: the guidance alone does it."""
    s = sampler(weights, count_condition=False)
    rooms = [make_context(i, n_target=count) for i in range(4)]
    assert [len(p) for p in s.sample_rooms(rooms, [(i, 0, 0) for i in range(4)])] == [count] * 4
    free = s.unguided().sample_rooms(rooms, [(i, 0, 0) for i in range(4)])
    assert any(len(p) != count for p in free)


def test_slots_take_the_size_of_their_asset(weights):
    found = sampler(weights, Shelf()).sample_rooms([make_context(0, n_target=6)], [(0, 0, 0)])[0]
    for proposal in found:
        np.testing.assert_allclose(proposal.size, 0.5, atol=0.02)


def test_the_baseline_ignores_library_and_count(weights):
    s = sampler(weights, Shelf())
    rooms = [make_context(i) for i in range(3)]
    asked = [make_context(i, n_target=9) for i in range(3)]
    keys = [(i, 0, 0) for i in range(3)]
    plain = s.unguided()
    assert all(map(same, plain.sample_rooms(rooms, keys), plain.sample_rooms(asked, keys)))
    assert all(map(same, plain.sample_rooms(rooms, keys), sampler(weights).unguided().sample_rooms(rooms, keys)))


@pytest.mark.parametrize("kind", ["none", "heuristic", "joints"])
def test_every_articulation_samples(weights, kind):
    found = sampler(weights, Shelf(), articulation=kind).sample_rooms([make_context(1, n_target=4)], [(0, 0, 0)])[0]
    for p in found:
        assert np.isfinite(p.position).all()
        assert -np.pi <= p.yaw <= np.pi


def test_the_ancestral_sampler_runs_and_is_keyed(norm, tmp_path):
    header = Header(norm, LAYOUTS, 24, 40, ModelSettings(32, 1, 4, 8))
    torch.manual_seed(0)
    save_weights(tmp_path / "w.safetensors", header, dict(build_net(header).state_dict()))
    s = Sampler.load(tmp_path / "w.safetensors", SampleSettings(sampler="ancestral", batch=2), 0)
    room = make_context(0, n_target=5)
    first, again = (s.sample_rooms([room], [(4, 1, 0)])[0] for _ in range(2))
    assert same(first, again)


def test_an_unknown_room_type_is_named(weights):
    from dataclasses import replace

    with pytest.raises(ContentError, match="'attic'"):
        sampler(weights).sample_rooms([replace(make_context(0), layout_type="attic")], [(0, 0, 0)])


def test_sampling_leaves_torch_s_threads_as_they_were(weights):
    before = torch.get_num_threads()
    sampler(weights).sample_rooms([make_context(0)], [(0, 0, 0)])
    assert torch.get_num_threads() == before


def test_rooms_hold_what_rooms_of_their_type_held_and_what_is_asked_for(weights, norm):
    s = sampler(weights)
    rooms = [make_context(i, n_target=5) for i in range(6)]
    keys = [(i, 0, 0) for i in range(6)]
    few = replace(s, header=replace(s.header, held=((((0,), 9), ((2,), 9)),) * len(LAYOUTS)))
    free = {p.category for room in s.sample_rooms(rooms, keys) for p in room}
    assert not free <= {norm.classes[0], norm.classes[2]}  # else the next line says nothing
    assert {p.category for room in few.sample_rooms(rooms, keys) for p in room} <= {norm.classes[0], norm.classes[2]}
    wish = Demand((norm.classes[1],), least=2)
    asked = few.sample_rooms([replace(room, demands=(wish,)) for room in rooms], keys)
    assert all(sum(p.category == norm.classes[1] for p in room) >= 2 for room in asked)


def test_what_rooms_hold_travels_with_the_weights(weights, tmp_path):
    s = sampler(weights)
    header = replace(s.header, held=((((0,), 1), ((3, 4), 2)), ()))
    save_weights(tmp_path / "d.safetensors", header, dict(s.net.state_dict()))
    assert sampler(tmp_path / "d.safetensors").header == header
