import math

import numpy as np
import torch

from pipeline import seeds
from pipeline.diffusion.codec import CONTINUOUS, YAW, Codec, Normalisation
from pipeline.diffusion.rooms import stacked_rows
from tests.diffusion.small_world import CLASSES, make_context


def test_rows_survive_the_round_trip(examples, norm):
    codec = Codec(norm)
    rows = torch.from_numpy(stacked_rows(examples)).float()
    torch.testing.assert_close(codec.metric(codec.normalised(rows)), rows, atol=1e-5, rtol=1e-5)
    torch.testing.assert_close(codec.metric(codec.normalised(rows)[:, :8]), rows[:, :8], atol=1e-5, rtol=1e-5)


def test_channels_have_unit_variance(examples, norm):
    x = Codec(norm).normalised(torch.from_numpy(stacked_rows(examples)).float())
    torch.testing.assert_close((x[:, :2] ** 2).mean(), torch.tensor(1.0), atol=1e-3, rtol=0)
    assert float(x[:, 2:6].std(0).max()) < 1.05
    assert norm.scale[0] == norm.scale[1]


def test_the_constants_survive_json(norm):
    from dataclasses import asdict
    from json import dumps, loads

    assert Normalisation.of_json(loads(dumps(asdict(norm)))) == norm


def test_proposals_are_what_was_encoded(examples, norm):
    codec, context = Codec(norm), make_context(0)
    example = examples[0]
    n = len(example.classes)
    classes = torch.full((24,), codec.classes)
    classes[2 : 2 + n] = torch.from_numpy(example.classes)
    x = torch.zeros(24, CONTINUOUS)
    x[2 : 2 + n] = codec.normalised(torch.from_numpy(example.continuous).float())
    found = codec.proposals(torch.cat([x, codec.one_hot(classes)], -1), context)
    assert [p.category for p in found] == [CLASSES[c] for c in example.classes]
    for proposal, row in zip(found, example.continuous, strict=True):
        np.testing.assert_allclose(proposal.position, row[:3] + np.array([*context.centre, 0]), atol=1e-4)
        np.testing.assert_allclose(proposal.size, row[3:6], atol=1e-4)
        assert math.isclose(math.cos(proposal.yaw - math.atan2(row[YAW][1], row[YAW][0])), 1, abs_tol=1e-6)


def test_the_elevation_of_the_storey_is_added(examples, norm):
    from dataclasses import replace

    codec, context = Codec(norm), make_context(0)
    x = torch.cat([torch.zeros(1, CONTINUOUS), codec.one_hot(torch.tensor([0]))], -1)
    low, high = (codec.proposals(x, replace(context, elevation=z))[0].position for z in (0.0, 3.0))
    np.testing.assert_allclose(high - low, [0, 0, 3])


def test_the_evidence_is_the_posterior_under_a_flat_prior(norm):
    codec = Codec(norm)
    rng = seeds.generator(1, "evidence")
    ideal = codec.one_hot(torch.arange(codec.classes + 1))
    for alpha in (0.3, 0.8, 0.98):
        sigma = math.sqrt(1 - alpha**2)
        x = alpha * ideal[2] + sigma * torch.from_numpy(rng.standard_normal(codec.classes + 1)).float()
        wanted = torch.softmax(-((x - alpha * ideal) ** 2).sum(-1) / (2 * sigma**2), 0)
        found = codec.evidence(x, torch.tensor(alpha), torch.tensor(sigma)).softmax(-1)
        torch.testing.assert_close(found, wanted, atol=1e-5, rtol=1e-4)


def test_a_slot_is_occupied_where_its_empty_channel_is_low(norm):
    codec = Codec(norm)
    block = codec.one_hot(torch.tensor([0, codec.classes]))
    assert codec.occupied(block).tolist() == [True, False]
