from dataclasses import replace

import pytest
import torch

from pipeline.diffusion.batch import stacked
from pipeline.diffusion.checkpoint import Header, load_checkpoint, load_weights, save_checkpoint, save_weights
from pipeline.diffusion.codec import Codec
from pipeline.diffusion.loss import Levels, constraint_descent, denoising_loss, draw
from pipeline.diffusion.rooms import layout_weights
from pipeline.diffusion.schedule import linear
from pipeline.diffusion.settings import ModelSettings, TrainSettings
from pipeline.diffusion.training import Trainer, train, validation
from pipeline.errors import ContentError
from tests.diffusion.small_world import LAYOUTS, make_examples

CPU = torch.device("cpu")
SETTINGS = TrainSettings(ModelSettings(32, 2, 4, 8), slots=12, steps=6, batch=8, warmup=2, checkpoint_every=3, constraint_below=400)


@pytest.fixture(scope="module")
def header(norm):
    return Header(norm, LAYOUTS, SETTINGS.slots, 1000, SETTINGS.model)


@pytest.fixture(scope="module")
def data(examples, norm):
    return (*stacked(examples, Codec(norm), SETTINGS.slots), layout_weights(examples))


@pytest.fixture(autouse=True)
def one_thread():
    torch.set_num_threads(1)


def trained(header, data, steps):
    trainer = Trainer(0, header, SETTINGS, SETTINGS.steps, 3, CPU)
    for step in train(trainer, *data):
        if step.done == steps:
            break
    return trainer


def same(a, b):
    return all(torch.equal(x, y) for x, y in zip(a.state_dict().values(), b.state_dict().values(), strict=True))


def test_a_resumed_run_equals_an_undisturbed_one_bit_for_bit(header, data, tmp_path):
    whole = trained(header, data, 6)
    path = tmp_path / "checkpoint.safetensors"
    half = trained(header, data, 3)
    save_checkpoint(path, "digest", half.done, half.groups())
    resumed = Trainer(0, header, SETTINGS, SETTINGS.steps, 3, CPU)
    resumed.restore(*load_checkpoint(path, "digest"))
    list(train(resumed, *data))
    assert resumed.done == whole.done == 6
    assert not same(whole.net, half.net)
    assert same(whole.net, resumed.net)
    assert same(whole.average, resumed.average)


def test_a_checkpoint_of_something_else_or_damaged_starts_afresh(header, data, tmp_path):
    path = tmp_path / "checkpoint.safetensors"
    assert load_checkpoint(path, "digest") is None
    save_checkpoint(path, "digest", 1, trained(header, data, 1).groups())
    assert load_checkpoint(path, "digest")[0] == 1
    assert load_checkpoint(path, "other") is None
    path.write_bytes(path.read_bytes()[:1000])
    assert load_checkpoint(path, "digest") is None


def test_checkpoints_are_written_when_due_and_at_the_end(header, data):
    done = []
    list(train(Trainer(0, header, replace(SETTINGS, checkpoint_every=4), 6, 3, CPU), *data, lambda t: done.append(t.done)))
    assert done == [4, 6]


def test_weights_come_back_with_their_header(header, data, tmp_path):
    trainer = trained(header, data, 1)
    save_weights(tmp_path / "w.safetensors", header, dict(trainer.average.state_dict()))
    net, read = load_weights(tmp_path / "w.safetensors")
    assert read == header
    assert same(net, trainer.average)


@pytest.mark.parametrize("spoil", ["missing", "truncated", "vae"])
def test_bad_weights_are_named(header, data, tmp_path, spoil):
    path = tmp_path / "w.safetensors"
    if spoil == "truncated":
        save_weights(path, header, dict(trained(header, data, 1).net.state_dict()))
        path.write_bytes(path.read_bytes()[:500])
    if spoil == "vae":
        save_checkpoint(path, "x", 0, {})
    with pytest.raises(ContentError, match=r"w\.safetensors"):
        load_weights(path)


def test_it_learns(header, data):
    settings = replace(SETTINGS, steps=50, batch=16)
    steps = list(train(Trainer(0, header, settings, 50, 3, CPU), *data))
    early, late = (sum(s.geometry + s.classes for s in part) for part in (steps[:10], steps[-10:]))
    assert late < 0.9 * early


def loss(header, data, settings, sign=1):
    rooms, objects, _ = data
    net = Trainer(0, header, settings, 1, 1, CPU).net
    rng = torch.Generator().manual_seed(0)
    drawn = draw(rng, len(rooms), 12, header.norm.channels, 1000, 0.0, 1.0)
    drawn = drawn._replace(t=torch.full((len(rooms),), 50))
    return denoising_loss(net, Levels.of(linear(), CPU), rooms, objects, drawn, settings)


def test_the_constraint_term_of_eq_1_has_a_switch_and_a_scale(header, data):
    plain = loss(header, data, replace(SETTINGS, constraint=False))
    nothing = loss(header, data, replace(SETTINGS, constraint_scale=0.0))
    guided = loss(header, data, replace(SETTINGS, constraint_scale=1e4))
    torch.testing.assert_close(plain.geometry, nothing.geometry)
    assert not torch.allclose(plain.geometry, guided.geometry)
    torch.testing.assert_close(plain.classes, guided.classes)


def test_g_points_down_the_penalty(examples, norm):
    from pipeline.diffusion.constraints import articulated_collision
    from pipeline.diffusion.relations import boxes_of

    codec = Codec(norm)
    rooms, objects = stacked(examples, codec, 12)
    occupied = objects.classes < codec.classes
    x = objects.continuous.clone()
    x[..., :2] *= 0.5  # squeeze the furniture together
    g = constraint_descent(x, codec, rooms, occupied, objects.sweeps)
    before, after = (articulated_collision(boxes_of(codec.metric(v)), occupied, objects.sweeps, rooms).sum() for v in (x, x + 0.05 * g))
    assert after < before
    assert g[..., 2:6].abs().max() == 0
    assert g[..., 8:].abs().max() == 0
    assert g[~occupied].abs().max() == 0


def test_empty_slots_cost_nothing_in_geometry(header, data):
    rooms, objects, _ = data
    empty = replace(objects, classes=torch.full_like(objects.classes, len(header.norm.classes)))
    found = loss(header, (rooms, empty, None), SETTINGS)
    assert found.geometry.abs().max() == 0
    assert found.classes.min() >= 0


def test_validation_is_the_same_at_every_call(header, data):
    trainer = Trainer(0, header, SETTINGS, 1, 1, CPU)
    first, second = (validation(trainer, *data[:2]) for _ in range(2))
    assert first == second
    assert set(first) == {"t5", "t50", "t200", "t400", "t700"}


def test_a_step_sees_rooms_with_the_slots_that_they_are_sampled_with(norm):
    """Bedrooms hold at most 4 things here, dining rooms 6: these are the large rooms."""
    rooms, _ = stacked(made := make_examples(30), Codec(norm), 12)
    settings = replace(SETTINGS, few_slots=6, few_share=0.5)
    header = Header(norm, LAYOUTS, 12, 1000, SETTINGS.model, ("bedroom",), 6)
    trainer, rng = Trainer(0, header, settings, 6, 3, CPU), torch.Generator().manual_seed(0)
    seen = [trainer.chosen(rng, rooms, layout_weights(made)) for _ in range(40)]
    assert {slots for _, slots in seen} == {6, 12}
    for rows, slots in seen:
        assert len(rows) * slots == 8 * 6
        assert all((rooms.layout[rows] == 0) & (rooms.count[rows] <= 4)) if slots == 6 else all(rooms.layout[rows] == 1)
    mixed = Trainer(0, replace(header, few=(), few_slots=12), replace(settings, few_share=0.0), 6, 3, CPU)
    rows, slots = mixed.chosen(rng, rooms, layout_weights(made))
    assert (len(rows), slots) == (8, 12)


def test_rare_layout_types_are_drawn_more_often_than_they_occur():
    made = make_examples(9)
    rare = [e for e in made if e.layout == 1][:1] + [e for e in made if e.layout == 0]
    weights = layout_weights(rare)
    assert weights.sum() == pytest.approx(1)
    assert 1 / len(rare) < weights[0] < 0.5
