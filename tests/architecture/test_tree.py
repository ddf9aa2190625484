"""The tree: packages are this checkout's, modules are small nouns, and what is forbidden does not occur."""

import ast
import importlib
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGES = ("sfgen", "stages", "pipeline", "schemas")
MODULES = sorted(p for name in PACKAGES for p in (ROOT / name).rglob("*.py"))
SOURCES = [*MODULES, *sorted(p for name in ("benchmarks", "examples", ".ci") for p in (ROOT / name).rglob("*.py"))]
DRAWERS = {"utils", "util", "helpers", "helper", "misc", "common", "base2", "tools", "stuff"}


def name(path):
    return path.relative_to(ROOT).as_posix()


@pytest.mark.parametrize("package", PACKAGES)
def test_packages_resolve_to_this_checkout(package):
    assert Path(importlib.import_module(package).__file__).parent == ROOT / package


def test_modules_are_small():
    lines = {name(p): len(p.read_text(encoding="utf-8").splitlines()) for p in MODULES}
    assert not {n: count for n, count in lines.items() if count > 400}
    assert not {n: count for n, count in lines.items() if n.startswith("stages/") and count > 120}
    assert not {n: count for n, count in lines.items() if n.endswith("/__init__.py") and count > 40}


def test_functions_are_short():
    functions = [
        (name(path), node.name, node.end_lineno - node.lineno + 1)
        for path in SOURCES
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
    ]
    assert len(functions) > 1000
    assert not [found for found in functions if found[2] > 60]


def test_no_drawers():
    parts = {part.removesuffix(".py") for p in MODULES for part in p.relative_to(ROOT).parts}
    assert not parts & DRAWERS


FORBIDDEN = {
    "pickle": r"^\s*(import|from) (pickle|cPickle|dill|shelve|marshal)\b",
    "torch.load": r"\btorch\.(load|save)\(",
    "numpy pickles": r"allow_pickle=True",
    "a shell": r"shell=True|\bos\.system\(|\bos\.popen\(",
    "eval": r"(?<![\w.])(eval|exec)\(",
    "unsafe YAML": r"\byaml\.(load|unsafe_load|full_load)\(",
    "global randomness": r"\bnp\.random\.(?!Generator|Philox|default_rng|SeedSequence|BitGenerator|PCG64)\w+\(|^\s*import random\b",
    "the clock in data": r"\bdatetime\.(now|today|utcnow)\(|\btime\.time\(\)",
    "a bare except": r"^\s*except\s*:",
    "a place of one machine": r"/work/|/home/[a-z]|/root/|/Users/",
}


@pytest.mark.parametrize("what", FORBIDDEN)
def test_what_is_forbidden_does_not_occur(what):
    pattern = re.compile(FORBIDDEN[what], re.MULTILINE)
    assert [name(p) for p in MODULES if pattern.search(p.read_text(encoding="utf-8"))] == []


def test_the_patterns_find_what_they_forbid():
    samples = ("import pickle", "torch.load(p)", "allow_pickle=True", "shell=True", "x = eval(s)", "yaml.load(f)", "np.random.rand(3)")
    samples += ("datetime.now()", "    except:", "'/work/main'")
    for text, pattern in zip(samples, FORBIDDEN.values(), strict=True):
        assert re.search(pattern, text, re.MULTILINE), text


def test_every_module_says_what_it_is():
    trees = {name(p): ast.parse(p.read_text(encoding="utf-8")) for p in SOURCES}
    assert [n for n, tree in trees.items() if tree.body and not ast.get_docstring(tree)] == []


def test_tests_are_no_packages():
    assert not list((ROOT / "tests").rglob("__init__.py"))
