"""The net of the image metrics: trained weights see harm, unfit ones are refused; Inception comes from a file."""

from dataclasses import replace

import numpy as np
import pytest
import torch
from safetensors.torch import load_file, save_file

from pipeline import taxonomy
from pipeline.errors import ContentError
from pipeline.features import inception
from pipeline.features import net as nets
from pipeline.features.net import Examples, train
from pipeline.metrics.views import STATES, compare_views, features_once, spoilt, views_of
from tests.relations.making import bedrooms

SAID = nets.header(("bedroom",), STATES, ("double_bed",))


@pytest.fixture
def weights(tmp_path):
    torch.manual_seed(0)
    path = tmp_path / "features.safetensors"
    nets.store(path, nets.ViewNet(1, len(STATES), 5), SAID)
    return path


def test_weights_come_back_and_give_the_same_features(weights):
    views = views_of(bedrooms(np.random.default_rng(0), 4))
    torch.manual_seed(0)
    same = nets.ViewNet(1, len(STATES), 5)
    assert np.allclose(nets.embed(nets.load(weights, SAID), views), nets.embed(same, views))
    assert nets.embed(nets.load(weights, SAID), views[:0]).shape == (0, nets.FEATURES)


def test_unfit_weights_are_refused(weights):
    with pytest.raises(ContentError, match="missing"):
        nets.load(weights.with_name("none"), SAID)
    with pytest.raises(ContentError, match="other categories"):
        nets.load(weights, nets.header(("bedroom",), STATES, ("sofa",)))
    tensors = load_file(weights)
    save_file({**tensors, "line.bias": tensors["line.bias"] * np.nan}, weights, SAID)
    with pytest.raises(ContentError, match="not finite"):
        nets.load(weights, SAID)
    save_file({name: value for name, value in tensors.items() if name != "line.bias"}, weights, SAID)
    with pytest.raises(ContentError, match="does not fit"):
        nets.load(weights, SAID)
    weights.write_bytes(b"none")
    with pytest.raises(ContentError, match="no safetensors"):
        nets.load(weights, SAID)


def test_training_learns(monkeypatch):
    rng = np.random.default_rng(0)
    torch.manual_seed(0)
    rooms = bedrooms(rng, 128)
    views = np.concatenate([views_of(rooms), views_of([spoilt(rng, room) for room in rooms])])
    states = np.repeat([0, 1], len(rooms))
    examples = Examples(views, np.zeros(len(views), int), states, np.tile(states, (5, 1)).T.astype(float))
    monkeypatch.setattr("pipeline.features.net.EVERY", 10)
    said = list(train(rng, nets.ViewNet(1, 2, 5), examples, 25, torch.device("cpu")))
    assert [part.done for part in said] == [10, 20, 25]
    assert said[-1].loss < said[0].loss
    assert said[-1].states > 0.7


def test_the_released_net_sees_harm_and_nothing_where_there_is_none(root):
    known = taxonomy.load()
    net = nets.load(root / "weights" / "features.safetensors", nets.header(known.layout_types, STATES, known.names))
    rng = np.random.default_rng(0)
    real, other = ([replace(room, name=str(k)) for k, room in enumerate(bedrooms(rng, 120))] for _ in range(2))
    sets = {"other": other, "spoilt": [spoilt(rng, room) for room in other]}
    found = compare_views(rng, 0, features_once(lambda views: nets.embed(net, views)), real, sets)
    assert found["spoilt"]["fid"] > 4 * found["other"]["fid"]
    assert found["spoilt"]["kid"]["low"] > 0 > found["other"]["kid"]["low"]
    assert found["spoilt"]["sca"]["rate"] > 0.8 > 0.65 > found["other"]["sca"]["rate"]


def test_each_room_is_embedded_once_and_keeps_its_own_features():
    rooms = bedrooms(np.random.default_rng(0), 6)
    seen = []

    def embed(views):
        seen.append(len(views))
        return views.reshape(len(views), -1)[:, ::997].astype(float)

    features_of = features_once(embed)
    first, again = features_of(rooms[:4]), features_of([*rooms[2:], *rooms[:2]])
    assert seen == [4, 2]
    assert np.array_equal(again, embed(views_of([*rooms[2:], *rooms[:2]])))
    assert np.array_equal(first[2:], again[:2])


@pytest.fixture
def root(request):
    return request.config.rootpath


class Made(torch.nn.Module):
    def forward(self, images: torch.Tensor, return_features: bool = False) -> torch.Tensor:
        found = images.float().mean((2, 3))
        if return_features:
            return found
        return found * 0


def test_inception_is_read_from_a_file(tmp_path):
    path = tmp_path / "inception.pt"
    torch.jit.script(Made()).save(str(path))
    views = np.stack([np.full((64, 64, 3), k, np.uint8) for k in (10, 200)])
    found = inception.embed(inception.inception(path), views)
    assert np.allclose(found, [[10] * 3, [200] * 3])
    with pytest.raises(ContentError, match="missing"):
        inception.inception(tmp_path / "none.pt")
    path.write_bytes(b"none")
    with pytest.raises(ContentError, match="no TorchScript"):
        inception.inception(path)
