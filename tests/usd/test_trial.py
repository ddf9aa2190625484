"""The trial that benchmarks/engines gives to engines, on a small home in MuJoCo: joints open and shut, and what lies about stays."""

import json
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from pipeline.usd import write_home, write_library, write_mujoco_overlay
from tests.export.furnished import made

ROOT = Path(__file__).parents[2]
# The trial itself, in a process of its own: mujoco's USD plug-ins change what usd-core knows, and it logs to the working directory.
READ = "import json, pathlib, sys; import plan; print(json.dumps(plan.read(pathlib.Path(sys.argv[1]))))"


@pytest.fixture(scope="module")
def trial(tmp_path_factory):
    """The plan of a stage, and what MuJoCo made of it: room doors, and a cabinet with two things on it, for more costs a minute."""
    pytest.importorskip("mujoco")
    engines, folder = ROOT / "benchmarks" / "engines", tmp_path_factory.mktemp("trial")
    home, assets = made()
    home = replace(home, placements=tuple(p for p in home.placements if p.object_id in {"cabinet_2", "book_0", "flip_0"}))
    write_library(assets.values(), folder / "assets")
    write_mujoco_overlay(stage := write_home(home, assets, folder / "usd/shard-00000/scene.usdc"))
    env = {**os.environ, "OMP_NUM_THREADS": "1", "PYTHONPATH": str(engines)}

    def call(*arguments):
        done = subprocess.run([sys.executable, *arguments], capture_output=True, text=True, check=False, cwd=folder, env=env)
        assert done.returncode == 0, done.stderr[-2000:]
        return done.stdout

    (folder / "plan.json").write_text(call("-c", READ, str(stage)))
    call(str(engines / "mujoco4.py"), str(stage), "plan.json", "out.json")
    return json.loads((folder / "plan.json").read_text()), json.loads((folder / "out.json").read_text())


def test_joints_open_and_shut_again(trial):
    todo, found = trial
    limited = np.array([joint["limited"] for joint in todo["joints"]])
    assert len(limited) == 4 + 3 + 1  # room doors; drawer, door and knob of a cabinet; a lid
    assert min(found["opened"]) >= 0.95
    assert np.abs(np.array(found["closed"])[limited]).max() < 0.05  # a knob without limits goes round, either way
    assert np.abs(np.array(found["left"])[limited]).max() < 0.05


def test_nothing_moves_while_everything_is_shut_or_open(trial):
    todo, found = trial
    for key in ("moved_shut", "moved_open"):
        moved = np.array(found[key])
        assert len(moved) == len(todo["bodies"]) == 2  # the book, and what has a lid
        assert moved[:, 0].max() < 0.005  # [m] in 5 s
