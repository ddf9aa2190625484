"""Presets run in a scratch clone: it holds what the working tree holds, and the working tree stays as it is."""

import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[2] / ".ci" / "scratch.py"
PARAMS = "preset: quick # the default\nseed: 1\nencode:\n  start: released # why\ntrain:\n  start: released\npresets:\n  quick: {}\n  smoke:\n    train: {steps: 2}\n"


def git(folder, *arguments):
    identity = ["-c", "user.name=t", "-c", "user.email=t@example.org"]
    return subprocess.run(["git", *identity, *arguments], cwd=folder, check=True, capture_output=True, text=True).stdout


def scratch(folder, *chosen):
    return subprocess.run([sys.executable, str(SCRIPT), "build/s", *chosen], cwd=folder, capture_output=True, text=True, check=False)


@pytest.fixture
def tree(tmp_path):
    folder = tmp_path / "tree"
    (folder / "sub").mkdir(parents=True)
    for name, text in {
        "params.yaml": PARAMS,
        "kept.py": "1",
        "gone.py": "1",
        "sub/changed.py": "1",
        ".gitignore": "/build/\n/data/\n",
        "dvc.lock": "old",
    }.items():
        (folder / name).write_text(text)
    git(folder, "init", "-q")
    git(folder, "add", ".")
    git(folder, "commit", "-q", "-m", "x")
    (folder / "gone.py").unlink()
    (folder / "sub" / "changed.py").write_text("2")
    (folder / "new.py").write_text("1")
    (folder / "data").mkdir()
    (folder / "data" / "big").write_text("1")
    return folder


def test_scratch_is_the_working_tree_with_another_preset(tree):
    before = git(tree, "status", "--porcelain")
    assert scratch(tree, "smoke").returncode == 0
    copy = tree / "build" / "s"
    assert git(tree, "status", "--porcelain") == before
    assert (copy / "params.yaml").read_text() == PARAMS.replace("preset: quick", "preset: smoke")
    assert (copy / "sub" / "changed.py").read_text() == "2"
    assert (copy / "new.py").exists()
    assert not (copy / "gone.py").exists()
    assert not (copy / "data").exists()
    assert (tree / "params.yaml").read_text() == PARAMS


def test_scratch_is_brought_up_to_date_and_keeps_what_was_made(tree):
    scratch(tree, "smoke")
    copy = tree / "build" / "s"
    (copy / "data").mkdir()
    (copy / "data" / "made").write_text("1")
    (copy / "dvc.lock").write_text("mine")
    (tree / "new.py").write_text("2")
    (tree / "kept.py").unlink()
    assert scratch(tree, "smoke").returncode == 0
    assert (copy / "new.py").read_text() == "2"
    assert not (copy / "kept.py").exists()
    assert (copy / "data" / "made").exists()
    assert (copy / "dvc.lock").read_text() == "mine"


def test_models_may_start_from_nothing(tree):
    assert scratch(tree, "smoke", "scratch").returncode == 0
    text = (tree / "build" / "s" / "params.yaml").read_text()
    assert text == PARAMS.replace("preset: quick", "preset: smoke").replace("released", "scratch")
    assert "START=scratch" in scratch(tree, "smoke", "nothing").stderr


def test_an_unknown_preset_is_named(tree):
    answer = scratch(tree, "huge")
    assert answer.returncode == 1
    assert answer.stderr.startswith("sfgen: params.yaml has no preset 'huge'")
