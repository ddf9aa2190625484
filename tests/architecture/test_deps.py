"""dvc.yaml lists the code that each stage runs: what is not listed could change without the stage being run again."""

import sys
from pathlib import Path

import grimp
import pytest
import yaml

from pipeline.homes import asset_cache

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / ".ci"))
import deps  # noqa: E402

STAGES = yaml.safe_load((ROOT / "dvc.yaml").read_text())["stages"]
MODULES = deps.stages((ROOT / "dvc.yaml").read_text())


@pytest.fixture(scope="module")
def graph():
    return grimp.build_graph(*deps.CODE)


def test_every_stage_is_a_module_of_its_name():
    assert {name: f"stages.{name}" for name in STAGES} == MODULES


@pytest.mark.parametrize("stage", sorted(MODULES))
def test_deps_cover_the_code_that_runs(graph, stage):
    listed = [Path(d) for d in STAGES[stage].get("deps", [])]
    needed = deps.closure(graph, MODULES[stage])
    assert f"stages/{stage}.py" in needed
    missing = [f for f in needed if not any(d == Path(f) or d in Path(f).parents for d in listed)]
    assert not missing, f"`make deps` adds to stage {stage} what it lacks"


@pytest.mark.parametrize("stage", sorted(MODULES))
def test_deps_name_nothing_that_is_gone_or_not_needed(graph, stage):
    needed = deps.closure(graph, MODULES[stage])
    for dep in STAGES[stage].get("deps", []):
        if dep.split("/")[0] in deps.CODE:
            assert any(Path(dep) == Path(f) or Path(dep) in Path(f).parents for f in needed), dep
        elif not dep.startswith(("data", "models", "metrics", "plots")):  # what other stages make
            assert (ROOT / dep).exists(), dep


def test_closure_knows_packages_and_their_imports(graph):
    files = deps.closure(graph, "stages.verify")
    assert {
        "stages/verify.py",
        "pipeline/shards/__init__.py",
        "pipeline/shards/header.py",
        "pipeline/errors.py",
        "schemas/table.py",
    } <= files
    assert "stages/shard.py" not in files


def test_the_asset_cache_is_named_after_all_code_that_writes_assets(graph):
    listed = [Path(d) for d in asset_cache.CODE]
    assert all((ROOT / d).exists() for d in listed)
    needed = deps.closure(graph, "pipeline.usd.library")
    assert not [f for f in needed if not any(d == Path(f) or d in Path(f).parents for d in listed)]


def test_shortest_names_whole_folders():
    files = {p.relative_to(ROOT).as_posix() for p in (ROOT / "schemas").rglob("*.py")}
    assert deps.shortest([*files, "pipeline/errors.py"]) == ["pipeline/errors.py", "schemas"]
