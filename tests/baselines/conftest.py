import math

import pytest
import torch

from pipeline.baselines.rooms import BaselineSettings, Scaling, furniture, outlines
from tests.diffusion.small_world import CLASSES, make_examples

OPENS = torch.tensor([name in {"nightstand", "wardrobe"} for name in CLASSES])


@pytest.fixture(scope="session")
def settings():
    return BaselineSettings(seconds=math.inf, width=32, layers=2, heads=2, points=16, slots=8, timesteps=100, batch=32, learning_rate=5e-3)


@pytest.fixture(scope="session")
def world(settings):
    """Outlines and furniture of small rooms."""
    examples = make_examples(48)
    rooms = outlines([e.floor for e in examples], [e.layout for e in examples], settings.points)
    return rooms, furniture(examples, len(CLASSES), settings.slots)


@pytest.fixture(scope="session")
def scaling(world):
    return Scaling.of(world[1], CLASSES)
