import math
from dataclasses import asdict, replace
from json import dumps, loads

import numpy as np
import torch

from pipeline import params
from pipeline.diffusion.codec import CHANNELS, SIZE, YAW, Codec, Normalisation
from pipeline.diffusion.rooms import stacked
from tests.diffusion.small_world import CLASSES, make_context


def rows_of(examples):
    rows, classes = stacked(examples)
    return torch.from_numpy(rows).float(), torch.from_numpy(classes)


def test_rows_survive_the_round_trip(examples, norm):
    codec, (rows, classes) = Codec(norm), rows_of(examples)
    x = codec.normalise(rows, classes)
    torch.testing.assert_close(codec.metric(x, classes), rows, atol=1e-5, rtol=1e-5)
    torch.testing.assert_close(codec.metric(x[:, :8], classes), rows[:, :8], atol=1e-5, rtol=1e-5)


def test_sizes_are_measured_within_their_class(examples, norm):
    """Beds are larger than nightstands; as channels both lie around 0 with a spread of about 1."""
    codec, (rows, classes) = Codec(norm), rows_of(examples)
    x = codec.normalise(rows, classes)
    torch.testing.assert_close((x[:, :2] ** 2).mean(), torch.tensor(1.0), atol=1e-3, rtol=0)
    for label in range(len(CLASSES)):
        mine = x[classes == label][:, SIZE]
        assert mine.mean(0).abs().max() < 1.2  # few objects, and three of any class count beside them
        assert mine.std(0).max() < 1.3


def test_a_class_without_objects_has_finite_constants(examples):
    found = Normalisation.of(*stacked(examples), (*CLASSES, "unseen"))
    assert np.isfinite(found.mean).all()
    assert np.min(found.scale) > 0


def test_the_constants_survive_json(norm):
    assert params.build(Normalisation, loads(dumps(asdict(norm))), "norm") == norm


def test_proposals_are_what_was_encoded(examples, norm):
    codec, context, example = Codec(norm), make_context(0), examples[0]
    n = len(example.classes)
    classes = torch.full((24,), codec.classes)
    classes[:n] = torch.from_numpy(example.classes)
    x = torch.zeros(24, CHANNELS)
    x[:n] = codec.normalise(torch.from_numpy(example.continuous).float(), classes[:n])
    found = codec.proposals(x, classes, context)
    assert [p.category for p in found] == [CLASSES[c] for c in example.classes]
    for proposal, row in zip(found, example.continuous, strict=True):
        np.testing.assert_allclose(proposal.position, row[:3] + np.array([*context.centre, 0]), atol=1e-4)
        np.testing.assert_allclose(proposal.size, row[3:6], atol=1e-4)
        assert math.isclose(math.cos(proposal.yaw - math.atan2(row[YAW][1], row[YAW][0])), 1, abs_tol=1e-6)


def test_the_elevation_of_the_storey_is_added(norm):
    codec, context = Codec(norm), make_context(0)
    low, high = (
        codec.proposals(torch.zeros(1, CHANNELS), torch.tensor([0]), replace(context, elevation=z))[0].position for z in (0.0, 3.0)
    )
    np.testing.assert_allclose(high - low, [0, 0, 3])
