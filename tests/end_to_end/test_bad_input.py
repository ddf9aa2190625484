"""Bad input to the stages and the commands: one line that names the thing and the remedy, the right exit code, nothing lost."""

import importlib
import os
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import checkout
import pytest
import yaml

from pipeline import entry, tables
from schemas import REJECTS
from sfgen import cli


def snapshot(folder):
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file() and "__pycache__" not in p.parts}


def cut(path, share=0.5):
    """Truncate a file."""
    data = path.read_bytes()
    path.write_bytes(data[: int(len(data) * share)])


def said(done, code, *words):
    """Check exit code, and that the last line of stderr is the only explanation and names `words`."""
    assert done.returncode == code, done.stderr[-2000:]
    assert "Traceback" not in done.stderr
    lines = [line for line in done.stderr.splitlines() if line.startswith("sfgen: ")]
    assert len(lines) == 1, done.stderr[-2000:]
    assert ";" in lines[0], "names no remedy"
    assert len(lines[0]) < 600
    for word in words:
        assert word in lines[0]


@pytest.fixture
def stage(capsys, monkeypatch):
    """Run a stage on a checkout as `python -m stages.<name>` does, in this process."""
    monkeypatch.setattr(os, "cpu_count", lambda: 1)
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0})
    monkeypatch.delenv("SFGEN_DEBUG", raising=False)

    def run(root, name):
        monkeypatch.setattr(entry, "ROOT", root)
        code = 0
        try:
            entry.run(importlib.import_module(f"stages.{name}").main)
        except SystemExit as end:
            code = end.code
        return SimpleNamespace(returncode=code, stderr=capsys.readouterr().err)

    return run


@pytest.fixture
def command(capsys, monkeypatch, tmp_path):
    """Run `sfgen` for another checkout, in an empty folder of this process."""
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    monkeypatch.setattr(os, "cpu_count", lambda: 1)
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0})
    monkeypatch.delenv("SFGEN_DEBUG", raising=False)

    def run(root, *arguments):
        monkeypatch.setattr(cli, "ROOT", root)
        monkeypatch.setattr(cli, "is_checkout", lambda: True)
        code = cli.run(arguments)
        return SimpleNamespace(returncode=code, stderr=capsys.readouterr().err)

    return run


@pytest.mark.parametrize(
    ("name", "file", "words"),
    [
        ("preprocess", "data/raw/3d-front", ("3d-front", "preprocess.sources.front")),
        ("preprocess", "data/raw/partnet", ("partnet", "preprocess.sources.partnet")),
        ("encode", "data/tables/assets.parquet", ("assets.parquet", "dvc repro")),
        ("train", "data/latents/latents.parquet", ("latents.parquet",)),
        ("sample", "models/denoiser.safetensors", ("denoiser.safetensors", "make run")),
        ("postopt", "data/samples/rooms.parquet", ("rooms.parquet",)),
    ],
)
def test_what_is_missing_is_named(broken, stage, name, file, words):
    path = broken / file
    if path.exists():
        path.unlink()
    elif path.name == "partnet":  # the folder beside it is there
        for part in ("3D-FRONT", "3D-FUTURE-model"):
            (path.parent / "3d-front" / part).mkdir(parents=True)
    before = snapshot(broken / "data")
    said(stage(broken, name), 1, *words)
    after = snapshot(broken / "data")
    assert {file: after[file] for file in before} == before


@pytest.mark.parametrize(
    ("name", "file"),
    [
        ("encode", "data/tables/assets.parquet"),
        ("train", "data/tables/rooms.parquet"),
        ("sample", "data/latents/latents.parquet"),
        ("sample", "models/denoiser.safetensors"),
        ("postopt", "data/samples/objects.parquet"),
        ("encode", "data/assets/*.safetensors"),
    ],
)
def test_what_is_truncated_is_named(broken, stage, name, file):
    path = min(broken.glob(file))
    cut(path)
    before = snapshot(broken / "data")
    said(stage(broken, name), 1, path.name)
    after = snapshot(broken / "data")
    assert {file: after[file] for file in before} == before


def test_a_truncated_checkpoint_is_named_or_made_again(broken, stage):
    cut(broken / "models" / "checkpoint" / "denoiser.safetensors")
    before = (broken / "models" / "denoiser.safetensors").read_bytes()
    done = stage(broken, "train")
    assert "Traceback" not in done.stderr
    if done.returncode:
        said(done, 1, "denoiser.safetensors")
    assert (broken / "models" / "denoiser.safetensors").read_bytes() == before


@pytest.mark.slow
def test_truncated_sources_are_quarantined_and_the_run_goes_on(root, broken, stage):
    shutil.copytree(root / "data/raw", broken / "data/raw")
    front = broken / "data/raw/3d-front"
    house = min((front / "3D-FRONT").glob("*.json"))
    for kept in (front / "3D-FUTURE-model", broken / "data/raw/partnet"):  # the first twenty: reading all takes minutes
        for folder in sorted(p for p in kept.iterdir() if p.is_dir())[20:]:
            shutil.rmtree(folder)
    model = min((front / "3D-FUTURE-model").glob("*/raw_model.obj"))
    urdf = min((broken / "data/raw/partnet").glob("*/mobility*.urdf"))
    for path in (house, model, *urdf.parent.glob("*.urdf")):
        cut(path)
    done = stage(broken, "preprocess")
    assert done.returncode == 0, done.stderr
    rejects = tables.read(broken / "data/tables/rejects.parquet", REJECTS)
    for name in (house.stem, urdf.parent.name):
        row = next(r for r in rejects if name in r["where"] and r["what"] in {"house", "model"})
        assert row["reason"] != "internal"
        assert row["detail"]
    assert any(model.parent.name in r["where"] for r in rejects)


@pytest.mark.parametrize(
    ("place", "value", "words"),
    [
        (("train", "stepps"), 5, ("train.stepps", "steps")),
        (("trian",), {}, ("trian", "train")),
        (("preset",), "fast", ("fast", "smoke")),
        (("train", "steps"), "many", ("train.steps", "int")),
        (("seed",), -1, ("seed",)),
        (("train",), None, ("train",)),
    ],
)
def test_params_are_read_strictly(broken, stage, place, value, words):
    path = broken / "params.yaml"
    tree = yaml.safe_load(path.read_text())
    at = tree
    for key in place[:-1]:
        at = at[key]
    at[place[-1]] = value
    path.write_text(yaml.safe_dump(tree))
    before = snapshot(broken / "models")
    said(stage(broken, "train"), 1, *words)
    assert snapshot(broken / "models") == before


@pytest.mark.parametrize("file", ["models/denoiser.safetensors", "data/tables/assets.parquet", "data/latents/latents.parquet"])
def test_commands_name_what_is_truncated(broken, command, file):
    cut(broken / file)
    said(command(broken, "shard", "--count", "1", "--out", "d"), 1, file.rsplit("/", 1)[1])
    said(command(broken, "generate", "a studio", "--out", "h"), 1, file.rsplit("/", 1)[1])
    assert not snapshot(Path())


def test_without_weights_commands_name_make_run(broken, command):
    (broken / "models" / "denoiser.safetensors").unlink()
    said(command(broken, "shard", "--count", "1"), 1, "weights", "make run")
    said(command(broken, "generate", "a studio"), 1, "weights", "make run")


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["shard", "--count", "0"], 2, ("--count",)),
        (["shard", "--count", "-5"], 2, ("--count",)),
        (["shard", "--count", "1", "--prompts", "nowhere.txt"], 2, ("nowhere.txt", "missing")),
        (["shard", "--count", "1", "--prompts", "mine"], 2, ("mine", "not a file")),
        (["shard", "--count", "1", "--out", "mine"], 2, ("mine",)),
        (["shard", "--count", "1", "--out", "mine/thesis.tex"], 2, ("thesis.tex",)),
        (["generate", ""], 2, ("empty",)),
        (["generate", "   "], 2, ("empty",)),
        (["generate", "a studio", "--out", "mine"], 2, ("mine",)),
        (["generate", "an apartment with no bathroom and an en suite bathroom"], 3, ("bathroom",)),
        (["generate", "a bedroom with sixty pieces of furniture and a bathroom, 60 m2"], 3, ("at most",)),
        (["plan", "sing me a song"], 3, ()),
        (["verify", "nowhere"], 2, ("nowhere", "missing")),
        (["verify", "mine/thesis.tex"], 2, ("thesis.tex",)),
        (["verify", "mine"], 1, ("mine",)),
    ],
)
def test_command_lines_are_refused_and_nothing_is_lost(root, command, arguments, code, words):
    Path("mine").mkdir()
    Path("mine/thesis.tex").write_text("mine")
    said(command(root, *arguments), code, *words)
    assert snapshot(Path("mine")) == {"thesis.tex": b"mine"}
    assert not list(Path().rglob("shard-*"))


def test_a_prompt_of_a_megabyte_is_refused(root, command):
    """Longer than an argument may be on Linux, so it comes through a file."""
    Path("long.txt").write_text("a studio " * 120_000)
    said(command(root, "shard", "--count", "1", "--prompts", "long.txt"), 2, "long.txt", "characters")
    said(command(root, "generate", "a studio " * 12_000), 2, "characters")


def test_another_dataset_stays_as_it_is(root, command):
    shutil.copytree(root / "data" / "shards", Path("d"))
    before = snapshot(Path("d"))
    said(command(root, "shard", "--count", "1", "--out", "d", "--seed", "9"), 2, "d")
    said(command(root, "generate", "a studio", "--out", "d"), 2, "d")
    assert snapshot(Path("d")) == before


def test_a_truncated_dataset_is_named(root, command):
    shutil.copytree(root / "data" / "shards", Path("d"))
    cut(Path("d") / "objects" / "shard-00000.parquet")
    said(command(root, "verify", "d"), 1, "objects/shard-00000.parquet", "copy")


def test_the_command_itself_exits_as_it_says(tmp_path):
    environment = {**os.environ, "PYTHONPATH": str(checkout.ROOT)}
    arguments = [sys.executable, "-m", "sfgen.cli", "shard", "--count", "0"]
    said(subprocess.run(arguments, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False), 2, "--count")
