import json
import math
from dataclasses import replace

import pytest
import torch
from safetensors import safe_open

from pipeline import taxonomy
from pipeline.diffusion.articulated_collision import Furniture, Obstacles, articulated_collision
from pipeline.diffusion.batch import collate
from pipeline.diffusion.checkpoint import Header, build_inventory, load_weights, require_vocabulary, save_weights
from pipeline.diffusion.codec import Codec
from pipeline.diffusion.job import rooms_of
from pipeline.diffusion.loss import constraint_descent, denoising_loss, draw
from pipeline.diffusion.rooms import layout_weights
from pipeline.diffusion.set_transformer import UNBOUNDED
from pipeline.diffusion.settings import ModelSettings, TrainSettings
from pipeline.diffusion.training import Trainer, train, validation
from pipeline.errors import ContentError
from pipeline.tensors import Checkpoint, save_tensors
from tests.diffusion.small_world import LAYOUTS, make_examples

CPU = torch.device("cpu")
SETTINGS = TrainSettings(ModelSettings(32, 2, 1, 4, 8), slots=12, steps=6, objects=64, warmup=2, checkpoint_every=3, constraint_below=400)


@pytest.fixture(scope="module")
def header(norm):
    return Header(norm, LAYOUTS, SETTINGS.slots, SETTINGS.model, 16)


@pytest.fixture(scope="module")
def data(examples, header):
    return rooms_of(examples, header, CPU)


@pytest.fixture(autouse=True)
def one_thread():
    torch.set_num_threads(1)


def trained(header, data, steps):
    trainer = Trainer(0, header, SETTINGS, SETTINGS.steps, 3, CPU)
    for step in train(trainer, data):
        if step.done == steps:
            break
    return trainer


def same(a, b):
    return all(torch.equal(x, y) for x, y in zip(a.state_dict().values(), b.state_dict().values(), strict=True))


def test_with_the_last_step_the_averaged_net_knows_the_bounds_of_its_rooms(header, data):
    whole, half = trained(header, data, 6), trained(header, data, 3)
    codes = whole.average.floor_code(data.rooms, data.objects.classes).room
    assert torch.equal(codes.aminmax(dim=0)[0], whole.average.room_bounds[0])
    assert torch.equal(codes.aminmax(dim=0)[1], whole.average.room_bounds[1])
    for net in (whole.net, half.net, half.average):
        assert net.room_bounds.abs().min() >= UNBOUNDED


def test_a_resumed_run_equals_an_undisturbed_one_bit_for_bit(header, data, tmp_path):
    whole = trained(header, data, 6)
    checkpoint = Checkpoint(tmp_path / "checkpoint.safetensors", "digest")
    half = trained(header, data, 3)
    checkpoint.keep(half.done, half.nets, half.optimiser)
    resumed = Trainer(0, header, SETTINGS, SETTINGS.steps, 3, CPU)
    resumed.done = checkpoint.resume(resumed.nets, resumed.optimiser)
    list(train(resumed, data))
    assert resumed.done == whole.done == 6
    assert not same(whole.net, half.net)
    assert same(whole.net, resumed.net)
    assert same(whole.average, resumed.average)


def test_a_checkpoint_of_something_else_or_damaged_starts_afresh(header, data, tmp_path):
    path = tmp_path / "checkpoint.safetensors"
    checkpoint = Checkpoint(path, "digest")
    assert checkpoint.load() is None
    half = trained(header, data, 1)
    checkpoint.keep(1, half.nets, half.optimiser)
    assert checkpoint.load()[0] == 1
    assert Checkpoint(path, "other").load() is None
    path.write_bytes(path.read_bytes()[:1000])
    assert checkpoint.load() is None


def test_checkpoints_are_written_when_due_and_at_the_end(header, data, monkeypatch, tmp_path):
    done = []
    monkeypatch.setattr(Checkpoint, "keep", lambda _, step, *_state: done.append(step))
    list(train(Trainer(0, header, replace(SETTINGS, checkpoint_every=4), 6, 3, CPU), data, Checkpoint(tmp_path / "c", "x")))
    assert done == [4, 6]


def test_weights_come_back_with_their_header(header, data, tmp_path):
    trainer = trained(header, data, 1)
    inventory = build_inventory(header)
    save_weights(tmp_path / "w.safetensors", header, {"denoiser": trainer.average, "inventory": inventory})
    net, held, read = load_weights(tmp_path / "w.safetensors")
    assert read == header
    assert same(net, trainer.average)
    assert same(held, inventory)


@pytest.mark.parametrize("spoil", ["missing", "truncated", "vae", "no number", "another net"])
def test_bad_weights_are_named(header, data, tmp_path, spoil):
    path, nets = tmp_path / "w.safetensors", {"denoiser": trained(header, data, 1).net, "inventory": build_inventory(header)}
    if spoil == "truncated":
        save_weights(path, header, nets)
        path.write_bytes(path.read_bytes()[:500])
    if spoil == "vae":
        Checkpoint(path, "x").save(0, {})
    if spoil == "no number":
        with torch.no_grad():
            nets["inventory"].out.bias[0] = torch.nan
        save_weights(path, header, nets)
    if spoil == "another net":
        save_weights(path, replace(header, model=replace(header.model, width=64)), nets)
    with pytest.raises(ContentError, match=r"w\.safetensors"):
        load_weights(path)


def rewritten(path, change):
    """Let `change` edit what the weights' header says (a dict), or return a text to be there instead."""
    with safe_open(path, "pt") as handle:
        tensors, said = {name: handle.get_tensor(name) for name in handle.keys()}, json.loads(handle.metadata()["layout"])  # noqa: SIM118
    text = change(said)
    save_tensors(path, tensors, {"layout": text if isinstance(text, str) else json.dumps(said)})


@pytest.mark.parametrize(
    ("change", "word"),
    [
        (lambda h: "{", "JSON"),
        (lambda h: "[" * 100_000, "JSON"),
        (lambda h: "[1]", "format"),
        (lambda h: json.dumps({**h, "format": "sfgen-denoiser-3"}), "format"),
        (lambda h: h.pop("norm"), "layout.norm is missing"),
        (lambda h: h["norm"]["mean"][1].__setitem__(3, math.nan), "mean"),
        (lambda h: h["norm"]["scale"][1].__setitem__(3, math.inf), "scale"),
        (lambda h: h["norm"]["scale"][1].__setitem__(3, 0.0), "deviation"),
        (lambda h: h["norm"]["scale"][0].__setitem__(3, -1.0), "deviation"),
        (lambda h: h["norm"]["mean"][2].pop() and None, "norm"),
        (lambda h: h["norm"]["scale"].pop() and None, "norm"),
        (lambda h: h["norm"]["mean"][0].__setitem__(0, "far"), "mean"),
        (lambda h: h["norm"].__setitem__("mean", 7), "mean"),
        (lambda h: h["norm"]["classes"].__setitem__(0, h["norm"]["classes"][1]), "twice"),
        (lambda h: h["norm"].update(classes=[], mean=[], scale=[]), "missing"),
        (lambda h: h.update(layouts=[]), "missing"),
        (lambda h: h.update(layouts="bedroom"), "layouts"),
        (lambda h: h.update(slots="many"), "slots"),
        (lambda h: h.update(slots=-1), "slots"),
        (lambda h: h.update(slots=10**9), "slots"),
        (lambda h: h.update(inventory_width=0), "shape"),
        (lambda h: h["model"].update(heads=3), "shape"),
        (lambda h: h["model"].update(width=-32), "shape"),
        (lambda h: h["model"].update(depth=2), "model.depth"),
        (lambda h: h.update(more=1), "layout.more"),
    ],
)
def test_a_header_that_describes_no_model_is_named(header, data, tmp_path, change, word):
    path = tmp_path / "w.safetensors"
    save_weights(path, header, {"denoiser": trained(header, data, 1).net, "inventory": build_inventory(header)})
    rewritten(path, change)
    with pytest.raises(ContentError, match=r"w\.safetensors") as refused:
        load_weights(path)
    assert word in refused.value.message
    assert "params.yaml" not in str(refused.value)
    assert "dvc repro train" in refused.value.remedy


def test_a_tensor_of_no_net_is_named(header, tmp_path):
    path = tmp_path / "w.safetensors"
    save_weights(path, header, {})
    rewritten(path, lambda h: None)
    with safe_open(path, "pt") as handle:
        said = handle.metadata()
    save_tensors(path, {"stray": torch.zeros(1)}, said)
    with pytest.raises(ContentError, match="stray"):
        load_weights(path)


def test_weights_of_another_vocabulary_are_named(header, tmp_path):
    words = taxonomy.load()
    norm = replace(header.norm, classes=words.names)
    same_words = replace(header, norm=norm, layouts=words.layout_types)
    require_vocabulary(tmp_path, same_words)
    for other, word in (
        (replace(same_words, norm=replace(norm, classes=(*words.names[1:], "anvil"))), "anvil"),
        (replace(same_words, norm=replace(norm, classes=words.names[::-1])), "order"),
        (replace(same_words, layouts=words.layout_types[1:]), words.layout_types[0]),
    ):
        with pytest.raises(ContentError, match=word):
            require_vocabulary(tmp_path / "w.safetensors", other)


def test_more_slots_than_rooms_are_padded_to_are_refused():
    for slots in (0, -1, 33):
        with pytest.raises(ContentError, match=r"train\.slots"):
            TrainSettings(slots=slots)


def test_it_learns(header, data):
    settings = replace(SETTINGS, steps=50, objects=128)
    steps = list(train(Trainer(0, header, settings, 50, 3, CPU), data))
    early, late = (sum(s.loss for s in part) for part in (steps[:10], steps[-10:]))
    assert late < 0.9 * early


def loss(header, data, settings):
    net = Trainer(0, header, settings, 1, 1, CPU).net
    drawn = draw(torch.Generator().manual_seed(0), len(data.counts), 12)
    drawn = drawn._replace(level=torch.full((len(data.counts),), 4.0))
    return denoising_loss(net, data.rooms, data.objects, drawn, settings)[-1]


def test_the_constraint_term_of_eq_1_has_a_switch_and_a_scale(header, data):
    plain = loss(header, data, replace(SETTINGS, constraint=False))
    nothing = loss(header, data, replace(SETTINGS, constraint=True, constraint_scale=0.0))
    guided = loss(header, data, replace(SETTINGS, constraint=True, constraint_scale=1e4))
    torch.testing.assert_close(plain.geometry, nothing.geometry)
    assert not torch.allclose(plain.geometry, guided.geometry)
    torch.testing.assert_close(plain.shape, guided.shape)


def test_errors_weigh_by_how_rare_a_pose_is_where_it_is_told(header, data):
    net = Trainer(0, header, SETTINGS, 1, 1, CPU).net
    drawn = draw(torch.Generator().manual_seed(0), len(data.counts), 12)
    told = torch.arange(len(data.counts)) % 2 == 0
    drawn = drawn._replace(told=told)
    doubled = replace(data.objects, weights=2 * data.objects.weights)
    once, twice = (denoising_loss(net, data.rooms, objects, drawn, SETTINGS)[-1] for objects in (data.objects, doubled))
    torch.testing.assert_close(twice.geometry[told], 2 * once.geometry[told])
    torch.testing.assert_close(twice.shape[~told], once.shape[~told])


def test_g_points_down_the_penalty(examples, norm):
    codec = Codec(norm)
    rooms, objects = collate(examples, codec, 12)
    occupied = (objects.classes < codec.classes).numpy()
    furniture, obstacles = Furniture.of(occupied, objects.sweeps.double().numpy()), Obstacles.of(rooms)
    x = objects.channels.clone()
    x[..., :2] *= 0.5  # squeeze the furniture together
    g = constraint_descent(x, objects.classes, codec, rooms, objects.sweeps)
    before, after = (
        articulated_collision(codec.metric(v, objects.classes)[..., :8].numpy(), furniture, obstacles)[0].sum() for v in (x, x + 0.05 * g)
    )
    assert after < before
    assert g[..., 2:6].abs().max() == 0
    assert g[..., 8:].abs().max() == 0
    assert g[~occupied].abs().max() == 0


def test_padding_costs_nothing(header, data):
    empty = replace(data.objects, classes=torch.full_like(data.objects.classes, len(header.norm.classes)))
    found = loss(header, data._replace(objects=empty), SETTINGS)
    assert found.geometry.abs().max() == 0
    assert found.shape.abs().max() == 0


def test_validation_is_the_same_at_every_call(header, data):
    trainer = Trainer(0, header, SETTINGS, 1, 1, CPU)
    first, second = (validation(trainer, data) for _ in range(2))
    assert first == second
    assert len(first) == 6
    assert all(v["geometry"] > 0 for v in first.values())


def test_a_step_sees_rooms_of_like_size_and_every_room_as_often_as_its_weight(norm):
    """Bedrooms hold at most 4 things here, dining rooms 6."""
    header = Header(norm, LAYOUTS, 12, SETTINGS.model, 16)
    data = rooms_of(make_examples(30), header, CPU)
    trainer, rng = Trainer(0, header, SETTINGS, 6, 3, CPU), torch.Generator().manual_seed(0)
    seen = torch.zeros(30)
    for _ in range(1200):
        rows, slots = trainer.draw_rows(rng, data)
        assert len(rows) * slots == SETTINGS.objects
        assert all(data.counts[rows] <= slots)
        seen += torch.bincount(rows, minlength=30)
    share = (seen / seen.sum()).numpy()
    assert abs(share - data.weights).max() < 0.01


def test_rare_layout_types_are_drawn_more_often_than_they_occur():
    made = make_examples(9)
    rare = [e for e in made if e.layout == 1][:1] + [e for e in made if e.layout == 0]
    weights = layout_weights(rare)
    assert weights.sum() == pytest.approx(1)
    assert 1 / len(rare) < weights[0] < 0.5
