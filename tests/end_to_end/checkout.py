"""A checkout in small: the whole factory run once, every stage real, with numbers that take seconds."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import yaml

ROOT = Path(__file__).parents[2]
STAGES = ("corpus", "preprocess", "encode", "train", "sample", "postopt", "metrics")
SMALL = {
    "corpus": {"houses": 14, "models": 0.12},
    "preprocess": {"workers": 1},
    "encode": {"start": "scratch", "steps": 3, "points": 256, "train_points": 128, "decoded_points": 64, "width": 16, "threads": 1},
    "train": {
        "start": "scratch",
        "steps": 5,
        "objects": 64,
        "warmup": 2,
        "checkpoint_every": 2,
        "model": {"width": 32, "layers": 1},
        "inventory": {"steps": 20},
        "threads": 1,
    },
    "sample": {"evaluations": 8},
    "dataset": {"homes": 2, "prompts": "prompts.txt"},
    "shard": {"homes": 4, "chunk": 2, "room_attempts": 1, "preview": 128},
    "metrics": {"rooms": 1, "all_rooms": 3, "counts": [3], "taus": [0.5], "plan_seeds": 1, "gallery": 0},
}
PROMPTS = (
    "A studio of 25 m2 with a bathroom.",
    "A studio of about 30 m2: one main room for living and sleeping, plus a separate bathroom.",
)
# One process a stage, as DVC has it, and one core: the tests share theirs.
RUN = "import os, sys; os.cpu_count = lambda: 1; os.sched_getaffinity = lambda _: {{0}}; from pathlib import Path; from pipeline import entry; from stages import {0}; entry.ROOT = Path(sys.argv[1]); entry.run({0}.main)"


def write_params(root, changes=SMALL):
    """The real params.yaml with other numbers."""
    tree = yaml.safe_load((ROOT / "params.yaml").read_text())
    for section, values in changes.items():
        for key, value in values.items():
            tree[section][key] = {**tree[section][key], **value} if isinstance(value, dict) else value
    (root / "params.yaml").write_text(yaml.safe_dump(tree, sort_keys=False))


def run_stage(root, name):
    """Run one stage on the checkout at `root` in a process of its own."""
    return python(RUN.format(name), root)


def python(program, *arguments, cwd=None):
    """Run a program with this code and one thread."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1"}
    environment.pop("SFGEN_DEBUG", None)
    command = [sys.executable, "-c", program, *map(str, arguments)]
    return subprocess.run(command, cwd=cwd, env=environment, capture_output=True, text=True, check=False)


def make(root):
    """Lay out a checkout at `root` and run every stage on it."""
    root.mkdir(parents=True)
    shutil.copytree(ROOT / "manifests", root / "manifests")
    (root / "prompts.txt").write_text("\n".join(PROMPTS) + "\n")
    write_params(root)
    for name in STAGES:
        done = run_stage(root, name)
        assert done.returncode == 0, f"{name}: {done.stderr[-3000:]}"
