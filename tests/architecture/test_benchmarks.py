"""Every benchmark can be imported: what it takes from this repository is where it says, and only an engine may be missing."""

import ast
import importlib
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
BENCHMARKS = [p for folder in (".", "engines") for p in sorted((ROOT / "benchmarks" / folder).glob("*.py"))]
ENGINES = ("mujoco", "newton", "warp", "ovphysx", "ovstage", "sapien", "yourdfpy", "usd_validation_nvidia")  # each in a Python of its own


@pytest.mark.parametrize("path", BENCHMARKS, ids=lambda p: p.relative_to(ROOT / "benchmarks").as_posix())
def test_what_a_benchmark_imports_is_there(path, monkeypatch):
    """Name by name, for a module that stops at an engine which is missing says nothing of the imports below that line."""
    places = [ROOT / "benchmarks", ROOT / "benchmarks" / "engines"]
    first = places if path.parent == places[0] else places[::-1]
    monkeypatch.setattr(sys, "path", [*map(str, first), str(ROOT), *sys.path])  # as `python benchmarks/NAME.py` has it
    for name in ("plan", "trial", "rooms"):  # both folders have a plan.py
        monkeypatch.delitem(sys.modules, name, raising=False)
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        names = [a.name for a in node.names] if isinstance(node, ast.Import) else [node.module] if isinstance(node, ast.ImportFrom) else []
        for module in names:
            if module.split(".")[0] not in ENGINES:
                found = importlib.import_module(module)
                for wanted in node.names if isinstance(node, ast.ImportFrom) else ():
                    assert hasattr(found, wanted.name) or importlib.import_module(f"{module}.{wanted.name}"), wanted.name
