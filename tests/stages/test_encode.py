import json

import numpy as np
import pytest

from pipeline import params, seeds, tables
from pipeline.entities.files import load_asset, save_asset
from pipeline.errors import ContentError
from pipeline.latents import training
from pipeline.latents.vae import load_vae
from pipeline.rendering.surface_colour import finish_of
from pipeline.tensors import Checkpoint
from schemas import ASSETS, LATENTS
from stages import encode
from tests.latents.test_surface import box_asset

SETTINGS = "points: 256, train_points: 64, decoded_points: 32, width: 16, steps: 15, batch: 8, threads: 1"


def make_root(root, count=10):
    """A checkout with `count` boxes, each at two scales, as PartNet objects that serve two categories."""
    rng = seeds.generator(0, "boxes")
    rows = []
    for i in range(count):
        size = rng.uniform(0.3, 1.5, 3)
        for scale, category in ((1.0, "cabinet"), (1.5, "wardrobe")):
            asset = box_asset(size * scale, name=f"p{i}_{category}")
            sha = save_asset(root / "data/assets" / f"{asset.asset_id}.safetensors", asset)
            rows.append(
                {
                    "asset_id": asset.asset_id, "source": "partnet-mobility", "source_id": str(i), "category": category, "super_category": "",
                    "style": "", "material": "", "split": "train" if i % 3 else "test", "size": asset.size.tolist(), "unit_scale": scale,
                    "scale_from": category, "scale_rms": 1.0, "density": 600.0,
                    "articulated": False, "openable": False, "joints": 0, "triangles": 12, "mass": 1.0, "licence": "CC0-1.0",
                    "file": f"{asset.asset_id}.safetensors", "sha256": sha,
                }
            )  # fmt: skip
    tables.write(root / "data/tables/assets.parquet", ASSETS, rows)
    (root / "params.yaml").write_text(f"seed: 0\nencode: {{{SETTINGS}}}\npresets: {{quick: {{}}}}\n")
    return rows


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    folder = tmp_path_factory.mktemp("encode")
    make_root(folder)
    encode.main(folder)
    return folder


def test_every_asset_has_a_latent_and_shapes_share_it(root):
    rows = {r["asset_id"]: r["latent"] for r in tables.read(root / "data/latents/latents.parquet", LATENTS)}
    assert len(rows) == 20
    assert all(rows[f"p{i}_cabinet"] == rows[f"p{i}_wardrobe"] for i in range(10))
    assert len({tuple(v) for v in rows.values()}) == 10
    assert np.isfinite(list(rows.values())).all()


def test_every_asset_has_the_finish_that_its_surface_has(root):
    rows = tables.read(root / "data/latents/latents.parquet", LATENTS)
    own = {
        r["asset_id"]: finish_of(load_asset(root / "data/assets" / r["file"]))
        for r in tables.read(root / "data/tables/assets.parquet", ASSETS)
    }
    assert all(row["finish"] == pytest.approx(own[row["asset_id"]]) for row in rows)


def test_the_report_compares_trained_and_untrained(root):
    report = json.loads((root / "metrics/encode.json").read_text())
    assert (report["shapes"], report["assets"], report["asked_held_out"], report["asked_all"]) == (10, 20, 4, 10)
    for name in ("trained", "untrained"):
        assert 0 <= report[f"self_rank_held_out_{name}"] <= 1
    assert report["chamfer_two_samples"] > 0


def test_it_is_reproducible(root, tmp_path):
    make_root(tmp_path)
    encode.main(tmp_path)
    for name in ("data/latents/latents.parquet", "models/vae.safetensors", "metrics/encode.json"):
        assert (tmp_path / name).read_bytes() == (root / name).read_bytes()


def test_a_killed_training_goes_on_and_ends_as_an_undisturbed_one(root, tmp_path, monkeypatch):
    class KilledError(Exception):
        pass

    def dies(self, step, groups):
        saved(self, step, groups)
        steps.append(step)
        if len(steps) == 2:
            raise KilledError

    make_root(tmp_path)
    saved, steps = Checkpoint.save, []
    monkeypatch.setattr(training, "EVERY", 4)
    monkeypatch.setattr(Checkpoint, "save", dies)
    with pytest.raises(KilledError):
        encode.main(tmp_path)
    assert not (tmp_path / "models/vae.safetensors").exists()
    encode.main(tmp_path)
    assert steps == [4, 8, 12]  # 1 to 8 were not taken again
    assert not (tmp_path / encode.CHECKPOINT).exists()
    for name in ("data/latents/latents.parquet", "models/vae.safetensors", "metrics/encode.json"):
        assert (tmp_path / name).read_bytes() == (root / name).read_bytes()


def test_a_checkpoint_of_other_shapes_is_not_taken_up(tmp_path, monkeypatch):
    """What the second run makes is what it makes without the checkpoint of the first."""
    monkeypatch.setattr(training, "EVERY", 4)
    monkeypatch.setattr(encode, "save_vae", lambda *_: (_ for _ in ()).throw(KeyboardInterrupt))
    make_root(tmp_path, 10)
    with pytest.raises(KeyboardInterrupt):
        encode.main(tmp_path)
    assert (tmp_path / encode.CHECKPOINT).exists()
    monkeypatch.undo()
    make_root(tmp_path, 7)
    encode.main(tmp_path)
    make_root(tmp_path / "clean", 7)
    encode.main(tmp_path / "clean")
    assert (tmp_path / "models/vae.safetensors").read_bytes() == (tmp_path / "clean/models/vae.safetensors").read_bytes()


def test_the_weights_load(root):
    net, settings = load_vae(root / "models/vae.safetensors")
    assert settings.points == 256
    assert not net.training


def test_a_truncated_asset_is_named(tmp_path):
    make_root(tmp_path, 4)
    path = tmp_path / "data/assets/p1_cabinet.safetensors"
    path.write_bytes(path.read_bytes()[:100])
    with pytest.raises(ContentError, match="p1_cabinet"):
        encode.main(tmp_path)


def test_an_unknown_key_is_named(tmp_path):
    make_root(tmp_path, 2)
    (tmp_path / "params.yaml").write_text("seed: 0\nencode: {stepz: 3}\npresets: {quick: {}}\n")
    with pytest.raises(ContentError, match=r"encode\.stepz"):
        encode.main(tmp_path)
    assert params.read(tmp_path / "params.yaml")["seed"] == 0


def test_the_released_encoder_is_taken_as_it_is(root, tmp_path):
    make_root(tmp_path)
    (tmp_path / "weights").mkdir()
    (tmp_path / "weights/vae.safetensors").write_bytes((root / "models/vae.safetensors").read_bytes())
    tree = (tmp_path / "params.yaml").read_text()
    (tmp_path / "params.yaml").write_text(tree.replace("encode: {", "encode: {start: released, "))
    encode.main(tmp_path)
    latents = "data/latents/latents.parquet"
    assert tables.read(tmp_path / latents, LATENTS) == tables.read(root / latents, LATENTS)
    (tmp_path / "params.yaml").write_text(tree.replace("encode: {", "encode: {start: released, ").replace("width: 16", "width: 24"))
    with pytest.raises(ContentError, match="another shape"):
        encode.main(tmp_path)
