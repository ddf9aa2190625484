from dataclasses import replace

import pytest
import torch

from pipeline.baselines import weights
from pipeline.baselines.atiss import Autoregressive, loss
from pipeline.baselines.training import Trainer, train
from pipeline.errors import ContentError
from tests.diffusion.small_world import LAYOUTS


@pytest.fixture
def fresh(scaling, settings):
    def made(**over):
        torch.manual_seed(0)
        s = replace(settings, batch=4, **over)
        return Trainer("toy", Autoregressive(scaling, len(LAYOUTS), s), loss, s, 0)

    return made


def test_training_ends_when_the_seconds_are_spent_and_saves(fresh, world):
    saved = []
    trainer = fresh(seconds=0.3, checkpoint_every=0.1)
    steps = list(train(trainer, *world, torch.ones(len(world[0])), lambda t: saved.append(t.spent)))
    assert steps[-1].spent >= 0.3 > steps[-2].spent
    assert saved[-1] == steps[-1].spent
    assert len(saved) >= 2
    assert list(train(trainer, *world, torch.ones(len(world[0])))) == []


def test_a_restored_run_goes_on_as_if_it_had_not_ended(fresh, world, scaling, tmp_path):
    path, chances = tmp_path / "toy.safetensors", torch.ones(len(world[0]))
    one = fresh(seconds=1e9)  # so the rate hangs on the clock no more
    for _ in range(3):
        one.step(*world, chances)
    weights.write(path, "digest", one, scaling)
    other = fresh(seconds=1e9)
    assert weights.restore(path, "digest", other)
    assert (other.done, other.spent) == (one.done, one.spent)
    assert one.step(*world, chances).loss == other.step(*world, chances).loss
    for a, b in zip(one.average.parameters(), other.average.parameters(), strict=True):
        torch.testing.assert_close(a, b, atol=1e-6, rtol=1e-5)


def test_other_data_start_afresh_and_damage_is_told(fresh, scaling, tmp_path):
    path, trainer = tmp_path / "toy.safetensors", fresh()
    assert not weights.restore(path, "digest", trainer)
    weights.write(path, "digest", trainer, scaling)
    assert not weights.restore(path, "another", trainer)
    path.write_bytes(path.read_bytes()[:100])
    with pytest.raises(ContentError, match="cannot read"):
        weights.restore(path, "digest", trainer)
