from dataclasses import replace

import numpy as np
import pytest
import torch

from pipeline import seeds
from pipeline.errors import ContentError
from pipeline.latents.training import encode, init_vae, train
from pipeline.latents.vae import EncodeSettings, chamfer, kl_to_standard_normal, load_vae, save_vae
from pipeline.tensors import save_tensors

CPU = torch.device("cpu")
SMALL = EncodeSettings(points=128, train_points=96, decoded_points=64, width=16, steps=60, batch=8)


def clouds(count=12, points=128):
    rng = seeds.generator(0, "clouds")
    made = []
    for _ in range(count):
        half = rng.uniform(0.1, 0.5, 3)
        p = rng.uniform(-1, 1, (points, 3)) * half
        axis = rng.integers(0, 3, points)
        p[np.arange(points), axis] = np.sign(p[np.arange(points), axis]) * half[axis]
        made.append(p)
    return torch.from_numpy(np.stack(made)).float()


def test_chamfer_equals_the_plain_formula():
    a, b = clouds(3), clouds(5)[2:]
    d = torch.cdist(a, b)
    torch.testing.assert_close(chamfer(a, b), d.amin(2).mean(1) + d.amin(1).mean(1), atol=2e-4, rtol=1e-3)
    torch.testing.assert_close(chamfer(a, b), chamfer(b, a))
    assert float(chamfer(a, a).max()) < 1e-3


def test_chamfer_has_the_gradient_of_the_plain_formula():
    a, b = clouds(2), clouds(4)[2:].requires_grad_()
    chamfer(a, b).sum().backward()
    mine, b.grad = b.grad, None
    d = torch.cdist(a, b)
    (d.amin(2).mean(1) + d.amin(1).mean(1)).sum().backward()
    torch.testing.assert_close(mine, b.grad, atol=1e-3, rtol=1e-2)


def test_kl_is_zero_for_the_prior_alone():
    assert float(kl_to_standard_normal(torch.zeros(1, 32), torch.zeros(1, 32))) == 0
    assert float(kl_to_standard_normal(torch.ones(1, 32), torch.zeros(1, 32))) == pytest.approx(16)


def test_the_order_of_points_does_not_matter():
    net, cloud = init_vae(0, SMALL), clouds(2)
    order = torch.randperm(128, generator=torch.Generator().manual_seed(0))
    torch.testing.assert_close(encode(net, cloud, CPU), encode(net, cloud[:, order], CPU), atol=1e-5, rtol=1e-4)


def test_it_learns_and_is_reproducible():
    torch.set_num_threads(1)
    nets = [init_vae(0, SMALL) for _ in range(2)]
    runs = [list(train(0, net, clouds(), SMALL, CPU)) for net in nets]
    assert runs[0] == runs[1]
    assert np.mean([s.chamfer for s in runs[0][-10:]]) < 0.9 * runs[0][0].chamfer
    assert torch.equal(encode(nets[0], clouds(), CPU), encode(nets[1], clouds(), CPU))


def test_the_latent_of_an_asset_does_not_depend_on_the_others():
    net, cloud = init_vae(0, SMALL), clouds(20)
    torch.testing.assert_close(encode(net, cloud, CPU)[17:18], encode(net, cloud[17:18], CPU), atol=1e-6, rtol=1e-5)


def test_weights_come_back_with_their_settings(tmp_path):
    net = init_vae(3, SMALL)
    save_vae(tmp_path / "vae.safetensors", net, SMALL)
    again, settings = load_vae(tmp_path / "vae.safetensors")
    assert settings == SMALL
    assert torch.equal(encode(again, clouds(), CPU), encode(net, clouds(), CPU))
    save_vae(tmp_path / "two.safetensors", net, replace(SMALL))
    assert (tmp_path / "two.safetensors").read_bytes() == (tmp_path / "vae.safetensors").read_bytes()


@pytest.mark.parametrize("content", [None, b"", b"nonsense" * 20])
def test_bad_weights_are_named(tmp_path, content):
    if content is not None:
        (tmp_path / "vae.safetensors").write_bytes(content)
    with pytest.raises(ContentError, match=r"vae\.safetensors"):
        load_vae(tmp_path / "vae.safetensors")


@pytest.mark.parametrize(
    ("header", "word"),
    [
        ("{", "JSON"),
        ("[]", "format"),
        ('"sfgen-vae-1"', "format"),
        ('{"format": "sfgen-vae-2", "settings": {}}', "format"),
        ('{"format": "sfgen-vae-1"}', "settings"),
        ('{"format": "sfgen-vae-1", "settings": [1]}', "settings"),
        ('{"format": "sfgen-vae-1", "settings": {"width": "wide"}}', "settings.width"),
        ('{"format": "sfgen-vae-1", "settings": {"widht": 16}}', "settings.widht"),
        ('{"format": "sfgen-vae-1", "settings": {"learning_rate": NaN}}', "settings.learning_rate"),
        ('{"format": "sfgen-vae-1", "settings": {"width": 0}}', "width"),
        ('{"format": "sfgen-vae-1", "settings": {"latent": -1}}', "latent"),
        ('{"format": "sfgen-vae-1", "settings": {"width": 8}}', "fit"),
    ],
)
def test_a_header_that_describes_no_encoder_is_named(tmp_path, header, word):
    path = tmp_path / "vae.safetensors"
    save_tensors(path, init_vae(3, SMALL).state_dict(), {"vae": header})
    with pytest.raises(ContentError, match=r"vae\.safetensors") as refused:
        load_vae(path)
    assert word in refused.value.message
    assert "params.yaml" not in str(refused.value)
    assert "dvc repro encode" in refused.value.remedy


def test_an_encoder_with_what_is_no_number_is_named(tmp_path):
    net = init_vae(3, SMALL)
    with torch.no_grad():
        net.decoder.net[0].bias[0] = torch.inf
    save_vae(tmp_path / "vae.safetensors", net, SMALL)
    with pytest.raises(ContentError, match=r"vae\.safetensors.*decoder"):
        load_vae(tmp_path / "vae.safetensors")
