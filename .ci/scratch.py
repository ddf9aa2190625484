"""Make a scratch clone of this working tree, uncommitted changes included, with another preset chosen.

    python .ci/scratch.py build/smoke smoke
    python .ci/scratch.py build/smoke smoke scratch     # the models from nothing (encode.start, train.start)

A clone that is there already is brought up to date: what its stages have made, and DVC's cache, stay.
"""

import hashlib
import re
import shutil
import subprocess
import sys
from pathlib import Path


def main(target: Path, preset: str, start: str = "") -> None:
    """Fill `target` and set the preset in its params.yaml, and what the models start from where `start` says."""
    if not (target / ".git").exists():
        shutil.rmtree(target, ignore_errors=True)
        target.parent.mkdir(parents=True, exist_ok=True)
        git("clone", "--quiet", "--no-hardlinks", ".", str(target))
    for name in git_files("-C", str(target), "ls-files", "-z"):
        if name != "dvc.lock":
            (target / name).unlink(missing_ok=True)
    for name in git_files("ls-files", "-z", "--cached", "--others", "--exclude-standard"):
        source, copy = Path(name), target / name
        if source.is_file() and not (name == "dvc.lock" and copy.exists()):
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(source, copy)
    choose(target / "params.yaml", preset, start)
    share_compiled(target)


def share_compiled(target: Path) -> None:
    """Give the clone what is compiled here, of the same code: numba names the folders of its cache by where the code lies."""

    def place(folder: Path) -> str:
        path = folder.resolve()
        return f"{path.name}_{hashlib.sha1(str(path).encode()).hexdigest()}"  # noqa: S324 - numba's choice

    code = {place(folder): folder for folder in Path("pipeline").rglob("*") if folder.is_dir()}
    latest = max(Path("pipeline/__pycache__/numba").glob("*"), key=lambda folder: folder.stat().st_mtime, default=Path("none"))
    for kept in latest.glob("*"):
        if kept.name in code:
            shutil.copytree(kept, target / kept.parent / place(target / code[kept.name]), dirs_exist_ok=True)


def choose(path: Path, preset: str, start: str = "") -> None:
    """Set the key `preset` of params.yaml, and both keys `start` where one is given."""
    text, count = re.subn(r"(?m)^preset: *\w+", f"preset: {preset}", path.read_text(encoding="utf-8"))
    if count != 1 or not re.search(rf"(?m)^  {re.escape(preset)}:", text):
        sys.exit(f"sfgen: params.yaml has no preset {preset!r}; give PRESET= one of those under its key `presets`")
    if start not in {"", "released", "scratch"}:
        sys.exit(f"sfgen: models do not start from {start!r}; give START=released or START=scratch")
    path.write_text(re.sub(r"(?m)^  start: *\w+", f"  start: {start}", text) if start else text, encoding="utf-8")


def git_files(*arguments: str) -> list[str]:
    """Return the file names that a git command lists."""
    return [name for name in git(*arguments).split("\0") if name]


def git(*arguments: str) -> str:
    """Run git and return what it prints."""
    return subprocess.run(["git", *arguments], check=True, stdout=subprocess.PIPE, text=True).stdout  # noqa: S607 - found on PATH


if __name__ == "__main__":
    main(Path(sys.argv[1]), *sys.argv[2:])
