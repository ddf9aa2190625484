"""The code that each stage of dvc.yaml runs, from the graph of imports.

python .ci/deps.py            print what `deps:` must list
python .ci/deps.py --write    write it into dvc.yaml; data and manifests among the deps stay as they are
"""

import sys
from collections.abc import Iterable
from pathlib import Path

import grimp
from ruamel.yaml import YAML

ROOT = Path(__file__).resolve().parents[1]
CODE = ("stages", "pipeline", "schemas")
MOST = 0.4  # share of a package's modules from which on the package is named


def closure(graph: grimp.ImportGraph, module: str) -> set[str]:
    """Return the files, relative to the checkout, that importing `module` may run: packages' __init__ files are among them."""
    seen: set[str] = set()
    waiting = [module]
    while waiting:
        name = waiting.pop()
        if name in seen or name not in graph.modules:
            continue
        seen.add(name)
        waiting += graph.find_modules_directly_imported_by(name)
        waiting += [name.rpartition(".")[0]]
    return {file_of(name) for name in seen}


def file_of(module: str) -> str:
    """Return a module's file, relative to the checkout."""
    path = Path(*module.split("."))
    return (path / "__init__.py" if (ROOT / path).is_dir() else path.with_suffix(".py")).as_posix()


def shortest(files: Iterable[str]) -> list[str]:
    """Name a package instead of its modules where most of them are listed: a page stays a page."""
    left = set(files)
    for top in CODE[1:]:
        folders = [p.parent for p in (ROOT / top).rglob("__init__.py") if p.parent != ROOT / "pipeline"]
        for folder in sorted(folders, key=lambda p: (len(p.parts), p)):
            inside = {p.relative_to(ROOT).as_posix() for p in folder.rglob("*.py")}
            if len(inside & left) > MOST * len(inside):
                left = left - inside | {folder.relative_to(ROOT).as_posix()}
    return sorted(left)


def stages(text: str) -> dict[str, str]:
    """Return the stages of dvc.yaml and the module that each runs."""
    entries = YAML(typ="safe").load(text)["stages"]
    return {name: body["cmd"].split()[2] for name, body in entries.items() if body["cmd"].startswith("python -m stages.")}


def main() -> None:
    """Print, or write."""
    sys.path.insert(0, str(ROOT))
    graph = grimp.build_graph(*CODE)
    path = ROOT / "dvc.yaml"
    wanted = {stage: shortest(closure(graph, module)) for stage, module in stages(path.read_text(encoding="utf-8")).items()}
    if "--write" not in sys.argv[1:]:
        for stage, deps in wanted.items():
            print(f"{stage}:", *(f"  - {dep}" for dep in deps), sep="\n")  # noqa: T201 - what it is for
        return
    yaml = YAML()
    yaml.preserve_quotes = True
    yaml.width = 200
    yaml.indent(mapping=2, sequence=4, offset=2)
    data = yaml.load(path)
    for stage, deps in wanted.items():
        old = data["stages"][stage].get("deps", [])
        data["stages"][stage]["deps"] = [*deps, *(d for d in old if str(d).split("/")[0] not in CODE)]
    yaml.dump(data, path)


if __name__ == "__main__":
    main()
