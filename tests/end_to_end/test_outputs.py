"""What the whole factory leaves behind: tables, a dataset, stages that simulate, every metric, a report."""

import base64
import json
import math
import re

import checkout
import pytest

import sfgen
from pipeline import tables, taxonomy
from pipeline.entities.files import load_asset
from pipeline.shards import TABLES
from pipeline.usd.check import check_stage
from schemas import ASSET_JOINTS, ASSET_PARTS, ASSETS, LATENTS, OBJECTS, OPENINGS, REJECTS, ROOMS, SCENES
from sfgen.check import check

HOMES = checkout.SMALL["dataset"]["homes"]
SIMULATE = """
import json, sys
import mujoco, mujoco._usd
import numpy as np
model = mujoco.MjSpec.from_file(sys.argv[1]).compile()
data = mujoco.MjData(model)
mujoco.mj_forward(model, data)
start = data.xpos.copy()
for _ in range(200):
    mujoco.mj_step(model, data)
print(json.dumps({"bodies": model.nbody, "joints": model.njnt, "moved": float(np.abs(data.xpos - start).max())}))
"""


def figures(root):
    return json.loads((root / "metrics" / "metrics.json").read_text())


def rate(found):
    """A proportion with its interval."""
    assert 0 <= found["low"] <= found["rate"] <= found["high"] <= 1
    return found["rate"]


@pytest.mark.slow
def test_every_table_is_there_with_its_schema(root):
    for table in (SCENES, ROOMS, OPENINGS, OBJECTS, ASSETS, ASSET_JOINTS, ASSET_PARTS):
        assert tables.read(root / "data" / "tables" / f"{table.name}.parquet", table)
    for table in (SCENES, ROOMS, OPENINGS, OBJECTS):
        assert tables.read(root / "data" / "samples" / f"{table.name}.parquet", table)
    rejects = tables.read(root / "data" / "tables" / "rejects.parquet", REJECTS)
    assert rejects  # the corpus has the mess of real files
    assert all(row["reason"] for row in rejects)
    assets = tables.read(root / "data" / "tables" / "assets.parquet", ASSETS)
    latents = tables.read(root / "data" / "latents" / "latents.parquet", LATENTS)
    assert {row["asset_id"] for row in latents} == {row["asset_id"] for row in assets}
    assert load_asset(root / "data" / "assets" / assets[0]["file"]).category == assets[0]["category"]


def test_no_house_is_in_two_splits_and_test_is_not_empty(root):
    scenes = tables.read(root / "data" / "tables" / "scenes.parquet", SCENES)
    assert len({row["scene_id"] for row in scenes}) == len(scenes)
    assert {row["split"] for row in scenes} >= {"train", "test"}


def test_the_dataset_is_whole_and_loads(root):
    summary = check(root / "data" / "shards")
    assert summary.homes == HOMES
    homes = list(sfgen.load(root / "data" / "shards"))
    assert [home.scene["index"] for home in homes] == list(range(HOMES))
    for home in homes:
        assert home.rooms
        assert home.openings
        assert home.scene["collisions"] == 0
        assert home.scene["joints_clear"] == home.scene["joints"] == len(home.joints) > 0
        small = [placed for placed in home.objects if placed.category in taxonomy.load().small]
        assert len(home.objects) - len(small) == home.scene["objects"]
        assert {placed.support for placed in home.objects} <= {"", *(placed.object_id for placed in home.objects)}


def test_stages_open_without_a_warning(root):
    stages = sorted((root / "data" / "shards" / "usd").glob("*/*.usdc"))
    assert len(stages) == HOMES
    for path in stages:
        assert check_stage(path).GetPrimAtPath("/World")


def test_a_home_simulates_and_nothing_flies_away(root, tmp_path):
    pytest.importorskip("mujoco")
    overlay = min((root / "data" / "shards" / "usd").glob("*/*.mujoco.usda"))
    done = checkout.python(SIMULATE, overlay, cwd=tmp_path)
    assert done.returncode == 0, done.stderr[-2000:]
    found = json.loads(done.stdout.splitlines()[-1])
    home = next(iter(sfgen.load(root / "data" / "shards")))
    loose = sum(taxonomy.load().categories[placed.category].loose for placed in home.objects)  # each lies there with a free joint
    assert found["joints"] == len(home.joints) + loose
    assert found["bodies"] > len(home.joints)
    assert found["moved"] < 0.05


def test_every_metric_of_the_paper_is_there(root):
    found = figures(root)
    for key in ("plain", "drafted", "first"):
        rate(found["quantity"]["3"][key])
    for meaning in ("free", "paper"):
        for key in ("without", "first"):
            rate(found["walkable"]["0.50"][meaning][key])
    for name in ("plain", "heuristic", "guided"):
        drafted = found["articulation"][f"{name}_drafted"]
        for key in ("r_acoll_heuristic", "r_acoll_joints"):
            rate(drafted[key]["objects"])
            assert 0 <= drafted[key]["rooms"]["mean"] <= 1
        for boxes in ("bbox", "prism"):
            rate(drafted["collision"][boxes]["col_obj"])
        assert 0 <= drafted["r_reach"]["mean"] <= 1
        assert 0 <= drafted["walkable"]["free"]["mean"] <= 1
        assert drafted["walkable"]["paper"]["mean"] <= 1  # below 0 where boxes cover more than the floor
        assert drafted["openable"]["sampled"]["mean"] >= 0
    for name in ("plain", "guided"):
        assert found["articulation"][f"{name}_shipped"].keys() == found["articulation"][f"{name}_drafted"].keys()
    assert set(found["ablation"]) == {"neither", "articulation", "walkable", "both"}
    for key in ("train_against_test", "plain", "guided"):
        assert found["category"][key]["real_to_generated"] >= 0
        assert found["category"][key]["generated_to_real"] >= 0
    for key in ("node", "constraint", "edge"):
        assert 0 < found["plan"]["mean"][key] <= 1
    numbers(found)


def numbers(tree):
    """Every number of a JSON tree is finite."""
    if isinstance(tree, dict):
        for value in tree.values():
            numbers(value)
    elif isinstance(tree, list):
        for value in tree:
            numbers(value)
    elif isinstance(tree, float):
        assert math.isfinite(tree)


def test_the_reports_links_exist(root):
    page = (root / "report" / "index.html").read_text()
    links = [link for link in re.findall(r'(?:src|href)="([^"#]+)"', page) if not link.startswith("data:")]
    assert len(links) >= HOMES
    for link in links:
        assert "://" not in link
        assert (root / "report" / link).is_file(), link


def test_the_report_shows_a_home_as_it_is_exported(root, tmp_path):
    (glb,) = (root / "report" / "glb" / "homes").glob("*.glb")
    from stages.export import main

    main(root, dataset=root / "data" / "shards", to="glb", out=tmp_path, homes=[glb.stem])
    assert glb.read_bytes() == (tmp_path / "homes" / glb.name).read_bytes()
    assert base64.b64encode(glb.read_bytes()).decode() in (root / "report" / f"{glb.stem}.html").read_text()
    assert f'href="{glb.stem}.html"' in (root / "report" / "index.html").read_text()


def test_plots_are_tables(root):
    for name, columns in (("quantity", "n,"), ("walkable", "tau,"), ("loss", "step")):
        lines = (root / "plots" / f"{name}.csv").read_text().splitlines()
        assert len(lines) > 1
        assert columns in lines[0]


def test_a_home_is_the_same_whatever_the_command(root):
    """`sfgen shard` makes the homes that sample and postopt made in two steps: same rows, same files."""
    from pipeline import params
    from pipeline.homes.factory import load_factory
    from pipeline.homes.prompt_mix import DatasetSettings, requests_of

    tree = params.read(root / "params.yaml")
    asked = requests_of(params.section(DatasetSettings, tree, "dataset"), root, tree["seed"])
    outcome = load_factory(root, tree, tree["seed"]).make(asked[-1:])[0]  # alone, not beside the others
    shards = root / "data" / "shards"
    for name, data in outcome.files.items():
        family, file = name.split("/")
        assert (shards / family / "shard-00000" / file).read_bytes() == data, name
    for name, rows in outcome.rows.items():
        stored = tables.read(shards / name / "shard-00000.parquet", TABLES[name])
        mine = TABLES[name].from_rows(rows).select([c.name for c in TABLES[name].columns]).to_pylist()
        key = "where" if name == "rejects" else "scene_id"
        theirs = [row for row in stored if row[key].startswith(outcome.home.scene_id)]
        assert [{**row, "usd": "", "usd_sha256": ""} for row in mine] == [{**row, "usd": "", "usd_sha256": ""} for row in theirs], name


def test_postopt_run_again_touches_nothing(root):
    shards = root / "data" / "shards"
    before = {p: (p.stat().st_mtime_ns, p.stat().st_ino) for p in shards.rglob("*") if p.is_file()}
    done = checkout.run_stage(root, "postopt")
    assert done.returncode == 0, done.stderr
    assert {p: (p.stat().st_mtime_ns, p.stat().st_ino) for p in shards.rglob("*") if p.is_file()} == before


def test_a_python_of_its_own_sees_the_dataset(root, tmp_path):
    done = checkout.python("import sfgen, sys; print(len(list(sfgen.load(sys.argv[1]))))", root / "data" / "shards", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (0, f"{HOMES}\n"), done.stderr
