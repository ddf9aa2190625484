"""`sfgen shard` and `sfgen generate` with a factory of paper: what they ask for, write, resume and refuse."""

import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "shards"))
import made

import sfgen
from pipeline.entities.plan import Plan, Room
from pipeline.errors import ContentError
from pipeline.shards import scene_id
from sfgen import cli


class Paper:
    """Stands for the factory: homes are made-up rows, and every request is kept."""

    shard_size, chunk, licence = 4, 2, "CC0-1.0"

    def __init__(self, seed, weights="w"):
        self.seed = seed
        self.digests = {"weights": weights}
        self.asked = []
        self.library = SimpleNamespace(rows={f"asset_{k}": {"style": ""} for k in range(2)})

    def write_library(self, folder, asset_ids=None):
        made.library(folder)
        self.used = asset_ids

    def make(self, requests):
        assert len(requests) <= self.chunk
        self.asked += [(r.index, r.prompt) for r in requests]
        homes = [made.home(r.index, self.seed) for r in requests]
        room = Room("studio", "studio_room", np.array([[0.0, 0.0], [6.0, 0.0], [6.0, 4.0], [0.0, 4.0]]))
        plan = Plan((room,), (), "studio")
        placed = [SimpleNamespace(asset_id="asset_1"), SimpleNamespace(asset_id="asset_0"), SimpleNamespace(asset_id="asset_1")]
        return [
            SimpleNamespace(
                rows=rows,
                files=files,
                home=SimpleNamespace(scene_id=scene_id(self.seed, r.index), plan=plan, placements=placed, program=r.program or "{}"),
            )
            for r, (rows, files) in zip(requests, homes, strict=True)
        ]


@pytest.fixture
def factory(monkeypatch, tmp_path):
    """The factory of every command of a test; the commands run in an empty folder."""
    from stages import generate, shard

    monkeypatch.chdir(tmp_path)
    paper = Paper(3)
    monkeypatch.setattr(shard, "open_factory", lambda _root, seed: setattr(paper, "seed", seed) or paper)
    monkeypatch.setattr(generate, "open_factory", lambda _root, seed: setattr(paper, "seed", seed) or paper)
    return paper


def run(*arguments):
    return cli.run([str(a) for a in arguments])


def test_shard_makes_a_dataset_in_the_working_directory(factory, capsys):
    assert run("shard", "--count", 10, "--seed", 3) == 0
    assert [h.index for h in sfgen.load("datasets/3")] == list(range(10))
    assert factory.asked == [(i, "") for i in range(10)]
    assert factory.used is None
    assert "10 homes in datasets/3" in capsys.readouterr().out
    assert run("verify", "--quick", "datasets/3") == 0


def test_shard_resumes_and_does_nothing_twice(factory):
    assert run("shard", "--count", 8, "--out", "d", "--seed", 3) == 0
    before = made.snapshot("d")
    factory.asked.clear()
    assert run("shard", "--count", 8, "--out", "d", "--seed", 3, "--workers", 2) == 0
    assert factory.asked == []
    assert made.snapshot("d") == before
    assert run("shard", "--count", 10, "--out", "d", "--seed", 3) == 0
    assert [i for i, _ in factory.asked] == [8, 9]


def test_shard_asks_for_what_the_file_says(factory, tmp_path):
    (tmp_path / "p.txt").write_text("a studio\na two-bedroom apartment\n")
    assert run("shard", "--count", 3, "--out", "d", "--prompts", "p.txt") == 0
    assert factory.asked == [(0, "a studio"), (1, "a two-bedroom apartment"), (2, "a studio")]


@pytest.mark.parametrize(
    ("files", "arguments", "code"),
    [
        ({"d/thesis.tex": "mine"}, ["--out", "d"], 2),
        ({"d": "mine"}, ["--out", "d"], 2),
        ({"p.txt": ""}, ["--prompts", "p.txt"], 2),
        ({"p.txt": "x" * 1_000_000}, ["--prompts", "p.txt"], 2),
        ({"p.yaml": "- {prompt: a studio, weight: -1}"}, ["--prompts", "p.yaml"], 1),
        ({"p.txt": "a studio\nsing me a song\n"}, ["--prompts", "p.txt"], 3),
        ({}, ["--prompts", "p.txt"], 2),
        ({}, ["--prompts", "."], 2),
        ({}, ["--scheduler", "nowhere.json"], 2),
    ],
)
def test_shard_refuses_in_one_line_and_loses_nothing(factory, tmp_path, capsys, files, arguments, code):
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    assert run("shard", "--count", 5, *arguments) == code
    err = capsys.readouterr().err
    assert err.startswith("sfgen: ")
    assert err.count("\n") == 1
    assert len(err) < 400
    assert {name: (tmp_path / name).read_text() for name in files} == files
    assert not list(tmp_path.rglob("shard-*"))


def test_another_dataset_stays_as_it_is(factory, capsys):
    assert run("shard", "--count", 4, "--out", "d", "--seed", 3) == 0
    before = made.snapshot("d")
    assert run("shard", "--count", 4, "--out", "d", "--seed", 4) == 2
    assert "seed 3, not 4" in capsys.readouterr().err
    factory.digests = {"weights": "other"}
    assert run("shard", "--count", 4, "--out", "d", "--seed", 3) == 2
    assert run("generate", "a studio", "--out", "d") == 2
    assert made.snapshot("d") == before


def test_generate_makes_a_dataset_of_one_with_what_it_uses(factory, capsys):
    assert run("generate", " a studio ", "--out", "home", "--seed", 7) == 0
    assert factory.asked == [(0, "a studio")]
    assert factory.used == ["asset_0", "asset_1"]
    assert [h.scene_id for h in sfgen.load("home")] == ["s7_00000000"]
    said = capsys.readouterr()
    assert "home/usd/shard-00000/s7_00000000.usdc" in said.out
    assert "studio_room" not in said.err  # it was asked for
    assert "bath (bathroom)" in said.err  # that was assumed
    assert run("verify", "--quick", "home") == 0
    assert run("generate", "a studio", "--out", "home", "--seed", 7) == 0
    assert run("generate", "a two-bedroom apartment", "--out", "home", "--seed", 7) == 2


@pytest.mark.parametrize(("prompt", "code"), [("", 2), ("  ", 2), ("x" * 1_000_000, 2), ("sing me a song", 3)])
def test_generate_refuses_in_one_line(factory, tmp_path, capsys, prompt, code):
    assert run("generate", prompt) == code
    err = capsys.readouterr().err
    assert err.startswith("sfgen: ")
    assert err.count("\n") == 1
    assert len(err) < 400
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("command", [("shard", "--count", "2"), ("generate", "a studio")])
def test_without_weights_make_run_is_named(monkeypatch, tmp_path, capsys, command):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "params.yaml").write_text("preset: a\npresets: {a: {}}\n")
    monkeypatch.setattr(cli, "factory_root", lambda: tmp_path)
    assert run(*command) == ContentError.exit_code
    assert "make run" in capsys.readouterr().err
