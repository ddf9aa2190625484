from dataclasses import replace

import pytest
import torch

from pipeline.baselines.atiss import Autoregressive, loss
from pipeline.baselines.job import Trainer, train
from tests.diffusion.small_world import LAYOUTS


@pytest.fixture
def fresh(scaling, settings):
    def made(**over):
        torch.manual_seed(0)
        s = replace(settings, batch=4, **over)
        return Trainer("toy", Autoregressive(scaling, len(LAYOUTS), s), loss, s, 0)

    return made


def test_training_ends_when_the_seconds_are_spent(fresh, world):
    trainer = fresh(seconds=0.3)
    steps = list(train(trainer, *world, torch.ones(len(world[0]))))
    assert steps[-1].spent >= 0.3 > steps[-2].spent
    assert list(train(trainer, *world, torch.ones(len(world[0])))) == []
