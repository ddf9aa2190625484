import json
import math

import numpy as np
import pytest
import torch
from safetensors.torch import load_file

from pipeline import seeds, tables
from pipeline.diffusion.context import RoomContext
from pipeline.diffusion.sampling import Sampler
from pipeline.diffusion.settings import SampleSettings
from pipeline.errors import ContentError
from pipeline.tensors import Checkpoint
from schemas import ASSET_JOINTS, LATENTS, OBJECTS, OPENINGS, ROOMS, SCENES
from schemas.table import Table
from stages import train

SETTINGS = "model: {width: 16, passes: 2, layers: 1, heads: 2, relation: 4}, inventory: {width: 8, steps: 20}, steps: %d, objects: 16, checkpoint_every: 2, validate_every: 4, threads: 1, workers: %d"


def blank(table: Table, **values):
    """A row of a table: what is not given is a plain zero of the column's type."""
    row = {}
    for column in table.columns:
        kind = str(column.type)
        row[column.name] = None if column.nullable else "" if kind == "string" else False if kind == "bool" else 0
    return {**row, **values}


def make_root(root, steps=4, houses=9, workers=1):
    rng = seeds.generator(0, "houses")
    made = {t.name: [] for t in (SCENES, ROOMS, OPENINGS, OBJECTS)}
    for n in range(houses):
        scene, w, d = f"h{n}", *rng.uniform(3, 5, 2)
        made["scenes"].append(blank(SCENES, scene_id=scene, split=("train", "train", "val")[n % 3], storey_height=3.0))
        polygon = [[0, 0], [w, 0], [w, d], [0, d]]
        made["rooms"].append(blank(ROOMS, scene_id=scene, room_id="r", type="bedroom", layout_type="bedroom", height=2.7, polygon=polygon))
        door = {
            "opening_id": "d",
            "kind": "door",
            "rooms": ["r"],
            "segment": [[0.3, -0.06], [1.2, -0.06]],
            "swing_room": "r",
            "swing_hinge": 0,
            "swing_angle": 1.5,
        }
        made["openings"].append(blank(OPENINGS, scene_id=scene, **door))
        for k, name in enumerate(("double_bed", "nightstand")):
            pose = {
                "position": [w / 2 + k, d - 1, 0.0],
                "size": [1.0, 1.0, 0.5],
                "scale": [1.0] * 3,
                "yaw": -math.pi / 2 * k,
                "latent": [0.0] * 32,
            }
            made["objects"].append(blank(OBJECTS, scene_id=scene, object_id=f"o{k}", room_id="r", category=name, asset_id=name, **pose))
    for table in (SCENES, ROOMS, OPENINGS, OBJECTS):
        tables.write(root / f"data/tables/{table.name}.parquet", table, made[table.name])
    box = {
        "after": [],
        "axis": [0.0, -1, 0],
        "origin": [0.0] * 3,
        "sweep_min": [-0.5, -0.9, 0.1],
        "sweep_max": [0.5, -0.5, 0.4],
        "handle": [0.0] * 3,
    }
    tables.write(root / "data/tables/asset_joints.parquet", ASSET_JOINTS, [blank(ASSET_JOINTS, asset_id="nightstand", joint_id="j", **box)])
    latents = [{"asset_id": a, "latent": rng.normal(0, 1, 32).tolist(), "finish": None} for a in ("double_bed", "nightstand")]
    tables.write(root / "data/latents/latents.parquet", LATENTS, latents)
    write_params(root, steps, workers)


def write_params(root, steps, workers, more=""):
    (root / "params.yaml").write_text(f"seed: 0\ntrain: {{{SETTINGS % (steps, workers)}{more}}}\npresets: {{quick: {{}}}}\n")


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    folder = tmp_path_factory.mktemp("train")
    make_root(folder)
    train.main(folder)
    return folder


def test_it_reports_what_it_learnt_from(root):
    report = json.loads((root / "metrics/train.json").read_text())
    assert report["rooms"] == {"train": 6, "val": 3, "test": 0}
    assert report["steps"] == 4
    assert report["val"]["lambda 2"]["geometry"] > 0
    rows = (root / "plots/loss.csv").read_text().splitlines()
    assert rows[0].startswith("step,loss,geometry,shape")
    assert rows[-1].startswith("4,")


def test_the_model_furnishes_a_room(root):
    sampler = Sampler.load(root / "models/denoiser.safetensors", SampleSettings(batch=1), 0)
    square = np.array([[0, 0], [4, 0], [4, 4], [0, 4]], float)
    found = sampler.sample_rooms([RoomContext("bedroom", square, n_target=3)], [(0, 0, 0)])[0]
    assert len(found) == 3


@pytest.mark.parametrize(("net", "kill", "after"), [("denoiser", 2, [4]), ("inventory", 6, [8, 10, 12, 14, 16, 18, 20])])
def test_a_killed_run_goes_on_and_ends_as_an_undisturbed_one(root, tmp_path, monkeypatch, net, kill, after):
    make_root(tmp_path)

    class KilledError(Exception):
        pass

    def dies(self, step, groups):
        saved(self, step, groups)
        if (self.path.stem, step) == (net, kill):
            raise KilledError

    saved = Checkpoint.save
    monkeypatch.setattr(Checkpoint, "save", dies)
    with pytest.raises(KilledError):
        train.main(tmp_path)
    assert not (tmp_path / "models/denoiser.safetensors").exists()
    done = {"denoiser": [], "inventory": []}

    def counted(self, step, groups):
        done[self.path.stem].append(step)
        saved(self, step, groups)

    monkeypatch.setattr(Checkpoint, "save", counted)
    train.main(tmp_path)
    assert done[net] == after  # no step was taken again
    assert not (tmp_path / "models/checkpoint/inventory.safetensors").exists()
    for name in ("models/denoiser.safetensors", "metrics/train.json"):
        assert (tmp_path / name).read_bytes() == (root / name).read_bytes()


def test_processes_that_share_the_batch_learn_the_same(root, tmp_path):
    make_root(tmp_path, workers=2)
    train.main(tmp_path)
    names = "models/denoiser.safetensors", "metrics/train.json"
    alone, shared = (load_file(folder / names[0]) for folder in (root, tmp_path))
    assert all(torch.allclose(alone[name], shared[name], atol=1e-4) for name in alone)
    assert json.loads((tmp_path / names[1]).read_text())["steps"] == 4


def test_other_data_start_afresh(tmp_path):
    make_root(tmp_path)
    train.main(tmp_path)
    first = (tmp_path / "models/denoiser.safetensors").read_bytes()
    make_root(tmp_path, houses=12)
    train.main(tmp_path)
    assert (tmp_path / "models/denoiser.safetensors").read_bytes() != first
    assert json.loads((tmp_path / "metrics/train.json").read_text())["steps"] == 4


def test_a_missing_table_is_named(tmp_path):
    make_root(tmp_path)
    (tmp_path / "data/tables/rooms.parquet").unlink()
    with pytest.raises(ContentError, match=r"rooms\.parquet"):
        train.main(tmp_path)


def test_no_room_to_learn_from_is_said(tmp_path):
    make_root(tmp_path, houses=9)
    tables.write(tmp_path / "data/tables/objects.parquet", OBJECTS, [])
    with pytest.raises(ContentError, match="no furnished room"):
        train.main(tmp_path)


RELEASED = ", start: released, tune: {steps: 3, learning_rate: 0.001, inventory_steps: 3}"


def released_root(folder, root):
    make_root(folder, houses=12)
    (folder / "weights").mkdir()
    (folder / "weights/denoiser.safetensors").write_bytes((root / "models/denoiser.safetensors").read_bytes())
    write_params(folder, 4, 1, RELEASED)


def test_released_weights_go_on_on_other_data(root, tmp_path):
    released_root(tmp_path, root)
    train.main(tmp_path)
    assert json.loads((tmp_path / "metrics/train.json").read_text())["steps"] == 3
    before, after = (load_file(folder / "models/denoiser.safetensors") for folder in (root, tmp_path))
    moved = {name: float((before[name] - after[name]).abs().max()) for name in before}
    assert max(v for k, v in moved.items() if k.startswith("denoiser/")) > 0
    assert max(v for k, v in moved.items() if k.startswith("inventory/")) > 0
    assert max(moved.values()) < 0.1  # a few small steps from where they were, not a new start
    (read,) = (Sampler.load(tmp_path / "models/denoiser.safetensors", SampleSettings(batch=1), 0).header,)
    assert read.norm == Sampler.load(root / "models/denoiser.safetensors", SampleSettings(batch=1), 0).header.norm


@pytest.mark.parametrize("change", [", slots: 20", ", inventory: {width: 9, steps: 20}"])
def test_released_weights_of_another_shape_are_refused_with_the_remedy(root, tmp_path, change):
    released_root(tmp_path, root)
    text = (
        (tmp_path / "params.yaml").read_text().replace(", inventory: {width: 8, steps: 20}", "")
        if "inventory" in change
        else (tmp_path / "params.yaml").read_text()
    )
    (tmp_path / "params.yaml").write_text(text.replace(RELEASED, RELEASED + change))
    with pytest.raises(ContentError, match="other") as refused:
        train.main(tmp_path)
    assert "scratch" in str(refused.value.remedy)


def test_released_weights_that_are_missing_are_named(root, tmp_path):
    released_root(tmp_path, root)
    (tmp_path / "weights/denoiser.safetensors").unlink()
    with pytest.raises(ContentError, match=r"weights/denoiser\.safetensors"):
        train.main(tmp_path)
