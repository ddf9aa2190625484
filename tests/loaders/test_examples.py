"""The examples run, as programs, on a dataset."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def run(name, folder):
    answer = subprocess.run(
        [sys.executable, str(ROOT / "examples" / name), str(folder)],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
        env={"PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1"},
    )
    assert answer.returncode == 0, answer.stderr
    return answer.stdout


def test_load_dataset(dataset_folder):
    said = run("load_dataset.py", dataset_folder)
    assert "10 homes, licence CC0-1.0" in said
    assert "10 bedroom, 10 kitchen" in said
    assert "thing_0/joint_0 opens to" in said


def test_torch_dataset(dataset_folder):
    errors = [float(line.split("error ")[1].split()[0]) for line in run("torch_dataset.py", dataset_folder).splitlines()]
    assert len(errors) == 3
    assert errors[2] < errors[0]


@pytest.mark.parametrize("path", sorted((ROOT / "examples").glob("*.py")), ids=lambda p: p.name)
def test_every_example_is_tested(path):
    assert f'"{path.name}"' in Path(__file__).read_text()
