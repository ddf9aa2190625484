"""The import contracts hold, and each bites when it is broken."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def lint(folder):
    program = "import sys; sys.path.insert(0, '.'); from importlinter.cli import lint_imports_command; lint_imports_command()"
    return subprocess.run(
        [sys.executable, "-c", program, "--no-cache"],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
        env={"PATH": "/usr/bin:/bin", "HOME": "/"},
    )


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    folder = tmp_path_factory.mktemp("copy")
    for name in ("sfgen", "stages", "pipeline", "schemas"):
        shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "pyproject.toml", folder)
    return folder


def test_contracts_hold(copy):
    answer = lint(copy)
    assert answer.returncode == 0, answer.stdout[-3000:]
    assert "0 broken" in answer.stdout


@pytest.mark.parametrize(
    ("module", "line", "contract"),
    [
        ("schemas/table.py", "import pipeline.errors", "roots"),
        ("pipeline/errors.py", "import pipeline.tables", "layers of the pipeline"),
        ("stages/verify.py", "import stages.doctor", "stages meet on disk only"),
        ("sfgen/homes.py", "import pipeline.errors", "the loaders stand alone"),
        ("pipeline/verify/__init__.py", "import pipeline.arrange", "judges do not know what they judge"),
        ("pipeline/geometry/__init__.py", "import torch", "torch lives where networks live"),
        ("pipeline/shards/layout.py", "import pipeline.shards.parts", "no circles"),
    ],
)
def test_contracts_bite(copy, module, line, contract):
    path = copy / module
    before = path.read_text()
    path.write_text(f"{before}\n{line}\n")
    try:
        answer = lint(copy)
    finally:
        path.write_text(before)
    assert answer.returncode == 1
    broken = [text for text in answer.stdout.splitlines() if " BROKEN" in text]
    assert any(text.startswith(contract) for text in broken), answer.stdout[-3000:]


def test_a_new_layer_must_be_placed(copy):
    (copy / "pipeline" / "novelty.py").write_text("")
    try:
        answer = lint(copy)
    finally:
        (copy / "pipeline" / "novelty.py").unlink()
    assert answer.returncode == 1
    assert "novelty" in answer.stdout
