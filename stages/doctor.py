"""`sfgen doctor`: what is installed, what is made, what is missing and the command that makes it."""

import importlib.metadata
import json
import os
import platform
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

from pipeline import params
from pipeline.entry import run
from pipeline.errors import ContentError
from pipeline.execution import Voice, cores
from pipeline.sources.registry import SOURCES, configured_sources
from pipeline.sources.settings import PreprocessSettings

# (package, what it is for): what the factory cannot do without, then what some commands want
NEEDED = ("numpy", "pyarrow", "torch", "scipy", "shapely", "usd-core", "numba", "pydantic", "safetensors", "dask", "distributed", "dvc")  # fmt: skip
WANTED = (("mitsuba", "path-traced views"), ("mujoco", "tests in a physics engine"))

# (path, what it is, the command that makes it), in the order in which the stages make them
MADE = (
    ("data/raw", "raw sources", "dvc repro corpus"),
    ("data/tables", "training tables", "dvc repro preprocess"),
    ("models/vae.safetensors", "shape encoder", "dvc repro encode"),
    ("models/denoiser.safetensors", "layout model", "dvc repro train"),
    ("data/samples", "sampled layouts", "dvc repro sample"),
    ("data/shards/dataset.json", "dataset", "dvc repro postopt"),
    ("metrics/metrics.json", "metrics", "dvc repro metrics"),
    ("report", "report", "dvc repro metrics"),
)


def main(root: Path, *, voice: Voice = "plain") -> None:
    """Print one line per thing; `-` marks what is missing. For machines, one JSON object."""
    parts = {"machine": machine(), "packages": packages(), "sources": sources(root), "made": stage_outputs(root)}
    if voice == "json":
        report = {part: [{"ok": not line.startswith("-"), "text": line.lstrip("+- ")} for line in lines] for part, lines in parts.items()}
        sys.stdout.write(json.dumps(report) + "\n")
        return
    sys.stdout.writelines(f"{line}\n" for lines in parts.values() for line in lines)


def places(root: Path) -> None:
    """Print where the dataset, the report and the pictures lie: how `make run` ends."""
    for what, path in {
        "dataset": "data/shards",
        "report": "report/index.html",
        "pictures": "report",
        "metrics": "metrics/metrics.json",
    }.items():
        sys.stdout.write(f"{what + ':':9} {root / path}\n")


def machine() -> Iterator[str]:
    """Yield what this machine is."""
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    yield f"+ Python {platform.python_version()} on {platform.system()} {platform.machine()}, {cores()} cores, {memory:.0f} GiB"
    if not (shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")):
        yield "- a C compiler is missing; install gcc or clang"


def packages() -> Iterator[str]:
    """Yield the versions of what the factory stands on."""
    for name in NEEDED:
        yield f"+ {name} {version}" if (version := installed_version(name)) else f"- {name} is not installed; type `make run`"
    if installed_version("torch"):
        import torch

        if torch.cuda.is_available():
            yield f"+ CUDA {torch.version.cuda}: {torch.cuda.get_device_name(0)}"
        else:
            yield "+ CUDA is not there: training and sampling run on the CPU"
    for name, use in WANTED:
        version = installed_version(name)
        yield f"+ {name} {version}" if version else f"- {name} is not installed ({use}); pip install -c constraints.txt -e '.[render,dev]'"


def sources(root: Path) -> Iterator[str]:
    """Yield what lies in the folders that stage `preprocess` reads."""
    settings = params.section(PreprocessSettings, params.read(root / "params.yaml"), "preprocess")
    used = {source.key: path for source, path in configured_sources(settings.sources)}
    for source in SOURCES:
        path = used.get(source.key)
        if path is None:
            yield f"+ {source.key}: none, by params.yaml"
        elif not (root / path).is_dir():
            yield f"- {source.key}: {path} is missing; `dvc repro corpus` makes the embedded data, `sfgen doctor --use PATH` names yours"
        else:
            try:
                yield f"+ {source.key}: {source.list(root / path, settings)}"
            except (OSError, ContentError) as error:
                yield f"- {source.key}: {path} cannot be read ({error})"


def stage_outputs(root: Path) -> Iterator[str]:
    """Yield what the stages have made, and the first command to type."""
    missing = []
    for path, what, command in MADE:
        there = (root / path).exists()
        yield f"+ {what}: {path}" if there else f"- {what}: {path} is missing; {command}"
        if not there:
            missing.append(path)
    yield f"type `make run` in {root}: it makes what is missing" if missing else "all is made; try `sfgen generate` or `sfgen shard`"


def installed_version(name: str) -> str | None:
    """Return a package's version, None when it is not installed."""
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return None


if __name__ == "__main__":
    run(places if "--places" in sys.argv[1:] else main)
